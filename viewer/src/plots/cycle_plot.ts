// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Overlay } from "../cycles.ts";
import { number } from "../format.ts";
import { pathOf, svg } from "../svg.ts";
import { words } from "./forest.ts";
import { decimalsFor, ticks } from "./ticks.ts";
import { yRange } from "./time_plot.ts";

const [width, height] = [560, 300];
const [left, right, top, bottom] = [92, 26, 12, 50];

/** Cycles over each other from 0 to 100 %: each a thin line, their mean a thick one within a band of one SD. */
export function cyclePlot(overlays: readonly Overlay[], label: string, unit: string): SVGElement {
  const ends = overlays.flatMap((o) => [...o.each.flatMap((line) => [...line]), ...[...o.mean].flatMap((m, p) => [m - (o.sd?.[p] ?? 0), m + (o.sd?.[p] ?? 0)])]).filter(Number.isFinite);
  const [low, high] = yRange(ends.length === 0 ? null : Math.min(...ends), ends.length === 0 ? null : Math.max(...ends), false);
  const y = (value: number): number => top + ((high - value) / (high - low)) * (height - top - bottom);
  const at = (points: number, p: number): number => left + (p / Math.max(1, points - 1)) * (width - left - right);
  const line = (values: ArrayLike<number>): string =>
    pathOf(Array.from(values, (v, p): [number, number] | null => (Number.isFinite(v) ? [at(values.length, p), y(v)] : null)));
  const parts: SVGElement[] = [];
  const upwards = ticks(low, high, 7);
  const decimals = decimalsFor(upwards);
  for (const t of upwards) parts.push(svg("path", { class: "rule", d: `M${left} ${y(t).toFixed(1)}H${width - right}` }), words(left - 8, y(t) + 4, "end", number(t, decimals)));
  for (const t of [0, 20, 40, 60, 80, 100]) parts.push(svg("path", { class: "rule", d: `M${at(101, t).toFixed(1)} ${height - bottom}v5` }), words(at(101, t), height - bottom + 19, "middle", String(t)));
  for (const o of overlays) parts.push(...bands(o, (p) => at(o.mean.length, p), y));
  for (const o of overlays) for (const one of o.each) parts.push(svg("path", { class: `cycle ${o.side.toLowerCase()}`, d: line(one) }));
  for (const o of overlays) parts.push(svg("path", { class: `cycle-mean ${o.side.toLowerCase()}`, d: line(o.mean) }));
  parts.push(
    words((left + width - right) / 2, height - 8, "middle", "cycle, from foot strike to foot strike (%)"),
    svg("text", { transform: `translate(16 ${(top + height - bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, unit),
  );
  return svg("svg", { class: "chart wide-chart cycles", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label }, ...parts);
}

/** The band of one SD, in as many pieces as it has. */
function bands(o: Overlay, x: (p: number) => number, y: (v: number) => number): SVGElement[] {
  const { mean, sd, side } = o;
  if (sd === null) return [];
  const out: SVGElement[] = [];
  for (let p = 0; p < mean.length; ++p) {
    const from = p;
    while (p < mean.length && Number.isFinite(mean[p]! + sd[p]!)) ++p;
    if (p - from < 2) continue;
    const edge = (sign: number): string[] => Array.from({ length: p - from }, (_, i) => `${x(from + i).toFixed(1)} ${y(mean[from + i]! + sign * sd[from + i]!).toFixed(1)}`);
    out.push(svg("path", { class: `cycle-band ${side.toLowerCase()}`, d: `M${edge(1).join("L")}L${edge(-1).reverse().join("L")}Z` }));
  }
  return out;
}
