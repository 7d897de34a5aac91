// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { seenBy, type Trial } from "../decode.ts";
import { el, section } from "../dom.ts";
import { GapMap, type MapKind, type MapRow } from "../plots/gap_map.ts";
import { palette } from "../theme.ts";
import type { View } from "../view.ts";

const gapKind: MapKind = {
  group: "gap",
  words: ["measured", "filled in", "missing", "rejected"],
  colours: () => palette().gaps,
};
const statusKind: MapKind = {
  group: "status",
  words: ["converged", "not all coordinates determined", "not converged", "no markers"],
  colours: () => palette().status,
};

export const legend = ({ group, words }: MapKind): HTMLElement =>
  el("ul", { class: "legend" }, ...words.map((w, i) => el("li", { class: `${group}-${i}` }, w)));

/** Markers by time: measured, filled in, missing, rejected. The first strip is how the solver fared. */
export function gaps(trial: Trial, view: View): { node: HTMLElement; start: () => void } {
  const box = el("div", { class: "gap-map", id: "gap-map" });
  const used = trial.markerErrorMm.length;
  const rows: MapRow[] = trial.summary.markers.map((m, i) => ({
    name: m.used ? m.name : `${m.name} (left out)`,
    kind: gapKind,
    codes: trial.gaps[i] ?? null,
    marker: i < used ? i : -1,
    faint: !m.used,
    remark: (point) => {
      const error = trial.markerErrorMm[i]?.[point] ?? NaN;
      return Number.isFinite(error) ? `, error ${error.toFixed(1)} mm` : "";
    },
  }));
  for (const [i, row] of (trial.sensors?.facts.rows ?? []).entries()) {
    rows.push({
      name: row.name,
      kind: gapKind,
      codes: trial.sensors!.gaps[i] ?? null,
      marker: -1,
      remark: (point) => {
        const miss = trial.sensors!.errorDeg[i]?.[point] ?? NaN;
        return Number.isFinite(miss) ? `, ${miss.toFixed(1)} deg off` : "";
      },
    });
  }
  rows.unshift({ name: "Fit", kind: statusKind, codes: trial.status, marker: -1 });
  const of = trial.sensors === null ? "each marker's" : trial.summary.markers.length === 0 ? "each sensor's" : "each marker's and each sensor's";
  const map = new GapMap(box, trial.time, view, rows);
  const thinned = trial.frameStep === 1 ? "" : " A spot that stands for several frames shows the worst of them.";
  const node = section(
    "gaps",
    "Gaps",
    `Where ${of} samples come from. The strip on top is the fit of each frame.${thinned}`,
    el("div", { class: "legends" }, el("span", {}, seenBy(trial) === "sensors" ? "Sensors" : "Markers"), legend(gapKind), el("span", {}, "Fit"), legend(statusKind)),
    map.readout,
    box,
  );
  return { node, start: () => map.draw() };
}
