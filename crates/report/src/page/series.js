"use strict";

/** Curves that a table with several rows at each time is cut into, at most. */
const MOST_GROUPS = 12;
/** Columns that are shown at first, where a table has them. */
const FIRST_COLUMNS = ["front", "height", "kinetic_energy", "largest_speed", "coordination", "drag", "lift"];

/** The numbers of a column of a table of the page; none where the table lacks it. */
function columnOf(data, name) {
  const column = data.columns.find((other) => other.name === name);
  return column ? numbersOf(column.array, Float64Array) : null;
}

function unitOf(data, name) {
  const column = data.columns.find((other) => other.name === name);
  return column ? column.unit : "";
}

/** The column that tells rows at one time apart: what rows of a profile are at, or which grain a row is of. */
function grouping(data) {
  const names = data.columns.map((column) => column.name);
  if (names[0] !== "time") return null;
  if (names.includes("distance")) return { x: "distance", by: "time" };
  return names.includes("id") ? { x: "time", by: "id" } : null;
}

/** Where the stages of a run begin, for axes of time. */
function marksOf(run) {
  const stages = run.facts.stages || [];
  return stages.length > 1 ? stages.map((stage) => ({ at: stage.start, name: stage.name })) : [];
}

/** The tables of a name, one a run that has it. */
class Tables {
  constructor(name, runs) {
    this.name = name;
    this.parts = runs.map((run) => ({ run, data: run.tables.find((data) => data.name === name) })).filter((part) => part.data);
    const all = this.parts.flatMap((part) => part.data.columns.map((column) => column.name));
    this.columns = [...new Set(all)];
    this.groups = grouping(this.parts[0].data);
    this.x = this.groups ? this.groups.x : this.columns[0];
    const others = this.columns.filter((column) => column !== this.x && column !== (this.groups || {}).by);
    const first = FIRST_COLUMNS.filter((column) => others.includes(column)).slice(0, 2);
    this.chosen = new Set(first.length ? first : others.slice(0, 1));
  }

  unit(column) {
    const part = this.parts.find(({ data }) => data.columns.some((other) => other.name === column));
    return part ? unitOf(part.data, column) : "";
  }

  /** Chosen columns by their units. */
  byUnit() {
    const found = new Map();
    for (const column of this.columns.filter((name) => this.chosen.has(name))) {
      const unit = this.unit(column);
      found.set(unit, [...(found.get(unit) || []), column]);
    }
    return found;
  }

  /** The curves of some columns: a colour each, or a colour a run where there are several. */
  curves(columns) {
    const several = this.parts.length > 1;
    return columns.flatMap((column, c) => this.parts.flatMap(({ run, data }) => {
      const [x, y] = [columnOf(data, this.x), columnOf(data, column)];
      if (!x || !y) return [];
      const label = several ? (columns.length > 1 ? `${run.name}: ${words(column)}` : run.name) : words(column);
      const curve = { label, x, y, colour: several ? run.index : c, dash: several ? c : 0, ordered: isOrdered(x) };
      return this.groups && this.x === this.groups.x ? split(curve, columnOf(data, this.groups.by), this.groups.by) : [curve];
    }));
  }
}

/** A curve for each value of a column, the values evenly chosen, in colours along a map. */
function split(curve, by, name) {
  const values = [...new Set(by)];
  const count = Math.min(values.length, MOST_GROUPS);
  const chosen = [...new Set(Array.from({ length: count }, (_, k) => values[Math.round((k * (values.length - 1)) / Math.max(count - 1, 1))]))];
  const colours = colourTable(isDark() ? "cividis" : "viridis");
  return chosen.map((value, k) => {
    const rows = [...by.keys()].filter((row) => by[row] === value);
    const at = 4 * Math.round((isDark() ? 40 + (k / Math.max(count - 1, 1)) * 214 : (k / Math.max(count - 1, 1)) * 215));
    const x = Float64Array.from(rows, (row) => curve.x[row]);
    const label = `${curve.label}, ${name === "time" ? `t = ${shown(value, 3)} s` : `${name} ${value}`}`;
    return { ...curve, label, x, y: Float64Array.from(rows, (row) => curve.y[row]), colour: `rgb(${colours.slice(at, at + 3).join(",")})`, ordered: isOrdered(x) };
  });
}

