// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { decodeFloats, inflateAll, stepOf, type EncodedCurve } from "./curves.ts";

export type Foot = "Left" | "Right";

/** Cycles of a coordinate and a foot as they stand in the page; src/kinemark/stages/report/README.md describes them. */
export interface EncodedCycles {
  points: number;
  curves: {
    coordinate: string;
    side: Foot;
    count: number;
    whole: number;
    fewest: number;
    most: number;
    drawn: number;
    each: EncodedCurve;
    mean: EncodedCurve;
    sd: EncodedCurve | null;
  }[];
}

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
