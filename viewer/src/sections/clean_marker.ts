// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { band, partWithCode, stretches, withBreaks, type Line } from "../band.ts";
import type { Axes, CleanTrial, MarkerSeries } from "../clean_decode.ts";
import { framesOfPair } from "../curves.ts";
import { nearest } from "../downsample.ts";
import { el, section } from "../dom.ts";
import { number, seconds } from "../format.ts";
import { TimePlot } from "../plots/time_plot.ts";
import { firstAbsent, stateWords } from "../states.ts";
import { palette } from "../theme.ts";
import type { View } from "../view.ts";
import { charts, gapTable, why } from "./marker_facts.ts";

const axisNames = ["x", "y", "z"] as const;

interface Quantity {
  title: string;
  unit: string;
  decimals: number;
  /** The line with its band, and what stands in the readout. */
  result: (s: MarkerSeries) => Axes;
  sd: (s: MarkerSeries) => Axes;
  read: (s: MarkerSeries) => Axes;
  /** The thin line beneath. */
  raw: (s: MarkerSeries) => Axes;
  held: keyof MarkerSeries["steps"];
}

const nowhere = (): Axes => [null, null, null];
const zeros = (s: MarkerSeries): Axes => s.position.map((axis) => axis?.map((v) => 0 * v) ?? null);

const quantities: readonly Quantity[] = [
  { title: "Position", unit: "mm", decimals: 2, result: (s) => s.position, sd: (s) => s.positionSd, read: (s) => s.position, raw: (s) => s.raw, held: "position" },
  { title: "Taken away", unit: "mm", decimals: 2, result: zeros, sd: (s) => s.positionSd, read: (s) => s.change, raw: (s) => s.change, held: "change" },
  { title: "Velocity", unit: "m/s", decimals: 3, result: (s) => s.velocity, sd: (s) => s.velocitySd, read: (s) => s.velocity, raw: nowhere, held: "velocity" },
  { title: "Acceleration", unit: "m/s²", decimals: 2, result: (s) => s.acceleration, sd: (s) => s.accelerationSd, read: (s) => s.acceleration, raw: nowhere, held: "acceleration" },
];

