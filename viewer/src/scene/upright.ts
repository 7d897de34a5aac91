// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { isThere, type Track } from "./track.ts";
import type { Vec } from "./vec.ts";

/**
 * The axis along which markers reach farthest in 8 of 10 frames, over 0.8 m and 1.2 times as far as along the
 * others: what stands, stands along it. Null where no axis is sure.
 */
export function upright(track: Track, markers: number, points: number): Vec | null {
  const longest = [0, 0, 0];
  let looked = 0;
  for (let p = 0; p < points; p += Math.max(1, Math.floor(points / 50))) {
    const reach = [0, 1, 2].map((axis) => {
      let low = Infinity;
      let high = -Infinity;
      for (let m = 0; m < markers; ++m) {
        if (!isThere(track, points, m, p)) continue;
        const v = track.x[(3 * m + axis) * points + p]!;
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
      return high - low;
    });
    if (!reach.every((r) => r >= 0)) continue;
    ++looked;
    const most = Math.max(...reach);
    const second = [...reach].sort((a, b) => b - a)[1]!;
    if (most >= 0.8 && most >= 1.2 * second) ++longest[reach.indexOf(most)]!;
  }
  const axis = longest.findIndex((n) => looked > 0 && n >= 0.8 * looked);
  return axis < 0 ? null : ([0, 1, 2].map((k) => (k === axis ? 1 : 0)) as Vec);
}
