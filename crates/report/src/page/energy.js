"use strict";

/** Parts of the energy: label, and the columns that are summed. Parts that are of others, such as the kinetic energy along x, are not here. */
const ENERGIES = [
  ["potential", ["potential_energy"]],
  ["kinetic", ["kinetic_energy", "rotational_energy"]],
  ["elastic", ["contact_energy", "elastic_energy"]],
  ["lost by sliding between grains", ["loss_sliding"]],
  ["lost by sliding at walls", ["loss_sliding_at_walls"]],
  ["lost in dashpots", ["loss_normal_damping", "loss_tangential_damping"]],
  ["lost by rolling", ["loss_rolling", "loss_twisting"]],
  ["lost to plastic strain", ["loss_plastic"]],
  ["lost to viscosity", ["loss_viscous"]],
  ["lost in impacts on walls", ["loss_stopping_at_walls"]],
  ["lost to damping", ["loss_local_damping", "loss_pic"]],
];

/** The parts of the energy that a table has, as sums of its columns. */
function energiesOf(data) {
  return ENERGIES.flatMap(([label, names], colour) => {
    const columns = names.map((name) => columnOf(data, name)).filter((values) => values);
    if (!columns.length) return [];
    const values = Float64Array.from(columns[0], (_, row) => columns.reduce((sum, column) => sum + column[row], 0));
    return values.some((value) => value !== 0) ? [{ label, values, colour }] : [];
  });
}

/** Parts on top of one another, or each for itself where one is below zero. */
function energyCurves(time, parts) {
  const isStacked = parts.every((part) => part.values.every((value) => value >= -1e-12 * Math.abs(parts[0].values[0])));
  let base = new Float64Array(time.length);
  return parts.map(({ label, values, colour }) => {
    const curve = { label, x: time, y: values, values, colour, dash: colour >= CURVES.length ? 1 : 0, ordered: true };
    if (!isStacked) return curve;
    const top = base.map((below, row) => below + values[row]);
    Object.assign(curve, { y: top, base, dash: 0 });
    base = top;
    return curve;
  });
}

function energyTable(data, parts) {
  const total = (row) => parts.reduce((sum, part) => sum + part.values[row], 0);
  const last = parts[0].values.length - 1;
  const whole = total(0) || 1;
  const row = (label, first, end) => [label, quantity(first, "J"), quantity(end, "J"), quantity(end - first, "J"), `${shown((100 * (end - first)) / whole, 3)}\u00a0%`];
  const rows = parts.map(({ label, values }) => row(label, values[0], values[last]));
  rows.push(row("sum of these", total(0), total(last)));
  const missing = columnOf(data, "energy_residual");
  if (missing) rows.push(row("missing in the balance of the solver", missing[0], missing[last]));
  return table(["Energy", "At the start", "At the end", "Change", "Of the sum at the start"], rows, [1, 2, 3, 4]);
}

/** Where the energy of each run goes. */
function energySection(runs) {
  const nodes = [];
  const starts = [];
  for (const run of runs) {
    for (const data of run.tables) {
      const [time, parts] = [columnOf(data, "time"), energiesOf(data)];
      if (!time || parts.length < 2) continue;
      const curves = energyCurves(time, parts);
      const plot = new Plot({ x: { title: axisTitle("time", "s"), name: "time", unit: "s" }, y: { title: axisTitle("energy", "J"), unit: "J" }, height: 320, marks: marksOf(run) });
      const several = runs.length > 1 || run.tables.length > 1;
      nodes.push(element("div", {}, several ? element("h3", {}, `${run.name}: ${data.name}`) : null, legend(curves), plot.node, energyTable(data, parts)));
      starts.push(() => plot.show(curves));
    }
  }
  if (!nodes.length) return null;
  const node = element("div", { class: runs.length > 1 ? "columns" : "" }, nodes);
  return { nodes: [node], start: () => starts.forEach((start) => start()) };
}
