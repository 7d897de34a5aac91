// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CycleSpans } from "../page_types.ts";
import { cutIntoCycles } from "../cycles.ts";
import { el, section } from "../dom.ts";
import { number } from "../format.ts";
import type { Scene } from "../scene/scene.ts";
import { isThere } from "../scene/track.ts";
import type { View } from "../view.ts";
import { cycleFigure } from "./cycles.ts";

const axes = ["x", "y", "z"] as const;

/** x, y and z of the picked marker over the cycles that the recording's events mark. */
export function markerCycles(scene: Scene, view: View, spans: CycleSpans): { node: HTMLElement; start: () => void } {
  const { points, names, markers } = scene;
  const box = el("div", { class: "cycles-of-marker" });
  const step = scene.frameStep / scene.rateHz;
  let drawn = -1;

  function draw(): void {
    const m = view.marker;
    if (m === drawn || m < 0 || m >= names.length) return;
    drawn = m;
    const figures = axes.flatMap((axis, k) => {
      const values = Array.from({ length: points }, (_, p) => (isThere(markers, points, m, p) ? 1e3 * markers.x[(3 * m + k) * points + p]! : NaN));
      const overlays = cutIntoCycles(`${names[m]!} ${axis}`, values, scene.time[0] ?? 0, step, spans);
      return overlays.length === 0 ? [] : [cycleFigure(`${names[m]!} ${axis}`, overlays, "mm")];
    });
    box.replaceChildren(...(figures.length > 0 ? figures : [el("p", { class: "facts" }, `${names[m]!} has no value in any cycle.`)]));
  }

  const thinned = scene.frameStep === 1 ? "" : ` Drawn from every ${number(scene.frameStep)}th frame.`;
  const node = section(
    "cycles",
    "Cycles",
    `The picked marker from foot strike to foot strike, as the recording's events mark them: each cycle, their mean and a band of one SD between cycles.${thinned}`,
    box,
  );
  return {
    node,
    start: () => {
      view.onChange(draw);
      draw();
    },
  };
}
