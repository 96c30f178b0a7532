"use strict";

/** Draws the page: each section as soon as it comes near to the screen. */
function main() {
  const page = JSON.parse(document.getElementById("data").textContent);
  const runs = page.runs.map((run, index) => ({ ...run, index }));
  document.getElementById("heading").textContent = page.heading;
  document.getElementById("badges").append(...runs.map((run) => badge(run, runs.length > 1)));
  document.getElementById("footer").textContent = `${page.program}. This file needs no network and no other file.`;
  const animation = animationSection(runs);
  const sections = [
    ["Summary", summarySection(runs)],
    ["Animation", animation],
    ["Series", seriesSection(runs)],
    ["Figures", figuresSection(runs)],
    ["Energy", energySection(runs)],
    ["Limits", limitsSection(runs)],
    ["Stages", stagesSection(runs)],
    ["Scene", sceneSection(runs)],
    ["Performance", performanceSection(runs)],
    ["Provenance", provenanceSection(runs, page)],
  ];
  sections.filter(([, made]) => made).forEach(([title, made]) => place(title, made));
  window.granularReport = { page, player: animation && animation.player };
  document.documentElement.dataset.ready = "yes";
}

/** Adds a section and its link. */
function place(title, made) {
  const id = title.toLowerCase();
  const { nodes, start } = Array.isArray(made) ? { nodes: made, start: null } : made;
  const section = element("section", { id, "aria-labelledby": `${id}-title` }, element("h2", { id: `${id}-title` }, title), nodes);
  document.getElementById("main").append(section);
  document.querySelector("#contents .inner").append(element("a", { href: `#${id}` }, title));
  if (start) start();
}

main();
