// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { FrameStatus, IkSummary, WorstFrame } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, seconds } from "../format.ts";
import type { View } from "../view.ts";
import { sortableTable } from "./table.ts";

const words: Record<FrameStatus, string> = {
  converged: "converged",
  not_converged: "not converged",
  underdetermined: "not all determined",
  no_markers: "no markers",
};

/** The frames that fit worst; choosing one moves all plots there. */
export function worstFrames(summary: IkSummary, view: View): HTMLElement {
  const used = summary.markers.map((m) => m.name);
  const jump = (w: WorstFrame): void => {
    view.set({ marker: used.indexOf(w.worst_marker) });
    view.jumpTo(w.time_s, "markers");
    mark((row) => row === w);
  };
  const { node, mark } = sortableTable<WorstFrame>(
    "Frames with the largest RMS marker error",
    [
      { title: "Time", unit: "s", key: (w) => w.time_s, cell: (w) => el("button", { type: "button", class: "jump plain" }, number(w.time_s, 3)) },
      { title: "Frame", numeric: true, key: (w) => w.frame, cell: (w) => number(w.frame) },
      { title: "RMS error", unit: "mm", numeric: true, key: (w) => w.rms_error_mm, cell: (w) => number(w.rms_error_mm, 1) },
      { title: "Worst marker", key: (w) => w.worst_marker, cell: (w) => w.worst_marker },
      { title: "Its error", unit: "mm", numeric: true, key: (w) => w.worst_marker_error_mm, cell: (w) => number(w.worst_marker_error_mm, 1) },
      { title: "Markers seen", numeric: true, key: (w) => w.markers_seen, cell: (w) => number(w.markers_seen) },
      { title: "Fit", key: (w) => words[w.status], cell: (w) => words[w.status] },
    ],
    summary.worst_frames,
    { column: 2, direction: "descending" },
    jump,
  );
  const from = summary.worst_frames.length === 0 ? "No marker error is known." : `Frames count from ${number(summary.first_frame ?? 0)} at ${seconds(summary.first_time_s)}. Click a row to see it in all plots. Neighbours of a listed frame are left out.`;
  return section("worst", "Worst frames", from, summary.worst_frames.length === 0 ? null : node);
}
