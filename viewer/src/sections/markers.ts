// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { MarkerSummary } from "../page_types.ts";
import { withBreaks } from "../band.ts";
import type { Trial } from "../decode.ts";
import { framesOfPair } from "../curves.ts";
import { columnRange, extremes, nearest } from "../downsample.ts";
import { el, section } from "../dom.ts";
import { number, percent, seconds } from "../format.ts";
import { TimePlot } from "../plots/time_plot.ts";
import { pathOf, svg } from "../svg.ts";
import { palette } from "../theme.ts";
import type { View } from "../view.ts";
import { barCell, nameCell } from "./cells.ts";
import { sortableTable } from "./table.ts";

/** How far each measured marker lies from the model's: over time, and in a table. */
export function markers(trial: Trial, view: View): { node: HTMLElement; start: () => void } {
  const { summary } = trial;
  const used = trial.markerErrorMm.length;
  const indexOf = new Map(summary.markers.map((m, i) => [m, i]));
  const largest = Math.max(1e-9, ...summary.markers.map((m) => m.rms_error_mm ?? 0));
  const box = el("div", { class: "plot", id: "error-plot" });
  const readout = el("p", { class: "readout", id: "error-readout" });
  const choose = (m: MarkerSummary): void => {
    const i = indexOf.get(m)!;
    if (i < used) view.set({ marker: i === view.marker ? -1 : i });
  };
  const table = sortableTable<MarkerSummary>(
    "Errors per marker",
    [
      { title: "Marker", key: (m) => m.name, cell: (m) => nameWithRemark(m, indexOf.get(m)! < used) },
      { title: "Seen", unit: "%", numeric: true, key: (m) => m.seen_frames, cell: (m) => percent(summary.frames === 0 ? null : m.seen_frames / summary.frames).replace(" %", "") },
      { title: "RMS error", unit: "mm", numeric: true, key: (m) => m.rms_error_mm, cell: (m) => barCell(m.rms_error_mm, largest) },
      { title: "Largest", unit: "mm", numeric: true, key: (m) => m.max_error_mm, cell: (m) => largestCell(m, indexOf.get(m)!, view) },
      { title: "Noise SD", unit: "mm", numeric: true, key: (m) => m.noise_sd_mm, cell: (m) => number(m.noise_sd_mm, 2) },
      { title: "Weight", numeric: true, key: (m) => m.weight, cell: (m) => weightText(m.weight) },
      { title: "Over time, from 0 to largest", sortable: false, key: () => null, cell: (m) => sparkline(trial.markerErrorMm[indexOf.get(m)!], m) },
    ],
    summary.markers,
    { column: 2, direction: "descending" },
    choose,
  );

  function show(): void {
    const t = view.pointer ?? view.focus;
    const i = t === null ? -1 : nearest(trial.time, t);
    const name = summary.markers[view.marker]?.name;
    const rms = el("span", { class: "key rms" }, "All markers, RMS");
    const one = name === undefined ? null : el("span", { class: "key one" }, name);
    const value = (v: number | undefined): string => (v === undefined || Number.isNaN(v) ? " not seen" : ` ${number(v, 1)} mm`);
    if (i < 0) {
      readout.replaceChildren(rms, "  ", one ?? "Choose a marker in the table to see it beside the others.");
      return;
    }
    readout.replaceChildren(`${seconds(trial.time[i]!)}: `, rms, value(trial.rmsErrorMm[i]), "  ");
    if (one !== null) readout.append(one, value(trial.markerErrorMm[view.marker]?.[i]));
  }

  function start(): void {
    const plot = new TimePlot(box, view, {
      label: "Marker error over time: all markers together and the chosen one",
      height: 220,
      series: [
        { stroke: (dense) => (dense ? palette().dense : palette().line), width: 1.6 },
        { stroke: () => palette().second, width: 1.4 },
      ],
      unit: () => "error (mm)",
      precision: () => ({ step: trial.markerErrorStepMm[Math.max(0, view.marker)] ?? null, framesOfPair: framesOfPair(trial.frameStep) }),
      fromZero: true,
      hatched: () => [],
    });
    let drawn = -2;
    const rms = withBreaks(trial.rmsErrorMm);
    const nothing = rms.map(() => null);
    const update = (): void => {
      if (view.marker !== drawn) {
        drawn = view.marker;
        const series = trial.markerErrorMm[drawn];
        plot.setData([trial.time, rms, series === undefined ? nothing : withBreaks(series)]);
        table.mark((m) => indexOf.get(m) === drawn);
      }
      show();
    };
    view.onChange(update);
    update();
  }

  const node = section(
    "markers",
    "Marker errors",
    "Distance between each measured marker and its place on the model. Noise SD is the estimated scatter of the marker along one axis, soft tissue included; the error bars above rest on it.",
    readout,
    box,
    table.node,
  );
  return { node, start };
}

function nameWithRemark(marker: MarkerSummary, selectable: boolean): Node {
  const remark = marker.used ? null : el("small", { class: "remark low" }, "left out");
  const name = selectable ? nameCell(marker.name) : el("span", { class: "name" }, marker.name);
  return el("span", { title: marker.why_excluded }, name, " ", remark);
}

function largestCell(m: MarkerSummary, marker: number, view: View): Node {
  const time = m.max_error_time_s;
  const text = number(m.max_error_mm, 1);
  if (time === null) return document.createTextNode(text);
  const jump = (event: Event): void => {
    event.stopPropagation();
    view.set({ marker });
    view.jumpTo(time, "markers");
  };
  return el("button", { type: "button", class: "jump plain", title: `Show ${seconds(time)}`, click: jump }, text);
}

const weightText = (weight: number | null): string =>
  weight === null ? "–" : String(Number(weight.toPrecision(4))).replace("-", "−");

/** The largest error of each hundredth of the trial, on the marker's own scale. */
function sparkline(series: Float32Array | undefined, marker: MarkerSummary): Node {
  const columns = Math.min(100, series?.length ?? 0);
  const largest = Math.max(1e-9, marker.max_error_mm ?? 0);
  const points = Array.from({ length: columns }, (_, c): [number, number] | null => {
    const high = extremes(series!, ...columnRange(0, series!.length, columns, c))[1];
    return Number.isNaN(high) ? null : [(100 * (c + 0.5)) / columns, 19 - (18 * high) / largest];
  });
  return svg(
    "svg",
    { class: "spark", viewBox: "0 0 100 20", preserveAspectRatio: "none", role: "img", "aria-label": `Error of ${marker.name} over time` },
    svg("path", { d: pathOf(points) }),
  );
}
