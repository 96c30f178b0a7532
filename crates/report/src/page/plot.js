"use strict";

/**
 * Curves over an axis, on a canvas: drag to zoom, double click to see all, hover or arrow keys to read values.
 * A curve is { label, x, y, colour: index or text, dash: index, base: values below which it is filled or nothing }.
 */
class Plot {
  constructor({ x, y, height = 280, marks = [], onzoom = () => {} }) {
    Object.assign(this, { axes: { x, y }, height, marks, onzoom, curves: [], zoom: null, cursor: null, drag: null });
    this.canvas = element("canvas", { tabindex: "0", role: "img" });
    this.readout = element("div", { class: "readout", hidden: true });
    this.reset = element("button", { class: "reset", type: "button", hidden: true, onclick: () => this.zoomTo(null, true) }, "Show all");
    this.node = element("div", { class: "plot" }, this.canvas, this.reset, this.readout);
    this.listen();
    whenLookChanges(() => this.draw());
  }

  /** Replaces the curves and draws them. */
  show(curves) {
    this.curves = curves;
    const names = curves.map((curve) => curve.label).join(", ");
    this.canvas.setAttribute("aria-label", `${names}: ${this.axes.y.title} over ${this.axes.x.title}. Arrow keys read values.`);
    this.draw();
  }

  listen() {
    const at = (event) => {
      const box = this.canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      this.drag = { from: at(event), to: at(event) };
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (this.drag) this.drag.to = at(event);
      this.cursor = at(event);
      this.draw();
    });
    this.canvas.addEventListener("pointerup", () => this.endDrag());
    this.canvas.addEventListener("pointercancel", () => { this.drag = null; this.leave(); });
    this.canvas.addEventListener("pointerleave", () => this.leave());
    this.canvas.addEventListener("dblclick", () => this.zoomTo(null, true));
    this.canvas.addEventListener("blur", () => this.leave());
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  leave() {
    this.cursor = null;
    this.draw();
  }

  key(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (event.key === "Escape") this.zoomTo(null, true);
    if (!step || !this.frame) return;
    event.preventDefault();
    const { left, right, top, bottom } = this.frame;
    const [x] = this.cursor || [step > 0 ? left : right];
    const distance = (right - left) / (event.shiftKey ? 10 : 100);
    this.cursor = [Math.max(left, Math.min(right, x + step * distance)), (top + bottom) / 2];
    this.draw();
  }

  endDrag() {
    const { from, to } = this.drag || { from: [0, 0], to: [0, 0] };
    this.drag = null;
    const [wide, tall] = [Math.abs(to[0] - from[0]) > 8, Math.abs(to[1] - from[1]) > 24];
    if (!wide && !tall) return this.draw();
    const ends = (axis, k, yes) => {
      if (!yes) return null;
      const both = [this.frame.back[axis](from[k]), this.frame.back[axis](to[k])].sort((a, b) => a - b);
      return both[1] > both[0] ? both : null;
    };
    return this.zoomTo({ x: ends("x", 0, wide), y: ends("y", 1, tall) }, true);
  }

  /** Shows a part, or all; tells those that follow. */
  zoomTo(zoom, tell) {
    this.zoom = zoom && (zoom.x || zoom.y) ? zoom : null;
    this.reset.hidden = !this.zoom;
    this.draw();
    if (tell) this.onzoom(this.zoom && this.zoom.x);
  }

  /** Ends of both axes. */
  ends() {
    const isUsed = (axis) => (this.axes[axis].log ? (value) => value > 0 : Number.isFinite);
    const x = (this.zoom && this.zoom.x) || extent(this.curves.map((curve) => curve.x), isUsed("x")) || [0, 1];
    const seen = (curve) => curve.y.filter((_, k) => curve.x[k] >= x[0] && curve.x[k] <= x[1]);
    const bases = this.curves.filter((curve) => curve.base).map((curve) => curve.base);
    const y = (this.zoom && this.zoom.y) || extent([...this.curves.map(seen), ...bases], isUsed("y")) || [0, 1];
    return { x: this.padded(x, "x", 0), y: this.zoom && this.zoom.y ? y : this.padded(y, "y", 0.05) };
  }

  padded([low, high], axis, share) {
    if (this.axes[axis].log) {
      return low === high ? [low / 2, high * 2] : [low / (high / low) ** share, high * (high / low) ** share];
    }
    const span = high - low || Math.abs(low) || 1;
    return low === high ? [low - span / 2, high + span / 2] : [low - share * span, high + share * span];
  }

