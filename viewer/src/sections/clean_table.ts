// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanMarker, CleanSummary } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, percent } from "../format.ts";
import type { View } from "../view.ts";
import { absent, filledIn, total } from "./clean_header.ts";
import { barCell, nameCell } from "./cells.ts";
import { sortableTable } from "./table.ts";

/** Kalman of order 4, 12.3 Hz: what a filter is called among people. */
export function filterText(m: CleanMarker): string {
  if (m.method === "" || m.method === "none") return "none";
  return m.order > 0 ? `${m.method}, order ${m.order}` : m.method;
}

const share = (m: CleanMarker, count: number): number | null => (total(m.after) === 0 ? null : count / total(m.after));

/** All markers in numbers; a click chooses one. */
export function cleanTable(summary: CleanSummary, view: View): HTMLElement {
  const { markers } = summary;
  const indexOf = new Map(markers.map((m, i) => [m, i]));
  const noisiest = Math.max(1e-9, ...markers.map((m) => m.noise_sd_mm ?? 0));
  const { node, mark } = sortableTable<CleanMarker>(
    "Filter, noise and gaps per marker",
    [
      { title: "Marker", key: (m) => m.name, cell: (m) => nameCell(m.name) },
      { title: "Noise SD", unit: "mm", numeric: true, key: (m) => m.noise_sd_mm, cell: (m) => barCell(m.noise_sd_mm, noisiest, 3) },
      { title: "Filter", key: filterText, cell: (m) => el("span", { class: "nowrap" }, filterText(m)) },
      { title: "Cut-off", unit: "Hz", numeric: true, key: (m) => m.cutoff_hz, cell: (m) => number(m.cutoff_hz, 1) },
      { title: "Residual", unit: "mm", numeric: true, key: (m) => m.residual_rms_mm, cell: (m) => number(m.residual_rms_mm, 3) },
      { title: "Residual is", key: (m) => whiteText(m.white), cell: (m) => whiteCell(m.white) },
      { title: "Filled in", unit: "%", numeric: true, key: (m) => share(m, filledIn(m.after)), cell: (m) => percent(share(m, filledIn(m.after))).replace(" %", "") },
      { title: "Worst SD", unit: "mm", numeric: true, key: (m) => m.largest_fill_sd_mm, cell: (m) => number(m.largest_fill_sd_mm, 1) },
      { title: "Left missing", unit: "%", numeric: true, key: (m) => share(m, absent(m.after)), cell: (m) => percent(share(m, absent(m.after))).replace(" %", "") },
    ],
    markers,
    { column: 0, direction: "ascending" },
    (m) => view.set({ marker: indexOf.get(m)! }),
  );
  const show = (): void => mark((m) => indexOf.get(m) === view.marker);
  view.onChange(show);
  show();
  return section(
    "markers",
    "Markers",
    "Noise SD is the scatter of a sample along one axis as found in the data; the filter's order and cut-off follow from it. Worst SD is that of the least certain filled sample.",
    node,
  );
}

const whiteText = (white: boolean | null): string => (white === null ? "not judged" : white ? "white" : "not white");
const whiteCell = (white: boolean | null): Node => el("span", { class: white === false ? "remark low" : "remark" }, whiteText(white));
