// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

export type TimeRange = readonly [from: number, to: number];

/** What all plots of the page share: the time shown, the time under the pointer, and what is selected. */
export class View {
  readonly whole: TimeRange;
  range: TimeRange;
  /** Time under the pointer, or null. */
  pointer: number | null = null;
  /** Time that a click asked for, or null. */
  focus: number | null = null;
  coordinate = 0;
  /** Index of the chosen marker, or -1. */
  marker = -1;
  /** Index of the chosen inertial sensor, or -1. */
  sensor = -1;
  /** The time that is to be edited, or null. */
  stretch: TimeRange | null = null;
  /** Whether a stretch can be chosen. */
  editable = false;

  readonly #listeners: (() => void)[] = [];
  #scheduled = false;

  constructor(whole: TimeRange) {
    this.whole = whole;
    this.range = whole;
  }

  onChange(listener: () => void): void {
    this.#listeners.push(listener);
  }

  /** Change any fields; the plots hear of it once per animation frame. */
  set(change: Partial<Pick<View, "range" | "pointer" | "focus" | "coordinate" | "marker" | "sensor" | "stretch">>): void {
    if (change.range !== undefined) change.range = clampRange(change.range, this.whole);
    Object.assign(this, change);
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => {
      this.#scheduled = false;
      for (const listener of this.#listeners) listener();
    });
  }

  /** Show what begins at `time` and one second on either side, in the section named; the browser's Back returns. */
  jumpTo(time: number, section: string, length = 0): void {
    this.set({ range: [time - 1, time + length + 1], focus: time });
    location.hash = section;
  }
}

/** From the first frame to the last; never empty. */
export function wholeOf(summary: { first_time_s: number; frames: number; rate_hz: number }): TimeRange {
  const start = summary.first_time_s;
  return [start, start + Math.max(1, summary.frames - 1) / summary.rate_hz];
}

/** The range moved, and if need be shortened, into the whole. */
export function clampRange([from, to]: TimeRange, whole: TimeRange): TimeRange {
  const length = Math.min(to - from, whole[1] - whole[0]);
  if (!(length > 0)) return whole;
  const start = Math.min(Math.max(from, whole[0]), whole[1] - length);
  return [start, start + length];
}

/** Zoom by a factor about the middle; below 1 comes nearer. */
export function zoomed([from, to]: TimeRange, factor: number): TimeRange {
  const middle = (from + to) / 2;
  const half = (factor * (to - from)) / 2;
  return [middle - half, middle + half];
}

/** Move by a share of the length. */
export function shifted([from, to]: TimeRange, share: number): TimeRange {
  const by = share * (to - from);
  return [from + by, to + by];
}
