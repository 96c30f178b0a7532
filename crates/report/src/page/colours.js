"use strict";

/** Colours of curves that colour-blind readers can tell apart (Okabe and Ito), for light and dark. */
const CURVES = [["#0072b2", "#56b4e9"], ["#d55e00", "#ff8a3d"], ["#008a65", "#2fc99b"], ["#b0558c", "#e79ac6"],
  ["#4a9fcf", "#9fd4f5"], ["#b87d00", "#f0b73f"], ["#6f7782", "#aab4c0"], ["#20242b", "#eef2f6"]];
const DASHES = [[], [7, 4], [2, 3], [10, 3, 2, 3]];

function isDark() {
  return matchMedia("(prefers-color-scheme: dark)").matches;
}

/** The colour of curve `index`. */
function curveColour(index) {
  return CURVES[index % CURVES.length][isDark() ? 1 : 0];
}

/** Points of colour maps, equally apart. Viridis, and RdBu of ColorBrewer for signed values: lightness is even in both. */
const MAPS = {
  viridis: ["440154", "481467", "482576", "453781", "404688", "39558c", "33638d", "2d718e", "287d8e", "238a8d", "1f968b", "20a386", "29af7f",
    "3dbc74", "56c667", "75d054", "95d840", "bade28", "dde318", "fde725"],
  signed: ["053061", "2166ac", "4393c3", "92c5de", "d1e5f0", "f7f7f7", "fddbc7", "f4a582", "d6604d", "b2182b", "67001f"],
  cividis: ["00224e", "123570", "3b496c", "575d6d", "707173", "8a8678", "a59c74", "c3b369", "e1cc55", "fee838"],
};

/** 256 colours of a map as bytes of red, green, blue and opacity; the last is for missing values. */
function colourTable(name) {
  const points = MAPS[name].map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));
  const colours = new Uint8Array(256 * 4);
  for (let k = 0; k < 255; k += 1) {
    const place = (k / 254) * (points.length - 1);
    const first = Math.min(Math.floor(place), points.length - 2);
    for (let c = 0; c < 3; c += 1) {
      colours[4 * k + c] = Math.round(points[first][c] + (place - first) * (points[first + 1][c] - points[first][c]));
    }
    colours[4 * k + 3] = 255;
  }
  const missing = themed("--missing");
  colours.set([...[1, 3, 5].map((at) => parseInt(missing.slice(at, at + 2), 16)), 255], 255 * 4);
  return colours;
}

/** Places in a colour table for values: 0 to 254 between two ends, 255 for what is missing. */
function shares(values, [low, high]) {
  const scale = high > low ? 254 / (high - low) : 0;
  const found = new Uint8Array(values.length);
  for (let k = 0; k < values.length; k += 1) {
    const value = values[k];
    found[k] = value !== value ? 255 : Math.max(0, Math.min(254, Math.round((value - low) * scale)));
  }
  return found;
}
