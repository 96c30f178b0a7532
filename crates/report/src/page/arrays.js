"use strict";

/** The bytes of array `number` of the page. */
function bytesOf(number) {
  const text = document.getElementById(`a${number}`).textContent;
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; k += 1) bytes[k] = letters.charCodeAt(k);
  return bytes;
}

const decoded = new Map();
/** An array of the page as numbers of a kind, decoded once. */
function numbersOf(number, Kind) {
  if (!decoded.has(number)) {
    const bytes = bytesOf(number);
    decoded.set(number, new Kind(bytes.buffer, bytes.byteOffset, Math.floor(bytes.byteLength / Kind.BYTES_PER_ELEMENT)));
  }
  return decoded.get(number);
}

/** The address of a figure, which an image element shows without running anything in it. */
function addressOf(kind, number) {
  return `data:${kind};base64,${document.getElementById(`a${number}`).textContent}`;
}
