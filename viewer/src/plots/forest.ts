// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.ts";
import { svg } from "../svg.ts";
import { decimalsFor, ticks } from "./ticks.ts";

/** A number with its interval, one line of a figure. */
export interface Estimate {
  name: string;
  value: number | null;
  /** Ends of the interval; null: not known. */
  low: number | null;
  high: number | null;
  /** Where it was before. */
  before?: number | null;
  /** The data do not determine it: drawn hollow. */
  open?: boolean;
}

export interface ForestOptions {
  /** What a screen reader says. */
  label: string;
  /** Words below the axis, with the unit. */
  axis: string;
  /** A line to compare with. */
  reference?: number;
  /** The axis begins at 0. */
  fromZero?: boolean;
}

const rowHeight = 19;
const width = 720;
const top = 8;
/** Pixels of a letter, on the safe side. */
const letter = 7.2;

/** Estimates below each other, each with its interval. */
export function forest(rows: readonly Estimate[], options: ForestOptions): SVGElement {
  const shown = rows.filter((r) => r.value !== null);
  const longest = Math.max(4, ...shown.map((r) => r.name.length));
  const left = Math.min(290, 16 + letter * longest);
  const right = width - 16;
  const known = shown.flatMap((r) => [r.value, r.low, r.high, r.before ?? null].filter((v): v is number => v !== null && Number.isFinite(v)));
  if (options.reference !== undefined) known.push(options.reference);
  if (options.fromZero) known.push(0);
  let [low, high] = [Math.min(...known), Math.max(...known)];
  if (!(high > low)) [low, high] = [(Number.isFinite(low) ? low : 0) - 1, (Number.isFinite(high) ? high : 0) + 1];
  const margin = 0.04 * (high - low);
  if (!options.fromZero || low < 0) low -= margin;
  high += margin;
  const x = (v: number): number => left + ((v - low) / (high - low)) * (right - left);
  const bottom = top + rowHeight * shown.length;
  const parts: SVGElement[] = [];
  const marks = ticks(low, high);
  const decimals = decimalsFor(marks);
  for (const t of marks) {
    parts.push(svg("path", { class: "rule", d: `M${x(t).toFixed(1)} ${top}V${bottom}` }), words(x(t), bottom + 16, "middle", number(t, decimals)));
  }
  if (options.reference !== undefined) parts.push(svg("path", { class: "cutoff", d: `M${x(options.reference).toFixed(1)} ${top}V${bottom}` }));
  shown.forEach((row, i) => {
    const y = top + (i + 0.5) * rowHeight;
    const name = row.name.length * letter > left - 10 ? `${row.name.slice(0, Math.floor((left - 16) / letter) - 1)}…` : row.name;
    const label = words(left - 8, y + 4, "end", name);
    if (name !== row.name) label.append(Object.assign(svg("title", {}), { textContent: row.name }));
    parts.push(label);
    if (row.low !== null && row.high !== null) {
      parts.push(svg("path", { class: row.open ? "interval open" : "interval", d: `M${x(row.low).toFixed(1)} ${y}H${x(row.high).toFixed(1)}M${x(row.low).toFixed(1)} ${y - 4}v8M${x(row.high).toFixed(1)} ${y - 4}v8` }));
    }
    if (row.before !== undefined && row.before !== null) parts.push(svg("path", { class: "before", d: `M${x(row.before).toFixed(1)} ${y - 5}v10` }));
    parts.push(svg("circle", { class: row.open ? "dot open" : "dot", cx: x(row.value!).toFixed(1), cy: y, r: 4 }));
  });
  parts.push(words((left + right) / 2, bottom + 36, "middle", options.axis));
  return svg("svg", { class: "chart wide-chart", viewBox: `0 0 ${width} ${bottom + 44}`, role: "img", "aria-label": options.label }, ...parts);
}

export function words(x: number, y: number, anchor: "start" | "middle" | "end", text: string): SVGElement {
  const node = svg("text", { x: x.toFixed(1), y: y.toFixed(1), "text-anchor": anchor });
  node.textContent = text;
  return node;
}
