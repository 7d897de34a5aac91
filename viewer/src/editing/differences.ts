// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Trial } from "../decode.ts";
import { nearest } from "../downsample.ts";

/** How a coordinate differs from another solution of the same recording. */
export interface CoordinateChange {
  name: string;
  unit: "deg" | "m";
  /** Largest difference, new minus old, and its time. */
  largest: number;
  time: number;
  /** Points at which both have a value, and those of them at which it differs by more than two standard deviations of the new one. */
  shared: number;
  beyond: number;
  /** Points at which only the new one, or only the old one, has a value. */
  came: number;
  went: number;
}

/** Coordinates of the same names, the one that changed most first, angles before positions; those that did not change are left out. */
export function coordinateChanges(now: Trial, old: Trial): CoordinateChange[] {
  const step = old.time.length > 1 ? old.time[1]! - old.time[0]! : Infinity;
  const at = Int32Array.from(now.time, (t) => {
    const i = nearest(old.time, t);
    return i >= 0 && Math.abs(old.time[i]! - t) <= 0.51 * step ? i : -1;
  });
  const changes = now.summary.coordinates.flatMap((coordinate, j): CoordinateChange[] => {
    const k = old.summary.coordinates.findIndex((c) => c.name === coordinate.name && c.unit === coordinate.unit);
    if (k < 0 || coordinate.locked) return [];
    const { value, sd } = now.coordinates[j]!;
    const before = old.coordinates[k]!.value;
    const change: CoordinateChange = { name: coordinate.name, unit: coordinate.unit, largest: 0, time: NaN, shared: 0, beyond: 0, came: 0, went: 0 };
    value.forEach((v, i) => {
      if (at[i]! < 0) return;
      const d = v - before[at[i]!]!;
      if (Number.isNaN(d)) {
        if (Number.isFinite(v)) ++change.came;
        else if (Number.isFinite(before[at[i]!]!)) ++change.went;
        return;
      }
      ++change.shared;
      if (sd !== null && Math.abs(d) > 2 * sd[i]!) ++change.beyond;
      if (Math.abs(d) > Math.abs(change.largest)) [change.largest, change.time] = [d, now.time[i]!];
    });
    return change.largest === 0 && change.came === 0 && change.went === 0 ? [] : [change];
  });
  const order = (c: CoordinateChange): number => (c.unit === "deg" ? 1e6 : 0) + Math.abs(c.largest);
  return changes.sort((a, b) => order(b) - order(a));
}