  /** Where the axes lie and how numbers become pixels. */
  layout(context, width) {
    const ends = this.ends();
    const find = (axis, count) => (this.axes[axis].log ? logTicks(...ends[axis]) : ticks(...ends[axis], count));
    const y = find("y", this.height / 55);
    const texts = this.axes.y.log ? y.map((value) => shown(value, 2)) : tickTexts(y);
    const left = 34 + Math.max(20, ...texts.map((text) => context.measureText(text).width));
    const frame = { left, right: width - 14, top: 12, bottom: this.height - 46, ends, y, texts };
    frame.x = find("x", (frame.right - left) / 90);
    const map = (axis, from, to) => {
      const bend = this.axes[axis].log ? Math.log10 : (value) => value;
      const [low, high] = ends[axis].map(bend);
      return [(value) => from + ((bend(value) - low) / (high - low)) * (to - from),
        (pixel) => { const at = low + ((pixel - from) / (to - from)) * (high - low); return this.axes[axis].log ? 10 ** at : at; }];
    };
    const [toX, backX] = map("x", frame.left, frame.right);
    const [toY, backY] = map("y", frame.bottom, frame.top);
    return Object.assign(frame, { to: { x: toX, y: toY }, back: { x: backX, y: backY } });
  }

  draw() {
    const width = this.node.clientWidth;
    if (!width) return;
    const ratio = fit(this.canvas, width, this.height);
    this.canvas.style.height = `${this.height}px`;
    const context = this.canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, this.height);
    context.font = `12px ${themed("--sans")}`;
    this.frame = this.layout(context, width);
    this.drawAxes(context);
    context.save();
    const { left, right, top, bottom } = this.frame;
    context.beginPath();
    context.rect(left, top, right - left, bottom - top);
    context.clip();
    this.drawMarks(context);
    this.curves.forEach((curve) => this.drawCurve(context, curve));
    context.restore();
    this.drawDrag(context);
    this.drawCursor(context, width);
  }

  drawAxes(context) {
    const { left, right, top, bottom, to, x, y, texts } = this.frame;
    context.lineWidth = 1;
    context.fillStyle = themed("--soft");
    context.strokeStyle = themed("--grid");
    context.beginPath();
    x.forEach((value) => { context.moveTo(to.x(value), top); context.lineTo(to.x(value), bottom); });
    y.forEach((value) => { context.moveTo(left, to.y(value)); context.lineTo(right, to.y(value)); });
    context.stroke();
    context.strokeStyle = themed("--soft");
    context.beginPath();
    context.moveTo(left, top);
    context.lineTo(left, bottom);
    context.lineTo(right, bottom);
    context.stroke();
    context.textAlign = "right";
    context.textBaseline = "middle";
    texts.forEach((text, k) => context.fillText(text, left - 6, to.y(y[k])));
    context.textAlign = "center";
    context.textBaseline = "top";
    const below = this.axes.x.log ? x.map((value) => shown(value, 2)) : tickTexts(x);
    below.forEach((text, k) => context.fillText(text, to.x(x[k]), bottom + 6));
    context.fillStyle = themed("--ink");
    context.font = `13px ${themed("--sans")}`;
    context.fillText(this.axes.x.title, (left + right) / 2, bottom + 25);
    context.save();
    context.translate(9, (top + bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.textBaseline = "middle";
    context.fillText(this.axes.y.title, 0, 0);
    context.restore();
    context.font = `12px ${themed("--sans")}`;
  }

  /** Lines across, with names: where stages begin. */
  drawMarks(context) {
    const { top, bottom, right, to } = this.frame;
    context.fillStyle = themed("--soft");
    context.strokeStyle = themed("--soft");
    context.textAlign = "left";
    context.textBaseline = "top";
    context.setLineDash([2, 4]);
    for (const [k, { at, name }] of this.marks.entries()) {
      const x = to.x(at);
      const next = this.marks[k + 1] ? to.x(this.marks[k + 1].at) : right;
      context.beginPath();
      context.moveTo(x, top);
      context.lineTo(x, bottom);
      context.stroke();
      // A name that would lie on the next one is left out; the section of stages has it.
      if (x + 8 + context.measureText(name).width < next) context.fillText(name, x + 4, top + 2);
    }
    context.setLineDash([]);
  }

  drawCurve(context, curve) {
    const { to } = this.frame;
    context.beginPath();
    let isDown = false;
    for (let k = 0; k < curve.x.length; k += 1) {
      const [x, y] = [to.x(curve.x[k]), to.y(curve.y[k])];
      const isThere = Number.isFinite(x) && Number.isFinite(y);
      if (isThere) context[isDown ? "lineTo" : "moveTo"](x, y);
      isDown = isThere && !(curve.breaks && curve.breaks.has(k + 1));
    }
    context.lineWidth = curve.base ? 1 : 1.8;
    context.lineJoin = "round";
    context.strokeStyle = colourOf(curve);
    context.setLineDash(DASHES[(curve.dash || 0) % DASHES.length]);
    context.stroke();
    context.setLineDash([]);
    if (!curve.base) return;
    for (let k = curve.x.length - 1; k >= 0; k -= 1) context.lineTo(to.x(curve.x[k]), to.y(curve.base[k]));
    context.globalAlpha = 0.55;
    context.fillStyle = colourOf(curve);
    context.fill();
    context.globalAlpha = 1;
  }

  drawDrag(context) {
    if (!this.drag) return;
    const { left, right, top, bottom } = this.frame;
    const [x0, x1] = [this.drag.from[0], this.drag.to[0]].map((x) => Math.max(left, Math.min(right, x)));
    const isTall = Math.abs(this.drag.to[1] - this.drag.from[1]) > 24;
    const [y0, y1] = isTall ? [this.drag.from[1], this.drag.to[1]] : [top, bottom];
    context.globalAlpha = 0.15;
    context.fillStyle = themed("--accent");
    context.fillRect(Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0), Math.abs(y1 - y0));
    context.globalAlpha = 1;
  }

  /** The row of each curve that is nearest to the cursor: along x where rows are in order, else on the screen. */
  nearest(curve, [x, y]) {
    const { to } = this.frame;
    let [best, distance] = [-1, Infinity];
    for (let k = 0; k < curve.x.length; k += 1) {
      const across = Math.abs(to.x(curve.x[k]) - x);
      const away = curve.ordered ? across : Math.hypot(across, to.y(curve.y[k]) - y);
      if (away < distance && Number.isFinite(curve.y[k])) [best, distance] = [k, away];
    }
    return best;
  }

  drawCursor(context, width) {
    const { left, right, top, bottom, to } = this.frame;
    this.readout.hidden = true;
    if (!this.cursor || this.drag || this.cursor[0] < left || this.cursor[0] > right) return;
    const found = this.curves.map((curve) => [curve, this.nearest(curve, this.cursor)]).filter(([, k]) => k >= 0);
    const away = ([curve, k]) => Math.abs(to.y(curve.y[k]) - this.cursor[1]);
    if (found.length > 10) found.sort((a, b) => away(a) - away(b)).splice(10);
    if (!found.length) return;
    const first = found[0][0].x[found[0][1]];
    context.strokeStyle = themed("--soft");
    context.setLineDash([3, 3]);
    context.beginPath();
    context.moveTo(to.x(first), top);
    context.lineTo(to.x(first), bottom);
    context.stroke();
    context.setLineDash([]);
    for (const [curve, k] of found) {
      context.fillStyle = colourOf(curve);
      context.beginPath();
      context.arc(to.x(curve.x[k]), to.y(curve.y[k]), 3.5, 0, 7);
      context.fill();
    }
    this.tell(found, first, width);
  }

  tell(found, x, width) {
    const lines = found.map(([curve, k]) => element("div", {}, swatch(curve), ` ${curve.label}: ${quantity(curve.values ? curve.values[k] : curve.y[k], this.axes.y.unit, 5)}`));
    this.readout.replaceChildren(element("strong", {}, `${this.axes.x.name} ${quantity(x, this.axes.x.unit, 6)}`), ...lines);
    this.readout.hidden = false;
    const at = this.frame.to.x(x);
    this.readout.style.top = "1.2rem";
    this.readout.style.left = at < width / 2 ? `${at + 14}px` : "";
    this.readout.style.right = at < width / 2 ? "" : `${width - at + 14}px`;
  }
}

function colourOf(curve) {
  return typeof curve.colour === "string" ? curve.colour : curveColour(curve.colour || 0);
}

/** A piece of a curve, for legends. */
function swatch(curve) {
  const space = "http://www.w3.org/2000/svg";
  const [drawing, line] = [document.createElementNS(space, "svg"), document.createElementNS(space, "line")];
  for (const [name, value] of [["width", 26], ["height", 8], ["aria-hidden", "true"]]) drawing.setAttribute(name, value);
  for (const [name, value] of [["x1", 1], ["x2", 25], ["y1", 4], ["y2", 4], ["stroke-width", curve.base ? 7 : 2.5]]) line.setAttribute(name, value);
  line.style.stroke = colourOf(curve);
  line.setAttribute("stroke-dasharray", DASHES[(curve.dash || 0) % DASHES.length].join(" "));
  drawing.append(line);
  return drawing;
}

/** What curves mean. */
function legend(curves) {
  return element("ul", { class: "legend" }, curves.map((curve) => element("li", {}, swatch(curve), curve.label)));
}

/** Whether numbers never go down, so that a place among them is one row. */
function isOrdered(values) {
  for (let k = 1; k < values.length; k += 1) if (values[k] < values[k - 1]) return false;
  return true;
}
