// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { LiveSummary } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number } from "../format.ts";
import type { LiveCurves } from "../live/curves.ts";
import { drawSmallMultiple } from "../plots/small_multiple.ts";

/** All angles over the last seconds, each with its value of now. */
export function liveAngles(coordinates: LiveSummary["coordinates"], curves: LiveCurves): { node: HTMLElement; draw: () => void } {
  const cells = coordinates.map((c) => {
    const canvas = el("canvas", { "aria-hidden": "true" });
    const value = el("span", { class: "range" }, "not yet");
    const sd = el("span", { class: "sd" });
    const remark = el("span", { class: "remark low" });
    const node = el("div", { class: "cell" }, el("span", { class: "name" }, c.name), value, canvas, el("span", { class: "below" }, sd, remark));
    return { ...c, node, canvas, value, sd, remark };
  });
  const filter = el("input", { type: "search", placeholder: "Find a coordinate", "aria-label": "Find a coordinate", input: () => {
    const words = filter.value.toLowerCase().split(/\s+/);
    for (const cell of cells) cell.node.hidden = !words.every((w) => cell.name.toLowerCase().includes(w));
    draw();
  } });

  function draw(): void {
    const range = curves.range();
    if (range === null) return;
    cells.forEach((cell, j) => {
      const width = cell.node.clientWidth - 20;
      if (cell.node.hidden || width < 10) return;
      const series = curves.series[j]!;
      const now = series.value.length - 1;
      const [value, sd] = [series.value[now]!, series.sd![now]!];
      cell.value.textContent = Number.isNaN(value) ? "not yet" : `${number(value, 1)} ${cell.unit}`;
      cell.sd.textContent = Number.isNaN(sd) ? "" : `SD ${number(sd, 2)} ${cell.unit}`;
      cell.remark.textContent = series.undetermined![now] === 1 ? "not determined" : "";
      drawSmallMultiple(cell.canvas, series, curves.time, range, width, 54);
    });
  }

  const node = section(
    "angles",
    "Angles",
    "The last ten seconds with bands of two standard deviations; hatched where the markers do not determine the coordinate.",
    el("div", { class: "controls" }, filter),
    el("div", { class: "grid" }, ...cells.map((c) => c.node)),
  );
  return { node, draw };
}