/** One marker in full: the path with its error bars, what was made, why the filter was chosen, its gaps. */
export function cleanMarker(
  trial: CleanTrial,
  view: View,
  show: (marker: string, time: number, length: number) => void,
): { node: HTMLElement; start: () => void } {
  const { markers } = trial.summary;
  const nothing: Line = Array.from(trial.time, () => null);
  const absentLine = new Float32Array(trial.time.length).fill(NaN);
  let quantity = quantities[0]!;
  const picker = el("select", { id: "marker-name", change: () => view.set({ marker: picker.selectedIndex }) });
  picker.append(...markers.map((m) => el("option", {}, m.name)));
  const step = (by: number): void => view.set({ marker: (Math.max(0, view.marker) + by + markers.length) % markers.length });
  const buttons = quantities.map((q) =>
    el("button", { type: "button", class: "choice", "aria-pressed": String(q === quantity), click: () => choose(q) }, q.title),
  );
  const readout = el("p", { class: "readout", id: "marker-readout" });
  const boxes = axisNames.map((a) => el("div", { class: "plot axis", id: `plot-${a}` }));
  const details = el("div", {});
  const without = el("p", { class: "lead", hidden: true });
  let redraw = (): void => undefined;

  function choose(q: Quantity): void {
    quantity = q;
    buttons.forEach((b, i) => b.setAttribute("aria-pressed", String(quantities[i] === q)));
    redraw();
    read();
  }

  /** Values under the pointer. */
  function read(): void {
    const t = view.pointer ?? view.focus;
    const at = t === null ? -1 : nearest(trial.time, t);
    const code = trial.after[view.marker]?.[at];
    if (code === undefined) {
      readout.textContent = "Point at a plot to read values; drag to zoom; double-click for the whole recording.";
      return;
    }
    const series = trial.marker(view.marker);
    const known = quantity.read(series).some((axis) => Number.isFinite(axis?.[at] ?? NaN));
    const words = axisNames.map((a, k) => {
      const value = quantity.read(series)[k]?.[at] ?? NaN;
      const sd = quantity.sd(series)[k]?.[at] ?? NaN;
      const bar = Number.isFinite(sd) ? ` ± ${number(sd, quantity.decimals)}` : "";
      return `${a} ${number(value, quantity.decimals)}${Number.isFinite(value) ? bar : ""}`;
    });
    const frame = Math.min(at * trial.frameStep, trial.summary.frames - 1);
    readout.replaceChildren(
      `${seconds(trial.time[at]!)}, frame ${trial.frameStep > 1 ? "≈ " : ""}${number((trial.summary.first_frame ?? 0) + frame)}, ${stateWords[code as 0]}: `,
      el("b", {}, known ? `${words.join(", ")} ${quantity.unit}` : code >= firstAbsent ? "no value" : "nothing came in"),
    );
  }

  function start(): void {
    let hatched: [number, number][] = [];
    const made = [1, 2, 3] as const;
    const plots = boxes.map(
      (box, k) =>
        new TimePlot(box, view, {
          label: `${axisNames[k]} of the marker over time with a band of two standard deviations`,
          height: 190,
          series: [
            { stroke: () => "transparent", width: 0, hidden: true },
            { stroke: () => "transparent", width: 0, hidden: true },
            { name: "as it came in", stroke: () => palette().raw, width: 0.8 },
            { name: "result", stroke: (dense) => (dense ? palette().dense : palette().line), width: 1.6 },
            ...made.map((code) => ({ name: `result where ${stateWords[code]}`, stroke: () => palette().states[code], width: 2.6, hidden: true })),
          ],
          bands: [{ series: [1, 2], of: 4, fill: () => palette().band }],
          unit: () => `${axisNames[k]} (${quantity.unit})`,
          hatched: () => hatched,
          precision: () => ({ step: trial.marker(Math.max(0, view.marker)).steps[quantity.held][k] ?? null, framesOfPair: framesOfPair(trial.frameStep) }),
        }),
    );
    let drawn = -1;
    redraw = () => {
      const codes = trial.after[view.marker];
      if (codes === undefined) return;
      const series = trial.marker(view.marker);
      const half = trial.frameStep / trial.summary.rate_hz / 2;
      hatched = stretches(codes, firstAbsent).map(([from, to]) => [trial.time[from]! - half, trial.time[to - 1]! + half]);
      const known = quantity.result(series).some((v) => v !== null);
      without.hidden = known;
      without.textContent = `The result holds no ${quantity.title === "Taken away" ? "position" : quantity.title.toLowerCase()} of this marker.`;
      plots.forEach((plot, k) => {
        const { lower, middle, upper } = band({ value: quantity.result(series)[k] ?? absentLine, sd: quantity.sd(series)[k] ?? null });
        const raw = quantity.raw(series)[k];
        plot.setData([
          trial.time,
          upper,
          lower,
          raw ? withBreaks(raw) : nothing,
          middle,
          ...made.map((code) => (codes.includes(code) ? partWithCode(middle, codes, code) : nothing)),
        ]);
      });
    };
    const update = (): void => {
      const m = markers[view.marker];
      if (m !== undefined && view.marker !== drawn) {
        drawn = view.marker;
        picker.selectedIndex = drawn;
        redraw();
        details.replaceChildren(why(m), charts(m), gapTable(m, trial.summary, (g) => show(g.marker, g.first_time_s, g.length_s)));
      }
      read();
    };
    view.onChange(update);
    update();
  }

  const node = section(
    "marker",
    "One marker",
    "The line is the result, the band is ±2 standard deviations of it, the thin grey line is what came in. Coloured spans were made, not measured; striped ones hold no value. “Taken away” shows what came in less the result: noise, if the filter is right.",
    thinned(trial),
    el(
      "div",
      { class: "controls" },
      el("label", { for: "marker-name" }, "Marker"),
      el("button", { type: "button", "aria-label": "Marker before", click: () => step(-1) }, "‹"),
      picker,
      el("button", { type: "button", "aria-label": "Next marker", click: () => step(1) }, "›"),
      ...buttons,
    ),
    el(
      "p",
      { class: "keys" },
      el("span", { class: "key" }, "result"),
      el("span", { class: "key raw" }, "came in"),
      ...[1, 2, 3].map((code) => el("span", { class: `key made-${code}` }, stateWords[code as 1])),
    ),
    readout,
    without,
    ...boxes,
    details,
  );
  return { node, start: markers.length === 0 ? () => undefined : start };
}

function thinned({ frameStep, summary }: CleanTrial): HTMLElement | null {
  if (frameStep === 1) return null;
  return el(
    "p",
    { class: "thinned" },
    `Long recording: the plots keep the smallest and the largest value and the largest SD of every ${number(2 * frameStep)} frames ` +
      `(${number((2 * frameStep) / summary.rate_hz, 3)} s). So do the numbers that are saved from a plot; the files that the program writes hold every frame. Tables come from all frames.`,
  );
}
