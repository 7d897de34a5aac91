// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Scene } from "../src/scene/scene.ts";
import type { Vec } from "../src/scene/vec.ts";

/** A scene from a function of marker and point, at 100 Hz. */
export function sceneWith(names: string[], points: number, place: (m: number, p: number) => Vec, more: Partial<Scene> = {}): Scene {
  const x = new Float32Array(3 * names.length * points);
  for (let m = 0; m < names.length; ++m) for (let p = 0; p < points; ++p) place(m, p).forEach((v, k) => (x[(3 * m + k) * points + p] = v));
  const states = new Uint8Array(names.length * points);
  return {
    points, frameStep: 1, firstFrame: 0, rateHz: 100, time: Float64Array.from({ length: points }, (_, i) => 1 + i / 100), names, isMain: names.map(() => true),
    up: [0, 0, 1], upFrom: "", markers: { x, states }, before: null, model: null, worst: states, plates: [], forces: [], bodies: null, skeleton: null, cameras: [], ...more,
  };
}
