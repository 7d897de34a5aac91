// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** Between pictures, ms: longer is a pause and no motion. */
export const pause_ms = 400;
const slow_ms = 45;
const fast_ms = 18;
const fewest = 4;
const manyFast = 90;
const shares = [1, 0.75, 0.5, 0.35] as const;

/**
 * How fine a picture may be while it moves. Without a graphics card the time of a picture is that of its pixels:
 * where pictures come slowly there are fewer of them, as long as it moves.
 */
export class Pace {
  #level = 0;
  #last = -Infinity;
  #intervals: number[] = [];

  /** A picture is about to be drawn; the share of its pixels along each side, 0.35 to 1. */
  next(now: number): number {
    const interval = now - this.#last;
    this.#last = now;
    if (interval > pause_ms) {
      this.#intervals = [];
      return shares[this.#level]!;
    }
    this.#intervals.push(interval);
    const lately = this.#intervals.slice(-fewest);
    const isSlow = lately.length === fewest && lately.reduce((sum, ms) => sum + ms, 0) > fewest * slow_ms;
    const isFast = this.#intervals.length >= manyFast && this.#intervals.slice(-manyFast).every((ms) => ms < fast_ms);
    if (isSlow && this.#level < shares.length - 1) this.#change(1);
    else if (isFast && this.#level > 0) this.#change(-1);
    if (this.#intervals.length > manyFast) this.#intervals.shift();
    return shares[this.#level]!;
  }

  #change(by: number): void {
    this.#level += by;
    this.#intervals = [];
  }
}
