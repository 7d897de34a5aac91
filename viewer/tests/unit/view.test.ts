// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { clampRange, shifted, View, wholeOf, zoomed } from "../../src/view.ts";
import { install, nextFrame } from "../fake_dom.ts";

describe("the time range", () => {
  const whole = [0, 10] as const;
  it("stays inside the trial and keeps its length where it can", () => {
    expect(clampRange([-1, 1], whole)).toEqual([0, 2]);
    expect(clampRange([9, 11], whole)).toEqual([8, 10]);
    expect(clampRange([-5, 50], whole)).toEqual([0, 10]);
    expect(clampRange([3, 4], whole)).toEqual([3, 4]);
  });
  it("falls back to the whole when it is empty or not a number", () => {
    expect(clampRange([4, 4], whole)).toEqual(whole);
    expect(clampRange([NaN, 1], whole)).toEqual(whole);
  });
  it("zooms about its middle and moves by a share", () => {
    expect(zoomed([2, 6], 0.5)).toEqual([3, 5]);
    expect(shifted([2, 6], -0.5)).toEqual([0, 4]);
  });
});

describe("wholeOf", () => {
  it("is from the first frame to the last, and never empty", () => {
    expect(wholeOf({ first_time_s: 1, frames: 101, rate_hz: 50 })).toEqual([1, 3]);
    expect(wholeOf({ first_time_s: 0, frames: 1, rate_hz: 50 })).toEqual([0, 0.02]);
    expect(wholeOf({ first_time_s: 0, frames: 0, rate_hz: 50 })).toEqual([0, 0.02]);
  });
});

describe("View", () => {
  it("tells its listeners once per frame of all that changed", () => {
    install();
    const view = new View([0, 10]);
    const listener = vi.fn();
    view.onChange(listener);
    view.set({ marker: 3 });
    view.set({ pointer: 2, range: [8, 20] });
    expect(listener).not.toHaveBeenCalled();
    nextFrame();
    expect(listener).toHaveBeenCalledTimes(1);
    expect([view.marker, view.pointer, view.range]).toEqual([3, 2, [0, 10]]);
    view.set({ marker: 1 });
    nextFrame();
    expect(listener).toHaveBeenCalledTimes(2);
  });
  it("jumps to the whole of what lasts, with a second on either side", () => {
    install();
    const view = new View([0, 100]);
    view.jumpTo(30, "marker", 5);
    expect([view.range, view.focus, location.hash]).toEqual([[29, 36], 30, "marker"]);
    view.jumpTo(0.2, "marker");
    expect(view.range).toEqual([0, 2]);
  });
});
