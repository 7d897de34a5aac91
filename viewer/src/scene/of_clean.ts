// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Axes, CleanTrial } from "../clean_decode.ts";
import { firstAbsent } from "../states.ts";
import { areComputed, type Scene } from "./scene.ts";
import { isEverThere, type Track } from "./track.ts";
import { upright } from "./upright.ts";

/**
 * The space view of a cleaned recording, from the curves of its page. Null where the page is thinned: its points
 * then hold extremes of each axis, which were never together.
 */
export function sceneOfClean(trial: CleanTrial): Scene | null {
  const { summary, time } = trial;
  const points = time.length;
  const M = summary.markers.length;
  if (trial.frameStep !== 1 || M === 0 || points === 0) return null;
  const markers: Track = { x: new Float32Array(3 * M * points), states: new Uint8Array(M * points) };
  const before: Track = { x: new Float32Array(3 * M * points), states: new Uint8Array(M * points) };
  for (let m = 0; m < M; ++m) {
    const series = trial.marker(m);
    put(markers, m, points, series.position, trial.after[m]!);
    put(before, m, points, series.raw, trial.before[m]!);
  }
  const up = upright(markers, M, points);
  const names = summary.markers.map((m) => m.name);
  const computed = areComputed(names);
  return {
    points,
    frameStep: 1,
    firstFrame: summary.first_frame ?? 0,
    rateHz: summary.rate_hz,
    time,
    names,
    isMain: names.map((_, m) => !computed[m] && isEverThere(markers, points, m)),
    up: up ?? [0, 0, 1],
    upFrom: up === null ? "" : "the shape of what the markers outline",
    markers,
    before,
    model: null,
    worst: markers.states,
    plates: [],
    forces: [],
    bodies: null,
    skeleton: null,
    cameras: [],
  };
}

/** Millimetres of a page into metres; what is absent holds the place where it was last. */
function put(track: Track, marker: number, points: number, axes: Axes, codes: Uint8Array): void {
  const has = (p: number): boolean => axes.every((a) => Number.isFinite(a?.[p] ?? NaN));
  const first = Array.from({ length: points }, (_, p) => p).find(has) ?? -1;
  let last = first;
  for (let p = 0; p < points; ++p) {
    if (has(p)) last = p;
    const code = codes[p]!;
    track.states[marker * points + p] = has(p) ? Math.min(code, firstAbsent - 1) : Math.max(code, firstAbsent);
    for (const k of [0, 1, 2] as const) track.x[(3 * marker + k) * points + p] = last < 0 ? 0 : (axes[k]?.[last] ?? 0) / 1000;
  }
}
