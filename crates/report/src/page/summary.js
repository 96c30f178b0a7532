"use strict";

const ENDS = { done: ["good", "finished"], running: ["warn", "running, or killed while it ran"], interrupted: ["warn", "interrupted; it can be resumed"], failed: ["bad", "stopped"] };

/** How a run ended, as a badge. */
function badge(run, withName) {
  const [look, text] = ENDS[run.facts.exit] || ["warn", run.facts.exit];
  return element("span", { class: `badge ${look}` }, withName ? `${run.name}: ${text}` : text);
}

const METHODS = { dem: "grains (discrete element method)", lbm: "fluid (lattice Boltzmann method)", mpm: "material points (material point method)" };

function methods(run) {
  const solvers = Object.entries(run.facts.solvers || {});
  if (!solvers.length) return METHODS[run.facts.solver] || run.facts.solver || "–";
  return solvers.map(([name, solver]) => `${name}: ${METHODS[solver] || solver}`).join("; ");
}

/** How much a run works on: as it says itself, or as its frames show. */
function sizes(run) {
  const told = Object.entries(run.facts.sizes || {}).map(([name, { count, item }]) => `${counted(count)} ${item}s in ${name}`);
  if (told.length) return told.join("; ");
  const seen = run.movies.filter((movie) => !movie.plane || movie.plane.normal === 2).map((movie) => {
    if (movie.plane) return `${movie.plane.cells.join(" × ")} cells shown of ${movie.name}`;
    const [first, last] = [movie.counts[0], movie.counts[movie.counts.length - 1]];
    return `${counted(first)}${first === last ? "" : ` to ${counted(last)}`} points in ${movie.name}`;
  });
  return seen.join("; ") || "not told by the folder";
}

/** How and why a run ended. */
function ending(run) {
  const parts = [badge(run, false)];
  if (run.facts.reason) parts.push(element("p", {}, run.facts.reason));
  const last = (run.facts.stages || []).at(-1);
  if (last && last.ended) parts.push(element("p", { class: "plain" }, `The last stage, ${last.name}, ended by: ${last.ended}.`));
  return element("div", {}, parts);
}

function summaryTable(runs) {
  const row = (title, of) => [title, ...runs.map(of)];
  const rows = [
    row("Title", (run) => run.title),
    row("Outcome", ending),
    row("Method", methods),
    row("Size", sizes),
    row("Simulated time", (run) => quantity(run.facts.simulated_seconds, "s", 6)),
    row("Steps", (run) => counted(run.facts.steps)),
    row("Wall time", (run) => duration(run.facts.wall_seconds)),
  ];
  return table(runs.length > 1 ? ["", ...runs.map((run) => run.name)] : null, rows);
}

function metricsTable(runs) {
  const names = [...new Set(runs.flatMap((run) => Object.keys(run.facts.metrics || {})))];
  if (!names.length) return null;
  const unit = (name) => unitText(runs.map((run) => (run.facts.units || {})[name]).find((text) => text)) || "–";
  const rows = names.map((name) => [words(name), ...runs.map((run) => shown((run.facts.metrics || {})[name], 5)), unit(name)]);
  const numbers = runs.map((_, k) => k + 1);
  return table(["Result", ...(runs.length > 1 ? runs.map((run) => run.name) : ["Value"]), "Unit"], rows, numbers);
}

function lacksList(runs) {
  const said = runs.flatMap((run) => run.lacks.map((text) => (runs.length > 1 ? `${run.name}: ${text}` : text)));
  if (!said.length) return null;
  return element("div", {}, element("h3", {}, "What is not on this page"), element("ul", { class: "lacks" }, said.map((text) => element("li", {}, sentence(text)))));
}

function summarySection(runs) {
  const results = metricsTable(runs);
  const parts = [element("div", {}, summaryTable(runs)), results && element("div", {}, element("h3", {}, "Results at the end"), results)];
  return [element("div", { class: runs.length > 1 ? "" : "columns" }, parts), lacksList(runs)];
}

/** Stages as bars as long as they took, and as a table. */
function stagesOf(run) {
  const stages = run.facts.stages || [];
  const end = (stage) => (stage.end === undefined ? run.facts.simulated_seconds : stage.end);
  const whole = stages.reduce((sum, stage) => sum + Math.max(end(stage) - stage.start, 0), 0) || 1;
  const bars = stages.map((stage) => {
    const bar = element("span", { title: `${stage.name}: ${quantity(stage.start, "s")} to ${quantity(end(stage), "s")}` }, stage.name);
    bar.style.flexGrow = String((1000 * Math.max(end(stage) - stage.start, 0)) / whole);
    return bar;
  });
  const rows = stages.map((stage) => [stage.name, quantity(stage.start, "s", 5), stage.end === undefined ? "not over" : quantity(stage.end, "s", 5),
    quantity(end(stage) - stage.start, "s", 5), quantity(stage.dt, "s", 5), stage.ended || "–"]);
  return [element("div", { class: "stages" }, bars), table(["Stage", "Start", "End", "Duration", "Step", "Ended by"], rows, [1, 2, 3, 4])];
}

