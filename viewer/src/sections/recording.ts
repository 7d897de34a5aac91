// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanDefect, CleanSummary } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, percent } from "../format.ts";
import { sortableTable } from "./table.ts";

/** What the recorder did to the data: made samples, spikes, swaps, stuck values. */
export function recording(summary: CleanSummary, show: (marker: string, time: number, length: number) => void): HTMLElement {
  const { upsampling, defects, defect_count } = summary;
  const names = (d: CleanDefect): string =>
    d.other_marker === "" ? d.marker || "all" : `${d.marker} and ${d.other_marker}`;
  const table =
    defects.length === 0
      ? null
      : sortableTable<CleanDefect>(
          "Defects found",
          [
            { title: "Time", unit: "s", key: (d) => d.first_time_s, cell: (d) => el("button", { type: "button", class: "jump plain" }, number(d.first_time_s, 3)) },
            { title: "Kind", key: (d) => d.kind, cell: (d) => d.kind },
            { title: "Marker", key: names, cell: names },
            { title: "Frames", numeric: true, key: (d) => d.last_frame - d.first_frame + 1, cell: (d) => number(d.last_frame - d.first_frame + 1) },
            { title: "Certain", unit: "%", numeric: true, key: (d) => d.confidence, cell: (d) => percent(d.confidence).replace(" %", "") },
            { title: "What it is", key: (d) => d.sentence, cell: (d) => el("span", { class: "wide" }, d.sentence) },
            { title: "What was done", key: (d) => d.done, cell: (d) => el("span", { class: d.handled ? "" : "remark low" }, d.done) },
          ],
          defects,
          { column: 0, direction: "ascending" },
          (d) => show(d.marker, d.first_time_s, d.last_time_s - d.first_time_s),
        ).node;
  const rest = defect_count - defects.length;
  return section(
    "recording",
    "What the recorder did",
    upsampling.looked ? "" : "Nobody looked for samples that the recorder made.",
    upsampling.sentences.length === 0 ? null : el("ul", { class: "passed" }, ...upsampling.sentences.map((s) => el("li", {}, s))),
    upsampling.done === "" ? null : el("p", { class: "facts" }, "What was done: ", el("b", {}, upsampling.done)),
    table ?? el("p", { class: "facts" }, "No spike, swap, stuck value or other defect was found."),
    rest > 0 ? el("p", { class: "lead" }, `The ${number(defects.length)} longest; ${number(rest)} more are in the JSON file beside the results.`) : null,
  );
}
