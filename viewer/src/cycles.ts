// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CycleSpan, EncodedCycles, Foot } from "./page_types.ts";
import { decodeFloats, inflateAll, stepOf } from "./curves.ts";

/** Cycles of a coordinate and a foot, deg or m; NaN where there is no value. */
export interface Overlay {
  coordinate: string;
  side: Foot;
  /** Cycles of which the mean is. */
  count: number;
  /** Those that have a value everywhere. */
  whole: number;
  /** Cycles that have a value: at the per cent where the fewest have one, and where the most have. */
  fewest: number;
  most: number;
  /** As many lines as are drawn. */
  each: Float32Array[];
  mean: Float32Array;
  /** Between cycles; null: fewer than two have a value anywhere. */
  sd: Float32Array | null;
  /** What the mean is rounded to; null: it is not. */
  step: number | null;
}

export async function decodeCycles(encoded: EncodedCycles): Promise<Overlay[]> {
  await inflateAll(encoded);
  const { points } = encoded;
  return encoded.curves.map((c) => {
    const all = decodeFloats(c.each, c.drawn * points);
    return {
      coordinate: c.coordinate,
      side: c.side,
      count: c.count,
      whole: c.whole,
      fewest: c.fewest,
      most: c.most,
      each: Array.from({ length: c.drawn }, (_, i) => all.subarray(i * points, (i + 1) * points)),
      mean: decodeFloats(c.mean, points),
      sd: c.sd === null ? null : decodeFloats(c.sd, points),
      step: stepOf(c.mean),
    };
  });
}

const perCycle = 101;
const mostDrawn = 20;

/** A curve over a cycle, linear between samples; NaN where a neighbour is missing. */
function resampled(values: ArrayLike<number>, firstTime: number, step: number, [start, end]: readonly [number, number]): Float32Array {
  return Float32Array.from({ length: perCycle }, (_, p) => {
    const at = (start + (p / (perCycle - 1)) * (end - start) - firstTime) / step;
    const before = Math.floor(at + 1e-6);
    const share = Math.max(0, at - before);
    if (share < 1e-6) return values[before] ?? NaN;
    return (1 - share) * (values[before] ?? NaN) + share * (values[before + 1] ?? NaN);
  });
}

/** Evenly chosen, the first and the last among them. */
const chosen = <T>(all: readonly T[]): T[] =>
  all.length <= mostDrawn ? [...all] : Array.from({ length: mostDrawn }, (_, i) => all[Math.round((i * (all.length - 1)) / (mostDrawn - 1))]!);

/**
 * A curve of evenly spaced points over the cycles of each foot, their mean and the SD between them.
 * @param values  NaN where there is none
 */
export function cutIntoCycles(coordinate: string, values: ArrayLike<number>, firstTime: number, step: number, spans: Record<Foot, readonly Readonly<CycleSpan>[]>): Overlay[] {
  return (["Left", "Right"] as const).flatMap((side): Overlay[] => {
    const all = spans[side].map((span) => resampled(values, firstTime, step, span));
    const present = Array.from({ length: perCycle }, (_, p) => all.map((line) => line[p]!).filter(Number.isFinite));
    const counts = present.map((v) => v.length);
    if (Math.max(0, ...counts) === 0) return [];
    const mean = Float32Array.from(present, (v) => (v.length === 0 ? NaN : v.reduce((a, b) => a + b, 0) / v.length));
    const sd = Float32Array.from(present, (v, p) => (v.length < 2 ? NaN : Math.sqrt(v.reduce((sum, x) => sum + (x - mean[p]!) ** 2, 0) / (v.length - 1))));
    return [{
      coordinate, side, count: all.length, whole: all.filter((line) => line.every(Number.isFinite)).length,
      fewest: Math.min(...counts), most: Math.max(...counts), each: chosen(all), mean, sd: sd.some(Number.isFinite) ? sd : null, step: null,
    }];
  });
}

const cyclesOf = (n: number): string => `${n} ${n === 1 ? "cycle" : "cycles"}`;

/** How many cycles an overlay stands for, and what of them is missing. */
export function countWords({ side, count, whole, fewest, most, each }: Overlay): string {
  const lacking = count - whole;
  const parts = [
    `${side.toLowerCase()}: ${cyclesOf(count)}`,
    ...(each.length < count ? [`${each.length} of them drawn`] : []),
    ...(lacking > 0 ? [`${cyclesOf(lacking)} with missing values, so that the mean is of ${fewest === most ? fewest : `${fewest} to ${most}`}`] : []),
  ];
  return parts.join(", ");
}
