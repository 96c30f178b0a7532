"use strict";

/** An element with attributes, listeners (`onclick`) and children. Texts become text nodes, so nothing in them is read as HTML. */
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return made;
}

/** A table of a head and rows; cells are texts or elements, and `numbers` are the columns to align right. */
function table(head, rows, numbers = []) {
  const align = (k) => (numbers.includes(k) ? { class: "number" } : {});
  const cells = (row) => row.map((cell, k) => (k ? element("td", align(k), cell) : element("th", { scope: "row" }, cell)));
  const body = element("tbody", {}, rows.map((row) => element("tr", {}, cells(row))));
  const titles = head && element("thead", {}, element("tr", {}, head.map((title, k) => element("th", { scope: "col", ...align(k) }, title))));
  return element("div", { class: "scroll" }, element("table", {}, titles, body));
}

/** A sentence in which what stands between backticks is code. */
function sentence(text) {
  return text.split("`").map((part, k) => (k % 2 ? element("code", {}, part) : part));
}

/** A select with a label; `options` are pairs of value and text. */
function chooser(label, options, chosen, onchange) {
  const select = element("select", { onchange: (event) => onchange(event.target.value) },
    options.map(([value, text]) => element("option", { value, selected: value === chosen }, text)));
  return element("label", {}, label, select);
}

/** A check box with a label. */
function check(label, checked, onchange) {
  return element("label", { class: "check" }, element("input", { type: "checkbox", checked, onchange: (event) => onchange(event.target.checked) }), label);
}

/** The value of a custom property of the style sheet, which differs between light and dark. */
function themed(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Sets a canvas to the pixels of the screen and returns its size in CSS pixels. */
function fit(canvas, width, height) {
  const ratio = window.devicePixelRatio || 1;
  const [columns, rows] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== columns || canvas.height !== rows) {
    canvas.width = columns;
    canvas.height = rows;
  }
  return ratio;
}

const redraws = new Set();
/** Calls back when the window or the colour scheme changes. */
function whenLookChanges(redraw) {
  redraws.add(redraw);
}
let pending = 0;
function lookChanged() {
  cancelAnimationFrame(pending);
  pending = requestAnimationFrame(() => redraws.forEach((redraw) => redraw()));
}
addEventListener("resize", lookChanged);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", lookChanged);
