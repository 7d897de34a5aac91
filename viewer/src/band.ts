// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CoordinateSeries } from "./decode.ts";

/** A line with breaks, as uPlot wants it: null where there is nothing to draw. */
export type Line = (number | null)[];

export const withBreaks = (values: Float32Array): Line => Array.from(values, (v) => (Number.isFinite(v) ? v : null));

export interface Band {
  middle: Line;
  lower: Line;
  upper: Line;
}

/** value -+ width * SD. Without a value or an SD there is no band. */
export function band({ value, sd }: Pick<CoordinateSeries, "value" | "sd">, width = 2): Band {
  const edge = (sign: number): Line =>
    Array.from(value, (v, i) => {
      const e = v + sign * width * (sd?.[i] ?? NaN);
      return Number.isFinite(e) ? e : null;
    });
  return { middle: withBreaks(value), lower: edge(-1), upper: edge(1) };
}

/**
 * The part of a line whose code is `code`, with one neighbour on either side so that it joins the rest; null
 * elsewhere. Drawn over the whole line in another colour, it shows which samples were made, and how.
 */
export function partWithCode(line: Line, codes: Uint8Array, code: number): Line {
  return line.map((v, i) => (codes[i] === code || codes[i - 1] === code || codes[i + 1] === code ? v : null));
}

/** Stretches [from, to) of points whose code is at least `threshold`. */
export function stretches(codes: Uint8Array | null, threshold = 1): [from: number, to: number][] {
  const out: [number, number][] = [];
  for (let i = 0; codes !== null && i < codes.length; ++i) {
    if (codes[i]! < threshold) continue;
    const from = i;
    while (i < codes.length && codes[i]! >= threshold) ++i;
    out.push([from, i]);
  }
  return out;
}
