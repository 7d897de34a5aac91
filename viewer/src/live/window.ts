// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { LiveSummary } from "../page_types.ts";
import { areComputed, type Scene } from "../scene/scene.ts";
import { firstAbsent } from "../states.ts";
import type { MarkersMessage } from "./message.ts";

const seconds = 4;
const pointsPerSecond = 60;
const missing = 4;

/** The last seconds of a source as a scene whose last point is always the newest frame. */
export class LiveWindow {
  readonly scene: Scene;
  /** M: seen at least once. */
  readonly seen: boolean[];
  #cell = -1;
  /** P: a frame came for it. */
  readonly #came: Uint8Array;

  constructor(summary: LiveSummary) {
    const { markers: names, rate_hz } = summary;
    const frameStep = Math.max(1, Math.round(rate_hz / pointsPerSecond));
    const points = Math.max(2, Math.round((seconds * rate_hz) / frameStep));
    const states = new Uint8Array(names.length * points).fill(missing);
    this.seen = names.map(() => false);
    this.#came = new Uint8Array(points);
    this.scene = {
      points, frameStep, firstFrame: 0, rateHz: rate_hz, names, up: summary.up, upFrom: summary.up_from, isMain: areComputed(names).map((c) => !c),
      time: new Float64Array(points), markers: { x: new Float32Array(3 * names.length * points), states }, worst: states,
      before: null, model: null, plates: [], forces: [], bodies: null, skeleton: null, cameras: [], changes: true, ...(summary.extent_m === null ? {} : { extent: summary.extent_m }),
    };
  }

  /** A newer frame. */
  push(message: MarkersMessage): void {
    const { scene } = this;
    const { points: P, frameStep, markers } = scene;
    const cell = Math.floor(message.frame / frameStep);
    // Frames before the newest are not shown.
    if (cell < this.#cell) return;
    const by = this.#cell < 0 ? P : Math.min(P, cell - this.#cell);
    if (by > 0) this.#shift(by);
    this.#cell = cell;
    this.#came[P - 1] = 1;
    scene.firstFrame = message.frame - (P - 1) * frameStep;
    for (let p = 0; p < P; ++p) scene.time[p] = message.time_s - ((P - 1 - p) * frameStep) / scene.rateHz;
    for (let m = 0; m < scene.names.length; ++m) {
      const state = message.states[m]!;
      markers.states[m * P + P - 1] = state;
      if (state >= firstAbsent) continue;
      for (let k = 0; k < 3; ++k) markers.x[(3 * m + k) * P + P - 1] = message.x[3 * m + k]!;
      this.seen[m] = true;
    }
  }

  /** The point nearest to a frame of the last seconds among those that frames came for; the newest one for other frames. */
  pointOf(frame: number): number {
    const { points, frameStep } = this.scene;
    const point = points - 1 - (this.#cell - Math.floor(frame / frameStep));
    if (frame < 0 || point < 0 || point >= points) return points - 1;
    for (let off = 0; off < points; ++off) {
      for (const near of [point - off, point + off]) if (this.#came[near] === 1) return near;
    }
    return points - 1;
  }

  /** Move everything by so many points into the past; what comes in is missing, where it was last. */
  #shift(by: number): void {
    const { points: P, markers, names } = this.scene;
    this.#came.copyWithin(0, by).fill(0, P - by);
    for (let row = 0; row < 3 * names.length; ++row) {
      const last = markers.x[row * P + P - 1]!;
      markers.x.copyWithin(row * P, row * P + by, (row + 1) * P);
      markers.x.fill(last, (row + 1) * P - by, (row + 1) * P);
    }
    for (let m = 0; m < names.length; ++m) {
      markers.states.copyWithin(m * P, m * P + by, (m + 1) * P);
      markers.states.fill(missing, (m + 1) * P - by, (m + 1) * P);
    }
  }
}
