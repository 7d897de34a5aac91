// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Pace } from "../../src/scene/pace.ts";

/** Shares of so many pictures, one every so many ms. */
function drawn(pace: Pace, count: number, every_ms: number, from = 0): number[] {
  return Array.from({ length: count }, (_, i) => pace.next(from + i * every_ms));
}

describe("the pace of a picture", () => {
  it("is full where pictures come in time", () => {
    expect(new Set(drawn(new Pace(), 200, 16))).toEqual(new Set([1]));
    expect(new Set(drawn(new Pace(), 200, 40))).toEqual(new Set([1]));
  });
  it("gets coarser in steps while they come slowly, and no coarser than it may", () => {
    const shares = drawn(new Pace(), 40, 120);
    expect(shares.slice(0, 5)).toEqual([1, 1, 1, 1, 0.75]);
    expect(shares.at(-1)).toBe(0.35);
    expect(shares.every((s, i) => i === 0 || s <= shares[i - 1]!)).toBe(true);
  });
  it("does not take pauses for slowness: single steps are full", () => {
    expect(new Set(drawn(new Pace(), 50, 1000))).toEqual(new Set([1]));
  });
  it("remembers after a pause how slow it was, and recovers when it is fast for long", () => {
    const pace = new Pace();
    drawn(pace, 9, 100);
    expect(pace.next(10_000)).toBe(0.5);
    const later = drawn(pace, 200, 16, 10_016);
    expect([later[50], later[95], later.at(-1)]).toEqual([0.5, 0.75, 1]);
  });
});
