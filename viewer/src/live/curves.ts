// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CoordinateSeries } from "../decode.ts";
import type { TimeRange } from "../view.ts";
import type { AnglesMessage } from "./message.ts";

const seconds = 10;
const pointsPerSecond = 30;

/** The last seconds of all angles, with their standard deviations. */
export class LiveCurves {
  readonly time: Float64Array;
  readonly series: CoordinateSeries[];
  #cell = -1;

  constructor(count: number) {
    const points = seconds * pointsPerSecond;
    // Before the first frame it is long ago, so that times rise from the beginning.
    this.time = Float64Array.from({ length: points }, (_, i) => i / pointsPerSecond - 1e9);
    this.series = Array.from({ length: count }, () => ({ value: new Float32Array(points).fill(NaN), sd: new Float32Array(points).fill(NaN), undetermined: new Uint8Array(points) }));
  }

  push(message: AnglesMessage): void {
    const cell = Math.floor(message.time_s * pointsPerSecond + 1e-9);
    if (cell < this.#cell) return;
    const shift = cell > this.#cell;
    this.#cell = cell;
    const last = this.time.length - 1;
    const put = <T extends Float32Array | Float64Array | Uint8Array>(list: T, value: number): void => {
      if (shift) list.copyWithin(0, 1);
      list[last] = value;
    };
    put(this.time, message.time_s);
    this.series.forEach((s, c) => {
      const determined = message.determined[c] === 1;
      put(s.value, message.value[c] ?? NaN);
      put(s.sd!, determined ? message.sd[c]! : NaN);
      put(s.undetermined!, determined || Number.isNaN(message.value[c] ?? NaN) ? 0 : 1);
    });
  }

  /** The seconds that are shown; null before the first frame. */
  range(): TimeRange | null {
    const to = this.time[this.time.length - 1]!;
    return this.#cell < 0 ? null : [to - seconds, to];
  }
}
