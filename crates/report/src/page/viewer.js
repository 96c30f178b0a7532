"use strict";

const MARGIN = { left: 58, right: 10, top: 8, bottom: 44 };

/** How places become pixels: seen along an axis in the plane, turned in space. */
class Camera {
  constructor([low, high], up = 2) {
    this.box = [low, high];
    this.up = up;
    this.inSpace = low.length === 3;
    this.middle = [0, 1, 2].map((k) => (low[k] === undefined ? 0 : (low[k] + high[k]) / 2));
    this.depth = this.inSpace ? Math.hypot(...low.map((from, k) => high[k] - from)) : 1;
    this.reset();
  }

  reset() {
    Object.assign(this, { zoom: 1, shift: [0, 0], angles: this.inSpace ? [-0.6, 0.35] : [0, 0] });
  }

  /** Size of what is seen along both axes of the screen. */
  size() {
    if (this.inSpace) return [this.depth, this.depth * 0.7];
    return [0, 1].map((k) => Math.max(this.box[1][k] - this.box[0][k], 1e-300));
  }

  resize(width, height) {
    const [wide, tall] = this.size();
    const room = this.inSpace ? [width, height] : [width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom];
    Object.assign(this, { width, height, scale: this.zoom * Math.min(room[0] / wide, room[1] / tall) });
    const centre = this.inSpace ? [0, 0] : [(MARGIN.left - MARGIN.right) / 2, (MARGIN.bottom - MARGIN.top) / 2];
    this.offset = centre.map((pixels, k) => pixels / this.scale + this.shift[k]);
    const [around, up] = this.angles;
    const [ca, sa, cu, su] = [Math.cos(around), Math.sin(around), Math.cos(up), Math.sin(up)];
    // Columns of a turn about the axis that points up, then about the horizontal axis of the screen: axes to the right, up and
    // to the viewer.
    const columns = [[ca, su * sa, -cu * sa], [0, cu, su], [sa, -su * ca, cu * ca]];
    const turned = this.inSpace && this.up !== 1 ? { 0: [1, 2, 0], 2: [2, 0, 1] }[this.up] : [0, 1, 2];
    this.turn = turned.flatMap((k) => columns[k]);
  }

  project(place) {
    const [x, y, z] = this.middle.map((middle, k) => (place[k] === undefined ? 0 : place[k] - middle));
    const t = this.turn;
    const turned = [0, 1, 2].map((k) => t[k] * x + t[3 + k] * y + t[6 + k] * z);
    return [this.width / 2 + (turned[0] + this.offset[0]) * this.scale, this.height / 2 - (turned[1] + this.offset[1]) * this.scale, turned[2]];
  }

  /** The place below a pixel, in the plane. */
  unproject([x, y]) {
    return [(x - this.width / 2) / this.scale - this.offset[0] + this.middle[0], (this.height / 2 - y) / this.scale - this.offset[1] + this.middle[1]];
  }
}

/** Corners around those of all movies. */
function around(movies) {
  const boxes = movies.map((movie) => movie.box());
  const ends = (k, pick, of) => pick(...boxes.map((box) => box[of][k]));
  const axes = boxes[0][0].map((_, k) => k);
  return [axes.map((k) => ends(k, Math.min, 0)), axes.map((k) => ends(k, Math.max, 1))];
}

