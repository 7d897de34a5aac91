// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el, section } from "../dom.ts";
import { TimePlot } from "../plots/time_plot.ts";
import type { Scene } from "../scene/scene.ts";
import { palette } from "../theme.ts";
import type { View } from "../view.ts";

/** Forces of the plates over time, along the axes of the laboratory; in N, or per kg where somebody gives the mass. */
export function ground(scene: Scene, view: View): { node: HTMLElement; start: () => void } {
  let mass: number | null = null;
  const plots: { plot: TimePlot; fill: () => void }[] = [];
  const input = el("input", { type: "number", id: "body-mass", min: 1, max: 1000, step: 0.1, placeholder: "kg", change: () => {
    const value = Number(input.value);
    mass = value > 0 ? value : null;
    plots.forEach((p) => p.fill());
  } });
  const boxes = scene.forces.map((force) => ({ force, box: el("div", { class: "plot axis" }) }));
  const node = section(
    "ground",
    "Ground reaction",
    "What the plates push with, along the axes of the laboratory.",
    el("div", { class: "controls" }, el("label", { for: "body-mass" }, "Divide by body mass"), input,
      el("span", { class: "keys" }, el("span", { class: "key axis-0" }, "x"), el("span", { class: "key axis-1" }, "y"), el("span", { class: "key axis-2" }, "z"))),
    ...boxes.map(({ force, box }) => el("figure", {}, el("figcaption", {}, force.name), box)),
  );
  const start = (): void => {
    for (const { force, box } of boxes) {
      const plot = new TimePlot(box, view, {
        label: `Force of ${force.name} over time along three axes`,
        height: 200,
        series: [0, 1, 2].map((k) => ({ stroke: () => palette().axes[k as 0], width: 1.6 })),
        unit: () => (mass === null ? "force (N)" : "force (N/kg)"),
        hatched: () => [],
      });
      const fill = (): void => {
        const axis = (k: number): number[] => [...force.force.subarray(k * scene.points, (k + 1) * scene.points)].map((v) => v / (mass ?? 1));
        plot.setData([scene.time, axis(0), axis(1), axis(2)]);
      };
      plots.push({ plot, fill });
      fill();
    }
  };
  return { node, start };
}