function stagesSection(runs) {
  const withStages = runs.filter((run) => (run.facts.stages || []).length);
  if (!withStages.length) return null;
  return withStages.map((run) => element("div", {}, runs.length > 1 ? element("h3", {}, run.name) : null, stagesOf(run)));
}

/** Limits with a bar: how much of each is used. */
function limitsOf(run) {
  const rows = run.limits.map((limit) => {
    const share = Math.max(0, Math.min(1, limit.value / limit.bound)) || 0;
    const fill = element("i");
    fill.style.width = `${100 * share}%`;
    const name = element("span", {}, limit.name, limit.binds ? element("span", { class: "tag" }, "binds") : null);
    const bar = element("div", { class: limit.binds ? "bar binds" : "bar", role: "img", "aria-label": `${Math.round(100 * share)} percent of the limit` }, fill);
    return [name, quantity(limit.value, limit.unit, 5), quantity(limit.bound, limit.unit, 5), bar, limit.why || ""];
  });
  const binding = run.limits.filter((limit) => limit.binds).map((limit) => limit.name);
  const said = binding.length ? `The limit that binds: ${binding.join(", ")}.` : "No limit binds: the step was chosen below all of them.";
  return [element("p", {}, said), table(["Limit", "Taken", "Allowed", "Used", "Why"], rows, [1, 2])];
}

function limitsSection(runs) {
  const told = runs.filter((run) => run.limits);
  if (!told.length) return null;
  return told.map((run) => element("div", {}, runs.length > 1 ? element("h3", {}, run.name) : null, limitsOf(run)));
}

function performanceSection(runs) {
  const row = (title, of) => [title, ...runs.map((run) => of(run.facts, run.facts.built || {}))];
  const rows = [
    row("Wall time", (facts) => duration(facts.wall_seconds)),
    row("Rate", (facts) => (facts.rate ? `${shown(facts.rate, 3)} ${facts.item || "item"}-steps per second` : "–")),
    row("Wall time of a simulated second", (facts) => duration(facts.wall_seconds / facts.simulated_seconds)),
    row("Wall time of a step", (facts) => quantity((1e3 * facts.wall_seconds) / facts.steps, "ms", 3)),
    row("Threads", (_, built) => (built.threads ? `${built.threads} of ${built.cores} cores` : "–")),
    row("Processor", (_, built) => built.cpu || "–"),
  ];
  return [table(runs.length > 1 ? ["", ...runs.map((run) => run.name)] : null, rows),
    element("p", { class: "note" }, "Wall time and rate are of the last session, where a run was resumed.")];
}

function provenanceSection(runs, page) {
  const code = (text) => (text ? element("code", {}, text) : "–");
  const row = (title, of) => [title, ...runs.map((run) => of(run, run.facts.built || {}))];
  const rows = [
    row("Folder", (run) => code(run.folder)),
    row("Program", (run, built) => `${run.facts.program || "granular"} ${built.version || "–"}`),
    row("Commit", (_, built) => code(built.commit)),
    row("Methods in the program", (_, built) => (built.methods || []).join(", ") || "–"),
    row("Target", (_, built) => built.target || "–"),
    row("Hash of the last state", (run) => code(run.facts.state_hash)),
  ];
  const files = runs.filter((run) => run.facts.checksums).map((run) => {
    const sums = Object.entries(run.facts.checksums);
    const list = table(["File", "XXH3 (64 bits)"], sums.map(([name, sum]) => [name, code(sum)]));
    return element("details", {}, element("summary", {}, `${runs.length > 1 ? `${run.name}: ` : ""}checksums of ${sums.length} files`), list);
  });
  return [table(runs.length > 1 ? ["", ...runs.map((run) => run.name)] : null, rows), files,
    element("p", { class: "note" }, `Made by ${page.program} from the files of the run ${runs.length > 1 ? "folders" : "folder"}; nothing was computed anew.`)];
}

function figuresSection(runs) {
  const figures = runs.flatMap((run) => run.figures.map((figure) => element("figure", {},
    element("img", { src: addressOf(figure.kind, figure.array), alt: `Figure ${words(figure.name)} of ${run.name}`, loading: "lazy" }),
    element("figcaption", {}, runs.length > 1 ? `${run.name}: ${words(figure.name)}` : words(figure.name)))));
  return figures.length ? [element("div", { class: "figures" }, figures)] : null;
}
