// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { columnRange, extremes, firstAtOrAfter, nearest, shareAbove0, worstCode } from "../../src/downsample.ts";

const time = Float64Array.of(0, 1, 2, 3, 4);

describe("firstAtOrAfter and nearest", () => {
  it("agree with a search from left to right", () => {
    for (let t = -1; t <= 5; t += 0.125) {
      const plain = [...time].findIndex((v) => v >= t);
      expect(firstAtOrAfter(time, t)).toBe(plain < 0 ? 5 : plain);
      const distance = Math.min(...[...time].map((v) => Math.abs(v - t)));
      expect(Math.abs(time[nearest(time, t)]! - t)).toBeCloseTo(distance, 12);
    }
  });
  it("know an empty axis", () => {
    expect(nearest(new Float64Array(0), 1)).toBe(-1);
  });
});

describe("columnRange", () => {
  it("covers every point, whether there are more points or more columns", () => {
    for (const [points, columns] of [[1000, 7], [7, 7], [3, 10], [864, 200]] as const) {
      const seen = new Set<number>();
      for (let c = 0; c < columns; ++c) {
        const [from, to] = columnRange(5, 5 + points, columns, c);
        expect(to).toBeGreaterThan(from);
        for (let i = from; i < to; ++i) seen.add(i);
      }
      for (let i = 5; i < 5 + points; ++i) expect(seen.has(i)).toBe(true);
    }
  });
});

describe("extremes", () => {
  it("keeps a single peak in each direction", () => {
    const values = new Float32Array(1000).fill(1);
    values[371] = -8;
    values[372] = 9;
    expect(extremes(values, 0, 1000)).toEqual([-8, 9]);
    expect(extremes(values, 0, 371)).toEqual([1, 1]);
  });
  it("leaves NaN out, and is NaN when there is nothing else", () => {
    expect(extremes([NaN, 2, NaN, 1], 0, 4)).toEqual([1, 2]);
    expect(extremes([NaN, NaN], 0, 2)).toEqual([NaN, NaN]);
  });
});

describe("codes", () => {
  it("report the worst and the share of a span", () => {
    const codes = Uint8Array.of(0, 3, 1, 0);
    expect(worstCode(codes, 0, 4)).toBe(3);
    expect(worstCode(codes, 2, 10)).toBe(1);
    expect(shareAbove0(codes, 0, 4)).toBe(0.5);
    expect(shareAbove0(codes, 2, 2)).toBe(0);
  });
});
