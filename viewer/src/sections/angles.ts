// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { band, stretches } from "../band.ts";
import { seenBy, type Trial } from "../decode.ts";
import { framesOfPair } from "../curves.ts";
import { nearest } from "../downsample.ts";
import { el, section } from "../dom.ts";
import { decimalsOf, number, percent, seconds } from "../format.ts";
import { drawSmallMultiple } from "../plots/small_multiple.ts";
import { TimePlot } from "../plots/time_plot.ts";
import { onThemeChange, palette } from "../theme.ts";
import type { View } from "../view.ts";

/** One coordinate large with its band and values under the pointer; all of them small, to choose from. */
export function angles(trial: Trial, view: View): { node: HTMLElement; start: () => void } {
  const { coordinates, frames } = trial.summary;
  const picker = el("select", {
    id: "coordinate",
    change: () => view.set({ coordinate: picker.selectedIndex }),
  });
  picker.append(...coordinates.map((c) => el("option", {}, c.name)));
  const step = (by: number): void =>
    view.set({ coordinate: (view.coordinate + by + coordinates.length) % coordinates.length });
  const readout = el("p", { class: "readout", id: "angle-readout" });
  const facts = el("p", { class: "facts" });
  const box = el("div", { class: "plot", id: "angle-plot" });
  const filter = el("input", { type: "search", placeholder: "Find a coordinate", "aria-label": "Find a coordinate", input: () => applyFilter() });
  const cells = coordinates.map((c, j) => {
    const canvas = el("canvas", { "aria-hidden": "true" });
    const share = frames === 0 ? null : c.determined_frames / frames;
    const remark = c.locked ? "held fixed" : share !== null && share < 1 ? `${percent(share)} determined` : "";
    const node = el(
      "button",
      { type: "button", class: "cell", "aria-pressed": "false", click: () => view.set({ coordinate: j }) },
      el("span", { class: "name" }, c.name),
      el(
        "span",
        { class: "range" },
        `${number(c.min, decimalsOf(c.unit) - 1)} to ${number(c.max, decimalsOf(c.unit) - 1)} ${c.unit}`,
      ),
      canvas,
      el(
        "span",
        { class: "below" },
        el("span", { class: "sd" }, c.median_sd === null ? "" : `SD ${number(c.median_sd, decimalsOf(c.unit))} ${c.unit}`),
        el("span", { class: share !== null && share < 1 ? "remark low" : "remark" }, remark),
        c.at_limit_frames ? el("span", { class: "remark low" }, "at a limit") : null,
      ),
    );
    return { node, canvas, name: c.name.toLowerCase() };
  });
  const grid = el("div", { class: "grid" }, ...cells.map((c) => c.node));

  function applyFilter(): void {
    const words = filter.value.toLowerCase().split(/\s+/);
    for (const cell of cells) cell.node.hidden = !words.every((w) => cell.name.includes(w));
    drawCells();
  }

  function drawCells(): void {
    for (const [j, cell] of cells.entries()) {
      if (cell.node.hidden) continue;
      const width = cell.node.clientWidth - 20;
      if (width > 10) drawSmallMultiple(cell.canvas, trial.coordinates[j]!, trial.time, view.range, width, 54);
    }
  }

  function show(): void {
    const c = coordinates[view.coordinate];
    const series = trial.coordinates[view.coordinate];
    if (c === undefined || series === undefined) return;
    const decimals = decimalsOf(c.unit);
    const i = view.pointer ?? view.focus;
    const at = i === null ? -1 : nearest(trial.time, i);
    if (at < 0) {
      readout.textContent = "Point at the plot to read values; drag to zoom; double-click for the whole trial.";
    } else {
      const value = series.value[at]!;
      const sd = series.sd?.[at] ?? NaN;
      const frame = Math.min(at * trial.frameStep, frames - 1);
      const text = !Number.isFinite(value)
        ? `not determined: the ${seenBy(trial)} do not fix it here`
        : `${number(value, decimals)} ${c.unit}` + (Number.isFinite(sd) ? ` ± ${number(sd, decimals)} ${c.unit} (1 SD)` : c.locked ? " (held fixed)" : " (SD not known)");
      readout.replaceChildren(
        `${seconds(trial.time[at]!)}, frame ${trial.frameStep > 1 ? "≈ " : ""}${number((trial.summary.first_frame ?? 0) + frame)}: `,
        el("b", {}, text),
      );
    }
  }

  function start(): void {
    let drawn = -1;
    let hatched: [number, number][] = [];
    const plot = new TimePlot(box, view, {
      label: "Joint coordinate over time with a band of two standard deviations",
      height: 300,
      series: [
        { stroke: () => "transparent", width: 0, hidden: true },
        { stroke: () => "transparent", width: 0, hidden: true },
        { stroke: (dense) => (dense ? palette().dense : palette().line), width: 1.8 },
      ],
      bands: [{ series: [1, 2], of: 3, fill: () => palette().band }],
      unit: () => (coordinates[view.coordinate]?.unit === "m" ? "position (m)" : "angle (deg)"),
      hatched: () => hatched,
      precision: () => ({ step: trial.coordinates[view.coordinate]?.step ?? null, framesOfPair: framesOfPair(trial.frameStep) }),
      levels: () => coordinates[view.coordinate]?.limits ?? [],
    });
    const choose = (): void => {
      const j = view.coordinate;
      const c = coordinates[j];
      const series = trial.coordinates[j];
      if (j === drawn || c === undefined || series === undefined) return;
      drawn = j;
      picker.selectedIndex = j;
      for (const [k, cell] of cells.entries()) cell.node.setAttribute("aria-pressed", String(k === j));
      const frame = 1 / trial.summary.rate_hz;
      const half = (trial.frameStep * frame) / 2;
      hatched = stretches(series.undetermined).map(([from, to]) => [trial.time[from]! - half, trial.time[to - 1]! + half]);
      const { lower, middle, upper } = band(series);
      plot.setData([trial.time, upper, lower, middle]);
      facts.replaceChildren(
        el("b", {}, c.name),
        c.locked
          ? " is held fixed."
          : `: determined in ${percent(frames === 0 ? null : c.determined_frames / frames)} of the frames, median SD ${number(c.median_sd, decimalsOf(c.unit))} ${c.unit}, ` +
            `from ${number(c.min, decimalsOf(c.unit))} to ${number(c.max, decimalsOf(c.unit))} ${c.unit}.` +
            (c.at_limit_frames ? ` At a limit of its range (dashed) in ${number(c.at_limit_frames)} of ${number(frames)} frames.` : ""),
      );
    };
    let range = view.range;
    view.onChange(() => {
      choose();
      show();
      if (view.range !== range) drawCells();
      range = view.range;
    });
    new ResizeObserver(drawCells).observe(grid);
    onThemeChange(drawCells);
    choose();
    show();
    drawCells();
  }

  const node = section(
    "angles",
    "Joint angles",
    "The line is the estimate, the band is ±2 standard deviations: where the noise is as estimated, about 95 % of the true values lie inside. " +
      `Striped spans are not determined: the ${seenBy(trial)} do not fix the coordinate there, so no value is drawn.`,
    thinned(trial),
    el(
      "div",
      { class: "controls" },
      el("label", { for: "coordinate" }, "Coordinate"),
      el("button", { type: "button", "aria-label": "Coordinate before", click: () => step(-1) }, "‹"),
      picker,
      el("button", { type: "button", "aria-label": "Next coordinate", click: () => step(1) }, "›"),
      readout,
    ),
    box,
    facts,
    el("div", { class: "controls" }, el("h3", {}, "All coordinates"), filter),
    grid,
  );
  return { node, start };
}

function thinned({ frameStep, summary }: Trial): HTMLElement | null {
  if (frameStep === 1) return null;
  return el(
    "p",
    { class: "thinned" },
    `Long recording: the plots keep the smallest and the largest value and the largest SD of every ${number(2 * frameStep)} frames ` +
      `(${number((2 * frameStep) / summary.rate_hz, 3)} s). So do the numbers that are saved from a plot; the files that the program writes hold every frame. Tables come from all frames.`,
  );
}
