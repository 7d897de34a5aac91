// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { firstAbsent } from "../states.ts";
import type { Vec } from "./vec.ts";

/** Positions and states of M markers on P points. */
export interface Track {
  /** M x 3 x P, m; absent samples hold the place where the marker was last. */
  x: Float32Array;
  /** M x P: codes of states.ts. */
  states: Uint8Array;
}

/** Position of a marker on a point, whether it is there or was there last. */
export const at = (x: Float32Array, points: number, marker: number, point: number): Vec => {
  const i = 3 * marker * points + point;
  return [x[i]!, x[i + points]!, x[i + 2 * points]!];
};

export const isThere = (track: Track, points: number, marker: number, point: number): boolean =>
  track.states[marker * points + point]! < firstAbsent;

/** True where a marker has coordinates on any point. */
export function isEverThere(track: Track, points: number, marker: number): boolean {
  for (let p = 0; p < points; ++p) if (isThere(track, points, marker, p)) return true;
  return false;
}