/** Charts of one table, with what can be chosen. */
class SeriesPanel {
  constructor(tables) {
    this.tables = tables;
    this.log = { x: false, y: false };
    this.charts = element("div");
    this.plots = [];
    this.node = element("div", {}, this.controls(), this.chips(), this.charts, this.notes());
  }

  controls() {
    const options = this.tables.columns.map((name) => [name, axisTitle(name, this.tables.unit(name))]);
    const pick = (name) => { this.tables.x = name; this.draw(); };
    const log = (axis) => (yes) => { this.log[axis] = yes; this.draw(); };
    return element("div", { class: "controls" }, chooser("Horizontal axis", options, this.tables.x, pick),
      check("logarithmic x", false, log("x")), check("logarithmic y", false, log("y")));
  }

  chips() {
    const chip = (name) => element("label", {}, element("input", {
      type: "checkbox", checked: this.tables.chosen.has(name),
      onchange: (event) => { this.tables.chosen[event.target.checked ? "add" : "delete"](name); this.draw(); },
    }), words(name));
    return element("fieldset", { class: "chips" }, element("legend", {}, "Columns, one chart for each unit"), this.tables.columns.filter((name) => name !== "time").map(chip));
  }

  notes() {
    const thinned = this.tables.parts.filter(({ data }) => data.every > 1);
    const texts = thinned.map(({ run, data }) => `Of the ${counted(data.rows)} rows of ${run.name} every ${data.every}th is here.`);
    return element("p", { class: "note" }, ["Drag to zoom, double-click to see all, hover or use the arrow keys to read values.", ...texts].join(" "));
  }

  draw() {
    const { tables } = this;
    this.plots = [];
    const charts = [...tables.byUnit()].map(([unit, columns]) => this.chart(unit, columns));
    this.charts.replaceChildren(...(charts.length ? charts.map(([node]) => node) : [element("p", { class: "plain" }, "Choose a column to see it over the horizontal axis.")]));
    charts.forEach(([, plot, curves]) => plot.show(curves));
  }

  chart(unit, columns) {
    const { tables } = this;
    const curves = tables.curves(columns);
    const title = columns.length === 1 ? axisTitle(columns[0], unit) : `[${unitText(unit) || "–"}]`;
    const xUnit = tables.unit(tables.x);
    const plot = new Plot({
      x: { title: axisTitle(tables.x, xUnit), name: words(tables.x), unit: xUnit, log: this.log.x },
      y: { title, unit, log: this.log.y },
      marks: tables.x === "time" && tables.parts.length === 1 ? marksOf(tables.parts[0].run) : [],
      onzoom: (ends) => this.plots.forEach((other) => other !== plot && other.zoomTo(ends && { x: ends }, false)),
    });
    this.plots.push(plot);
    const isPlain = curves.length < 2;
    return [element("div", {}, isPlain ? null : legend(curves), plot.node), plot, curves];
  }
}

/** Charts of all tables; one table at a time. */
function seriesSection(runs) {
  const names = [...new Set(runs.flatMap((run) => run.tables.map((data) => data.name)))];
  if (!names.length) return null;
  const holder = element("div");
  const show = (name) => {
    const panel = new SeriesPanel(new Tables(name, runs));
    holder.replaceChildren(panel.node);
    panel.draw();
  };
  const first = names.includes("series.csv") ? "series.csv" : names[0];
  const pick = names.length > 1 ? element("div", { class: "controls" }, chooser("Table", names.map((name) => [name, name]), first, show)) : null;
  return { nodes: [pick, holder], start: () => show(first) };
}
