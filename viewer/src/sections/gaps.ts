// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Trial } from "../decode.ts";
import { el, section } from "../dom.ts";
import { GapMap, gapWords, statusWords } from "../plots/gap_map.ts";
import type { View } from "../view.ts";

/** Markers by time: measured, filled in, missing, rejected. */
export function gaps(trial: Trial, view: View): { node: HTMLElement; start: () => void } {
  const box = el("div", { class: "gap-map", id: "gap-map" });
  const map = new GapMap(box, trial, view);
  const key = (group: string, words: readonly string[]): HTMLElement =>
    el("ul", { class: "legend" }, ...words.map((w, i) => el("li", { class: `${group}-${i}` }, w)));
  const thinned = trial.frameStep === 1 ? "" : " A spot that stands for several frames shows the worst of them.";
  const node = section(
    "gaps",
    "Gaps",
    `Where each marker's samples come from. The strip on top is the fit of each frame.${thinned}`,
    el("div", { class: "legends" }, el("span", {}, "Markers"), key("gap", gapWords), el("span", {}, "Fit"), key("status", statusWords)),
    map.readout,
    box,
  );
  return { node, start: () => map.draw() };
}
