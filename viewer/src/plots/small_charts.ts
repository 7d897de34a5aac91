// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Spectrum } from "../page_types.ts";
import { pathOf, svg } from "../svg.ts";

const width = 460;
const height = 230;
const left = 58;
const right = width - 12;
const top = 10;
const bottom = height - 36;

const usable = (v: number | null | undefined): v is number => v !== null && v !== undefined && Number.isFinite(v) && v > 0;

/** Whole powers of ten from the one below `low` to the one above `high`; at least one decade. */
export function decades(low: number, high: number): [from: number, to: number] {
  const from = Math.floor(Math.log10(low) + 1e-9);
  return [from, Math.max(from + 1, Math.ceil(Math.log10(high) - 1e-9))];
}

const superscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** 10 to a whole power, as people write it: 0.1, 1, 10, 10⁻⁴. */
export function powerText(power: number): string {
  if (power >= -1 && power <= 2) return String(10 ** power);
  return `10${power < 0 ? "⁻" : ""}${[...String(Math.abs(power))].map((d) => superscripts[Number(d)]).join("")}`;
}

const frame = (label: string, ...children: (Node | string)[]): SVGElement =>
  svg("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label }, ...children);

const text = (x: number, y: number, anchor: string, words: string): SVGElement =>
  svg("text", { x, y, "text-anchor": anchor }, words);

/** Density of what came in and of what the filter took away, both axes logarithmic; null without numbers. */
export function spectrumChart(spectrum: Spectrum, cutoffHz: number | null, label: string): SVGElement | null {
  const { frequency_hz: hz, raw_mm2_per_hz: raw, residual_mm2_per_hz: residual } = spectrum;
  const frequencies = hz.filter(usable);
  const raws = raw.filter(usable);
  if (frequencies.length < 2 || raws.length === 0) return null;
  const residuals = residual.filter(usable);
  const high = Math.max(...raws, ...residuals);
  // Far below the noise there is nothing to see: what a filter leaves there is arithmetic.
  const low = Math.max(Math.min(...raws, ...residuals), 1e-4 * Math.min(...raws));
  const [y0, y1] = decades(low, high);
  const [x0, x1] = [Math.log10(Math.min(...frequencies)), Math.log10(Math.max(...frequencies))];
  const x = (f: number): number => left + ((Math.log10(f) - x0) / (x1 - x0)) * (right - left);
  const y = (p: number): number => bottom - ((Math.log10(p) - y0) / (y1 - y0)) * (bottom - top);
  const line = (values: (number | null)[], name: string): SVGElement =>
    svg("path", {
      class: name,
      d: pathOf(values.map((v, i) => (usable(v) && v >= 10 ** y0 && usable(hz[i]) ? [x(hz[i]!), y(v)] : null))),
    });
  const parts: SVGElement[] = [];
  const every = Math.ceil((y1 - y0) / 6);
  for (let p = y0; p <= y1; p += every) {
    parts.push(svg("path", { class: "rule", d: `M${left} ${y(10 ** p).toFixed(1)}H${right}` }));
    parts.push(text(left - 6, y(10 ** p) + 4, "end", powerText(p)));
  }
  for (let p = Math.ceil(x0 - 1e-9); p <= x1 + 1e-9; ++p) {
    parts.push(svg("path", { class: "rule", d: `M${x(10 ** p).toFixed(1)} ${top}V${bottom}` }));
    parts.push(text(x(10 ** p), bottom + 15, "middle", powerText(p)));
  }
  if (usable(cutoffHz) && Math.log10(cutoffHz) >= x0 && Math.log10(cutoffHz) <= x1) {
    parts.push(svg("path", { class: "cutoff", d: `M${x(cutoffHz).toFixed(1)} ${top}V${bottom}` }));
  }
  parts.push(text((left + right) / 2, height - 6, "middle", "frequency (Hz)"));
  return frame(label, ...parts, line(raw, "raw"), line(residual, "residual"));
}

/** Largest autocorrelation that white noise of so many samples shows 19 times out of 20. */
export const whiteBound = (samples: number): number => (samples > 0 ? Math.min(1, 1.96 / Math.sqrt(samples)) : 1);

/** Bars for lags 1, 2, ... frames with the bounds of white noise, around what the filter makes of it; null without numbers. */
export function autocorrelationChart(
  values: readonly (number | null)[],
  ifWhite: readonly (number | null)[],
  samples: number,
  label: string,
): SVGElement | null {
  if (values.length === 0) return null;
  const bound = whiteBound(samples);
  const expected = (i: number): number => ifWhite[i] ?? 0;
  const largest = Math.max(...values.map((v, i) => Math.max(Math.abs(v ?? 0), Math.abs(expected(i)) + bound)));
  const reach = [0.1, 0.2, 0.5, 1].find((r) => 1.05 * largest <= r) ?? 1;
  const y = (v: number): number => (top + bottom) / 2 - (Math.max(-1, Math.min(1, v / reach)) * (bottom - top)) / 2;
  const step = (right - left) / values.length;
  const parts: SVGElement[] = [];
  for (const v of [-reach, -reach / 2, 0, reach / 2, reach]) {
    parts.push(svg("path", { class: "rule", d: `M${left} ${y(v).toFixed(1)}H${right}` }));
    parts.push(text(left - 6, y(v) + 4, "end", String(v).replace("-", "−")));
  }
  values.forEach((value, i) => {
    const x = left + (i + 0.5) * step;
    parts.push(text(x, bottom + 15, "middle", String(i + 1)));
    if (value === null) return;
    const [from, to] = value > 0 ? [y(value), y(0)] : [y(0), y(value)];
    parts.push(
      svg("rect", {
        class: Math.abs(value - expected(i)) > bound ? "bar beyond" : "bar",
        x: (x - 0.3 * step).toFixed(1),
        y: from.toFixed(1),
        width: (0.6 * step).toFixed(1),
        height: Math.max(1, to - from).toFixed(1),
      }),
    );
  });
  for (const side of [-bound, bound]) {
    const steps = values.map((_, i) => `M${(left + i * step).toFixed(1)} ${y(expected(i) + side).toFixed(1)}h${step.toFixed(1)}`);
    parts.push(svg("path", { class: "cutoff", d: steps.join("") }));
  }
  parts.push(text((left + right) / 2, height - 6, "middle", "lag (frames)"));
  return frame(label, ...parts);
}
