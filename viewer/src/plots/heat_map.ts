// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PrecisionMap } from "../page_types.ts";
import { number, plural } from "../format.ts";
import { svg } from "../svg.ts";
import { words } from "./forest.ts";
import { decimalsFor, ticks } from "./ticks.ts";

const shades = 6;
const width = 460;
const [left, right, top] = [58, 30, 26];

/** Edges of the shades: so many cells in each as can be, the largest cell inside the last. */
export function edgesOf(values: readonly (number | null)[], count = shades): number[] {
  const known = values.filter((v): v is number => v !== null).sort((a, b) => a - b);
  if (known.length === 0) return [];
  const at = (share: number): number => known[Math.min(known.length - 1, Math.floor(share * known.length))]!;
  return Array.from({ length: count + 1 }, (_, i) => (i === count ? known[known.length - 1]! : at(i / count)));
}

/** A map in shades, and what the shades mean. */
export function heatMap(cells: PrecisionMap, label: string): SVGElement {
  const side = Math.min((width - left - right) / cells.columns, 300 / cells.rows);
  const [plotWidth, plotHeight] = [side * cells.columns, side * cells.rows];
  const bottom = top + plotHeight;
  const edges = edgesOf(cells.sd_mm);
  const shade = (v: number): number => Math.max(0, Math.min(shades - 1, edges.filter((e) => v >= e).length - 1));
  const parts: SVGElement[] = [];
  cells.sd_mm.forEach((value, i) => {
    if (value === null) return;
    const [column, row] = [i % cells.columns, Math.floor(i / cells.columns)];
    const cell = svg("rect", { class: `heat-${shade(value)}`, x: (left + column * side).toFixed(1), y: (bottom - (row + 1) * side).toFixed(1), width: (side + 0.3).toFixed(1), height: (side + 0.3).toFixed(1) });
    cell.append(Object.assign(svg("title", {}), { textContent: `${number(value, 2)} mm, ${plural(cells.samples[i]!, "point")}` }));
    parts.push(cell);
  });
  parts.push(svg("path", { class: "rule", d: `M${left} ${top}V${bottom}H${(left + plotWidth).toFixed(1)}` }));
  const span = (k: 0 | 1): [number, number] => [cells.first_m[k], cells.first_m[k] + cells.cell_m * (k === 0 ? cells.columns : cells.rows)];
  for (const k of [0, 1] as const) {
    const marks = ticks(...span(k), k === 0 ? 5 : 4);
    const decimals = decimalsFor(marks);
    for (const t of marks) {
      const along = ((t - cells.first_m[k]) / cells.cell_m) * side;
      parts.push(k === 0 ? words(left + along, bottom + 16, "middle", number(t, decimals)) : words(left - 6, bottom - along + 4, "end", number(t, decimals)));
    }
  }
  parts.push(words(left + plotWidth / 2, bottom + 34, "middle", `${"xyz"[cells.axes[0]]!} (m)`), words(14, top - 10, "start", `${"xyz"[cells.axes[1]]!} (m)`));
  const decimals = edges.length > 0 && edges[edges.length - 1]! < 1 ? 3 : 2;
  const step = Math.min(70, (width - left - right) / shades);
  edges.slice(0, -1).forEach((edge, i) => {
    parts.push(svg("rect", { class: `heat-${i}`, x: left + i * step, y: bottom + 48, width: step, height: 12 }), words(left + i * step, bottom + 76, i === 0 ? "start" : "middle", number(edge, decimals)));
  });
  if (edges.length > 0) parts.push(words(left + shades * step, bottom + 76, "middle", number(edges[edges.length - 1]!, decimals)));
  return svg("svg", { class: "chart", viewBox: `0 0 ${width} ${(bottom + 84).toFixed(0)}`, role: "img", "aria-label": label }, ...parts);
}
