// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** Index of the first time that is not before t. */
export function firstAtOrAfter(time: Float64Array, t: number): number {
  let low = 0;
  let high = time.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time[middle]! < t) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Index of the nearest time; -1 without any. */
export function nearest(time: Float64Array, t: number): number {
  const after = firstAtOrAfter(time, t);
  if (after === 0) return time.length === 0 ? -1 : 0;
  if (after === time.length) return time.length - 1;
  return t - time[after - 1]! <= time[after]! - t ? after - 1 : after;
}

/** Points [from, to) that fall into each of `columns` equal parts of points [first, last). Never empty parts. */
export function columnRange(first: number, last: number, columns: number, column: number): [from: number, to: number] {
  const from = first + Math.floor(((last - first) * column) / columns);
  const to = first + Math.floor(((last - first) * (column + 1)) / columns);
  return [from, Math.max(to, from + 1)];
}

/** Smallest and largest value of points [from, to); NaN when there is none. */
export function extremes(values: ArrayLike<number>, from: number, to: number): [low: number, high: number] {
  let low = NaN;
  let high = NaN;
  for (let i = from; i < to; ++i) {
    const v = values[i]!;
    if (!(v >= low)) low = Number.isNaN(v) ? low : v;
    if (!(v <= high)) high = Number.isNaN(v) ? high : v;
  }
  return [low, high];
}

/** Share of points [from, to) whose code is not 0. */
export function shareAbove0(codes: Uint8Array, from: number, to: number): number {
  let count = 0;
  for (let i = from; i < to && i < codes.length; ++i) count += codes[i]! > 0 ? 1 : 0;
  return to > from ? count / (to - from) : 0;
}

/** Largest code of points [from, to). */
export function worstCode(codes: Uint8Array, from: number, to: number): number {
  let worst = 0;
  for (let i = from; i < to && i < codes.length; ++i) worst = Math.max(worst, codes[i]!);
  return worst;
}
