// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanTrial } from "../clean_decode.ts";
import { el, section } from "../dom.ts";
import { GapMap, type MapRow } from "../plots/gap_map.ts";
import { stateKind } from "../states.ts";
import type { View } from "../view.ts";
import { legend } from "./gaps.ts";

/** Markers by time, as they came in and as they are now. */
export function cleanGaps(trial: CleanTrial, view: View): { node: HTMLElement; start: () => void } {
  const box = el("div", { class: "gap-map", id: "gap-map" });
  const rows = (codes: readonly Uint8Array[]): MapRow[] =>
    trial.summary.markers.map((m, i) => ({ name: m.name, kind: stateKind, codes: codes[i] ?? null, marker: i }));
  const sides = { before: rows(trial.before), after: rows(trial.after) };
  const map = new GapMap(box, trial.time, view, sides.after);
  const buttons = (["before", "after"] as const).map((side) =>
    el(
      "button",
      { type: "button", class: "choice", "aria-pressed": String(side === "after"), click: () => choose(side) },
      side === "before" ? "As it came in" : "After cleaning",
    ),
  );
  function choose(side: "before" | "after"): void {
    map.setRows(sides[side]);
    buttons.forEach((b, i) => b.setAttribute("aria-pressed", String((side === "after") === (i === 1))));
  }
  const thinned = trial.frameStep === 1 ? "" : " A spot that stands for several frames shows the worst of them.";
  const node = section(
    "gaps",
    "Gaps",
    `Where each marker's samples come from. Click a marker to see it below.${thinned}`,
    el("div", { class: "controls" }, ...buttons),
    legend(stateKind),
    map.readout,
    box,
  );
  return { node, start: () => map.draw() };
}
