"use strict";

const TOKENS = /(\/\/[^\n]*|\/\*[\s\S]*?\*\/)|("(?:\\[\s\S]|[^"\\])*"?)|(-?\b\d[\d_]*(?:\.\d*)?(?:[eE][+-]?\d+)?\b|-?\.\d+)|([A-Za-z_]\w*)/g;

/** The kind of a token of RON, for its colour. */
function kindOf(match, text) {
  if (match[1] !== undefined) return "s-comment";
  const after = text.slice(match.index + match[0].length, match.index + match[0].length + 20);
  const isKey = /^\s*:(?!:)/.test(after);
  if (match[2] !== undefined) return isKey ? "s-key" : "s-text";
  if (match[3] !== undefined) return "s-number";
  if (isKey) return "s-key";
  return /^[A-Z]|^true$|^false$/.test(match[4]) ? "s-type" : "";
}

/** A scene in colours, one element a line. */
function colouredScene(text) {
  const block = element("pre", { class: "scene", tabindex: "0", "aria-label": "Scene" });
  let line = element("span");
  const add = (piece, kind) => {
    piece.split("\n").forEach((part, k) => {
      if (k) {
        block.append(line);
        line = element("span");
      }
      if (part) line.append(kind ? element("span", { class: kind }, part) : part);
    });
  };
  let at = 0;
  for (const match of text.matchAll(TOKENS)) {
    add(text.slice(at, match.index), "");
    add(match[0], kindOf(match, text));
    at = match.index + match[0].length;
  }
  add(text.slice(at), "");
  if (line.hasChildNodes()) block.append(line);
  return block;
}

/** The scenes of all runs; of equal ones the first. */
function sceneSection(runs) {
  const parts = runs.filter((run) => run.scene).map((run, k, all) => {
    const same = all.slice(0, k).find((other) => other.scene === run.scene);
    const body = same ? element("p", { class: "plain" }, `The same as that of ${same.name}.`) : colouredScene(run.scene);
    return element("div", {}, runs.length > 1 ? element("h3", {}, run.name) : null, body);
  });
  return parts.length ? [element("div", { class: "columns" }, parts)] : null;
}
