// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { clampRange, shifted, zoomed } from "../../src/view.ts";

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