/** The axis against gravity; z where a scene does not tell. */
function upOf(scene) {
  const found = /\bgravity\s*:\s*\[([^\]]*)\]/.exec(scene || "");
  const parts = found ? found[1].split(",").map((text) => Math.abs(parseFloat(text.replace(/"/g, "")) || 0)) : [];
  const largest = Math.max(...parts);
  return largest > 0 ? parts.indexOf(largest) : 2;
}

function titleOf(movie) {
  if (!movie.plane || !movie.plane.in_space) return movie.name;
  return `${movie.name}, plane ${["x", "y", "z"][movie.plane.normal]} = ${quantity(movie.plane.cut, "m", 3)}`;
}

/** Names of the axes of the screen. */
function axesOf(movie) {
  return movie.plane ? [["y", "z"], ["x", "z"], ["x", "y"]][movie.plane.normal] : ["x", "y"];
}

/** The frames of a run: a plane of a fluid below, points above, colours and values. */
class Viewer {
  constructor(run) {
    this.run = run;
    this.movies = run.movies.map((data) => new Movie(data));
    this.points = this.movies.filter((movie) => !movie.plane);
    this.planes = this.movies.filter((movie) => movie.plane);
    this.shown = { points: this.firstChoice(this.points), plane: this.firstChoice(this.planes) };
    if (this.shown.points && this.shown.points.movie.inSpace) this.shown.plane = null;
    this.whole = true;
    this.time = 0;
    this.peers = [];
  }

  /** The field that tells most at first: a speed. */
  firstChoice(movies) {
    const all = movies.flatMap((movie) => movie.choices.map((choice) => ({ movie, choice })));
    return all.find(({ choice }) => choice.name === "speed" || choice.isLength) || all[0] || (movies[0] ? { movie: movies[0], choice: null } : null);
  }

  /** Makes the elements, once the viewers of the other runs are there. */
  begin(peers) {
    this.peers = peers;
    this.build();
    whenLookChanges(() => this.draw(this.time));
  }

  times() {
    return this.movies.flatMap((movie) => movie.times);
  }

  build() {
    this.canvases = [0, 1, 2].map(() => element("canvas", { "aria-hidden": "true" }));
    this.stage = element("div", { class: "stage", role: "img" }, this.canvases, this.tools());
    this.readout = element("div", { class: "readout", hidden: true });
    this.stage.append(this.readout);
    this.bars = element("div");
    this.note = element("p", { class: "note" });
    this.node = element("div", { class: "viewer" }, this.heading(), this.controls(), this.stage, this.bars, this.note);
    this.planeLayer = new PlaneLayer(this.canvases[0]);
    this.pointsLayer = pointsOn(this.canvases[1], Math.max(0, ...this.points.flatMap((movie) => movie.counts)));
    this.canvases[1] = this.pointsLayer.canvas;
    this.overlay = this.canvases[2].getContext("2d");
    this.listen();
    this.choose();
  }

  heading() {
    return element("h3", {}, this.run.name);
  }

  tools() {
    const button = (text, label, act) => element("button", { type: "button", "aria-label": label, title: label, onclick: act }, text);
    const zoom = (factor) => () => { this.camera.zoom = Math.max(0.2, Math.min(200, this.camera.zoom * factor)); this.draw(this.time); };
    return element("div", { class: "tools" }, button("+", "Closer", zoom(1.5)), button("−", "Farther", zoom(1 / 1.5)),
      button("⌂", "Show all", () => { this.camera.reset(); this.draw(this.time); }));
  }

  controls() {
    const list = (movies) => movies.flatMap((movie, m) => movie.choices.map((choice, c) => [`${m}.${c}`, `${titleOf(movie)}: ${words(choice.name)}`]));
    const pick = (kind, movies) => (value) => {
      const [m, c] = value.split(".").map(Number);
      this.shown[kind] = value === "none" ? null : { movie: movies[m], choice: movies[m].choices[c] || null };
      this.choose();
      this.draw(this.time);
    };
    const select = (label, kind, movies) => {
      const own = this.shown[kind];
      const value = own ? `${movies.indexOf(own.movie)}.${own.movie.choices.indexOf(own.choice)}` : "none";
      return chooser(label, [...list(movies), ...movies.map((movie, m) => [`${m}.-1`, `${titleOf(movie)}: one colour`]).filter(() => kind === "points"), ["none", "nothing"]], value, pick(kind, movies));
    };
    return element("div", { class: "controls" },
      this.points.length ? select("Points, coloured by", "points", this.points) : null,
      this.planes.length ? select("Field on a grid", "plane", this.planes) : null,
      check("the same colours at all times", true, (yes) => { this.whole = yes; this.draw(this.time); }));
  }

  /** Movies that are shown together; points in space hide planes. */
  active() {
    const { points, plane } = this.shown;
    if (points && points.movie.inSpace) return [points];
    return [plane, points].filter((layer) => layer);
  }

  /** Prepares what was chosen. */
  choose() {
    const active = this.active();
    const key = active.map((layer) => layer.movie.name + JSON.stringify(layer.movie.plane)).join();
    if (active.length && key !== this.key) {
      const alike = active.flatMap((layer) => this.alike(layer.movie));
      this.camera = new Camera(around(alike), upOf(this.run.scene));
    }
    this.key = key;
    this.tellErrors(active);
  }

  /** A movie and those of the other runs that show the same, so that runs can be compared by eye. */
  alike(movie) {
    const isAlike = (other) => other.name === movie.name && other.box()[0].length === movie.box()[0].length
      && (other.plane && other.plane.normal) === (movie.plane && movie.plane.normal);
    return [movie, ...this.peers.filter((peer) => peer !== this).flatMap((peer) => peer.movies.filter(isAlike))];
  }

  /** Ends of the colours of a choice in all runs that have it. */
  range(movie, choice) {
    const ranges = this.alike(movie).map((other) => {
      const own = other.choices.find(({ name, unit }) => name === choice.name && unit === choice.unit);
      return own && other.range(own);
    });
    return extent(ranges.filter((range) => range));
  }

  tellErrors(active) {
    const texts = active.map(({ movie, choice }) => {
      const place = movie.places.length ? `places are exact to ${quantity(Math.max(...movie.places.map((axis) => axis.error)), "m", 2)}` : "";
      const value = choice ? `${words(choice.name)} to ${quantity(movie.error(choice), choice.unit, 2)}` : "";
      const frames = movie.frames > movie.times.length ? `; ${movie.times.length} of ${movie.frames} frames are here` : "";
      return `${titleOf(movie)}: ${[place, value].filter((text) => text).join(", ")}${frames}`;
    });
    const radius = active.some(({ movie }) => !movie.plane && !movie.radius) ? " Points have no radius in the files; their size here is a guess." : "";
    const turn = this.camera && this.camera.inSpace ? " Drag to turn." : " Drag to move.";
    this.note.textContent = `${texts.join(". ")}.${radius}${turn}`;
  }

  listen() {
    const at = (event) => {
      const box = this.stage.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    this.stage.addEventListener("pointerdown", (event) => {
      if (event.target.closest("button")) return;
      this.drag = at(event);
      this.stage.setPointerCapture(event.pointerId);
    });
    this.stage.addEventListener("pointerup", () => { this.drag = null; });
    this.stage.addEventListener("pointercancel", () => { this.drag = null; });
    this.stage.addEventListener("pointerleave", () => { this.readout.hidden = true; });
    this.stage.addEventListener("pointermove", (event) => (this.drag ? this.move(at(event)) : this.read(at(event))));
    this.stage.addEventListener("wheel", (event) => {
      // A wheel alone scrolls the page.
      if (!event.ctrlKey || !this.camera) return;
      event.preventDefault();
      this.camera.zoom = Math.max(0.2, Math.min(200, this.camera.zoom * Math.exp(-event.deltaY / 300)));
      this.draw(this.time);
    }, { passive: false });
  }

  move([x, y]) {
    if (!this.camera) return;
    const [dx, dy] = [x - this.drag[0], y - this.drag[1]];
    this.drag = [x, y];
    const { camera } = this;
    if (camera.inSpace) camera.angles = [camera.angles[0] + dx / 150, Math.max(-1.57, Math.min(1.57, camera.angles[1] + dy / 150))];
    else camera.shift = [camera.shift[0] + dx / camera.scale, camera.shift[1] - dy / camera.scale];
    this.draw(this.time);
  }

  /** Tells the value below the pointer. */
  read(pixel) {
    const lines = this.active().reverse().map((layer) => this.valueAt(layer, pixel)).filter((text) => text);
    this.readout.hidden = !lines.length;
    this.readout.replaceChildren(...lines.map((text) => element("div", {}, text)));
    const isLeft = pixel[0] < this.stage.clientWidth / 2;
    this.readout.style.left = isLeft ? `${pixel[0] + 14}px` : "";
    this.readout.style.right = isLeft ? "" : `${this.stage.clientWidth - pixel[0] + 14}px`;
    this.readout.style.top = `${Math.max(4, pixel[1] - 20)}px`;
  }

  valueAt({ movie, choice }, pixel) {
    const frame = movie.at(this.time);
    if (!choice) return "";
    const tell = (k) => `${words(choice.name)}: ${quantity(movie.values(choice, frame)[k], choice.unit)}`;
    if (movie.plane) {
      const cell = cellAt(movie, this.camera, pixel);
      return cell < 0 ? "" : tell(cell);
    }
    let [best, depth] = [-1, -Infinity];
    const points = projected(movie, frame, this.camera);
    for (let k = 0; k < points.x.length; k += 1) {
      const isBelow = Math.hypot(points.x[k] - pixel[0], points.y[k] - pixel[1]) <= Math.max(points.size[k], 2);
      if (isBelow && points.depth[k] >= depth) [best, depth] = [k, points.depth[k]];
    }
    return best < 0 ? "" : tell(best);
  }

  /** Draws the frames of a time. */
  draw(time) {
    this.time = time;
    const width = this.node.clientWidth;
    const active = this.active();
    if (!width) return undefined;
    if (!active.length) return this.drawNothing();
    const [wide, tall] = this.camera.size();
    const height = Math.round(Math.max(220, Math.min(560, ((width - 68) * tall) / wide + 52)));
    this.stage.style.height = `${height}px`;
    this.canvases.forEach((canvas) => fit(canvas, width, height));
    this.camera.resize(width, height);
    const bars = active.map((layer) => this.drawLayer(layer));
    if (!active.some(({ movie }) => movie.plane)) this.planeLayer.clear();
    if (!active.some(({ movie }) => !movie.plane)) this.pointsLayer.clear();
    this.drawAxes(width, height, active);
    this.drawBars(bars.filter((bar) => bar));
    this.stage.setAttribute("aria-label", `${active.map(({ movie }) => titleOf(movie)).join(" and ")} of ${this.run.name} at ${quantity(time, "s")}`);
    return undefined;
  }

  drawNothing() {
    [this.planeLayer, this.pointsLayer].forEach((layer) => layer.clear());
    this.overlay.clearRect(0, 0, this.canvases[2].width, this.canvases[2].height);
    this.bars.replaceChildren();
    this.barsKey = "";
    return undefined;
  }

  drawLayer({ movie, choice }) {
    const frame = movie.at(this.time);
    const values = choice && movie.values(choice, frame);
    const { map, ends } = colouring(!choice ? [0, 1] : this.whole ? this.range(movie, choice) : extent([values]) || [0, 1]);
    const look = { colours: colourTable(map), shares: values && shares(values, ends), camera: this.camera };
    if (movie.plane) this.planeLayer.draw(movie, look);
    else this.pointsLayer.draw(movie, frame, look);
    return choice && { title: `${this.active().length > 1 ? `${titleOf(movie)}: ` : ""}${axisTitle(choice.name, choice.unit)}`, ends, colours: look.colours };
  }

  drawBars(bars) {
    const key = JSON.stringify(bars.map(({ title, ends }) => [title, ends, isDark()]));
    if (key === this.barsKey) return;
    this.barsKey = key;
    this.bars.replaceChildren(...bars.map(({ title, ends: [low, high], colours }) => {
      const strip = element("canvas", { width: "255", height: "1", "aria-hidden": "true" });
      strip.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(colours.slice(0, 255 * 4)), 255, 1), 0, 0);
      return element("div", { class: "colourbar" }, title, strip, element("div", { class: "ends" }, [low, (low + high) / 2, high].map((value) => element("span", {}, shown(value, 3)))));
    }));
  }

  drawAxes(width, height, active) {
    const context = this.overlay;
    const ratio = context.canvas.width / width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = `12px ${themed("--sans")}`;
    if (this.camera.inSpace) this.drawScale(context, height);
    else this.drawFrame(context, width, height, axesOf(active[0].movie));
  }

  /** Axes with numbers around the plane. */
  drawFrame(context, width, height, names) {
    const [left, right, top, bottom] = [MARGIN.left, width - MARGIN.right, MARGIN.top, height - MARGIN.bottom];
    const [low, high] = [this.camera.unproject([left, bottom]), this.camera.unproject([right, top])];
    context.fillStyle = themed("--card");
    context.fillRect(0, 0, left, height);
    context.fillRect(0, bottom, width, height - bottom);
    context.fillRect(right, 0, width - right, height);
    context.fillRect(0, 0, width, top);
    context.strokeStyle = themed("--line");
    context.strokeRect(left, top, right - left, bottom - top);
    context.fillStyle = themed("--soft");
    context.textAlign = "center";
    context.textBaseline = "top";
    const x = ticks(low[0], high[0], (right - left) / 90);
    tickTexts(x).forEach((text, k) => context.fillText(text, this.camera.project([x[k], low[1]])[0], bottom + 5));
    context.textAlign = "right";
    context.textBaseline = "middle";
    const y = ticks(low[1], high[1], (bottom - top) / 50);
    tickTexts(y).forEach((text, k) => context.fillText(text, left - 6, this.camera.project([low[0], y[k]])[1]));
    context.fillStyle = themed("--ink");
    context.textAlign = "center";
    context.fillText(`${names[0]} [m]`, (left + right) / 2, bottom + 31);
    context.save();
    context.translate(9, (top + bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.fillText(`${names[1]} [m]`, 0, 0);
    context.restore();
  }

  /** A length to compare with, and where the axes point. */
  drawScale(context, height) {
    const { camera } = this;
    const length = roundBelow(140 / camera.scale);
    context.strokeStyle = themed("--ink");
    context.fillStyle = themed("--ink");
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(12, height - 12);
    context.lineTo(12 + length * camera.scale, height - 12);
    context.stroke();
    context.textBaseline = "bottom";
    context.textAlign = "left";
    context.fillText(quantity(length, "m"), 12, height - 16);
    ["x", "y", "z"].forEach((name, k) => {
      const [dx, dy] = [camera.turn[3 * k] * 26, -camera.turn[3 * k + 1] * 26];
      context.beginPath();
      context.moveTo(40, 46);
      context.lineTo(40 + dx, 46 + dy);
      context.stroke();
      context.fillText(name, 36 + dx * 1.4, 52 + dy * 1.4);
    });
  }
}

/** Plays the frames of all runs at the same times. */
class Player {
  constructor(viewers) {
    this.viewers = viewers;
    this.times = [...new Set(viewers.flatMap((viewer) => viewer.times()))].sort((a, b) => a - b);
    this.speed = 10;
    this.index = 0;
    this.frames = 0;
    this.button = element("button", { class: "main", type: "button", onclick: () => (this.timer ? this.pause() : this.play()) }, "Play");
    this.slider = element("input", { type: "range", min: "0", max: String(this.times.length - 1), value: "0", "aria-label": "Time", oninput: () => { this.pause(); this.show(Number(this.slider.value)); } });
    this.output = element("output");
    const speeds = [[2, "2 frames a second"], [5, "5 frames a second"], [10, "10 frames a second"], [25, "25 frames a second"], [1000, "as fast as it goes"]];
    const speed = chooser("", speeds.map(([value, text]) => [String(value), text]), "10", (value) => { this.speed = Number(value); });
    speed.querySelector("select").setAttribute("aria-label", "Speed");
    this.node = element("div", { class: "player" }, this.button, this.slider, this.output, speed);
  }

  play() {
    if (this.index >= this.times.length - 1) this.index = -1;
    this.button.textContent = "Pause";
    let due = 0;
    const next = (now) => {
      if (now >= due) {
        due = now + 1000 / this.speed - 4;
        this.show(this.index + 1);
        if (this.index >= this.times.length - 1) return this.pause();
      }
      this.timer = requestAnimationFrame(next);
      return undefined;
    };
    this.timer = requestAnimationFrame(next);
  }

  pause() {
    cancelAnimationFrame(this.timer);
    this.timer = null;
    this.button.textContent = "Play";
  }

  /** Shows the frames of time `index`. */
  show(index) {
    this.index = Math.max(0, Math.min(this.times.length - 1, index));
    this.frames += 1;
    const time = this.times[this.index];
    this.slider.value = String(this.index);
    this.output.textContent = `t = ${quantity(time, "s")}`;
    this.slider.setAttribute("aria-valuetext", quantity(time, "s"));
    this.viewers.forEach((viewer) => viewer.draw(time));
  }
}

/** Grains, material points and fluids over time. */
function animationSection(runs) {
  const viewers = runs.filter((run) => run.movies.length).map((run) => new Viewer(run));
  if (!viewers.length) return null;
  viewers.forEach((viewer) => viewer.begin(viewers));
  const player = new Player(viewers);
  if (runs.length === 1) viewers[0].node.querySelector("h3").remove();
  return { nodes: [player.node, element("div", { class: "viewers" }, viewers.map((viewer) => viewer.node))], start: () => player.show(0), player };
}
