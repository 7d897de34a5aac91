// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { decimalsOfStep } from "../curves.ts";
import { countWords, type Overlay } from "../cycles.ts";
import { el } from "../dom.ts";
import { cyclePlot } from "../plots/cycle_plot.ts";
import { svgFigure } from "../plots/svg_figure.ts";
import { csv, fileName, save } from "../save.ts";

/** The numbers of overlays, a row a per cent: mean, SD and every cycle that is drawn. */
export function cyclesCsv(overlays: readonly Overlay[], unit: string): string {
  const points = overlays[0]?.mean.length ?? 0;
  const text = (v: number | undefined, step: number | null): string =>
    v === undefined || !Number.isFinite(v) ? "" : step === null ? String(Number(v.toPrecision(7))) : String(Number(v.toFixed(decimalsOfStep(step))));
  const heading = ["cycle (%)", ...overlays.flatMap((o) => [`${o.side} mean, ${unit}`, `${o.side} SD between cycles, ${unit}`, ...o.each.map((_, i) => `${o.side} ${i + 1}, ${unit}`)])];
  const rows = Array.from({ length: points }, (_, p) => [
    String(Number(((100 * p) / Math.max(1, points - 1)).toFixed(6))),
    ...overlays.flatMap((o) => [text(o.mean[p], o.step), text(o.sd?.[p], null), ...o.each.map((line) => text(line[p], o.step))]),
  ]);
  return csv([heading, ...rows]);
}

/** A figure of what one name has over the cycles of both feet, with their number below it. */
export function cycleFigure(title: string, overlays: readonly Overlay[], unit: string): HTMLElement {
  const key = (o: Overlay): HTMLElement => el("span", { class: o.side === "Right" ? "key" : "key one" }, countWords(o));
  const numbers = el("button", { type: "button", class: "save", title: "Save the numbers of this figure", click: () =>
    save(fileName(`${document.title.split(" · ")[0] ?? ""}_${title}_cycles`, "csv"), new Blob([cyclesCsv(overlays, unit)], { type: "text/csv" })) }, "CSV");
  const figure = svgFigure(
    title,
    cyclePlot(overlays, `${title} over the cycle: ${overlays.map(countWords).join("; ")}`, unit),
    el("p", { class: "keys" }, ...overlays.map(key), numbers),
  );
  figure.setAttribute("class", "plot drawn cycle-figure");
  return figure;
}
