// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { band, partWithCode, stretches, withBreaks } from "../../src/band.ts";

describe("band", () => {
  const series = {
    value: Float32Array.of(1, 2, NaN, 4),
    sd: Float32Array.of(0.5, NaN, 1, 0),
    undetermined: Uint8Array.of(0, 0, 1, 0),
  };
  it("is value -+ 2 SD, and breaks where either is unknown", () => {
    expect(band(series)).toEqual({ middle: [1, 2, null, 4], lower: [0, null, null, 4], upper: [2, null, null, 4] });
  });
  it("takes another width", () => {
    expect(band(series, 1).upper[0]).toBe(1.5);
  });
  it("has no edges without SDs", () => {
    expect(band({ ...series, sd: null }).lower).toEqual([null, null, null, null]);
  });
});

describe("withBreaks", () => {
  it("never hands NaN or infinity to the plot", () => {
    expect(withBreaks(Float32Array.of(0, NaN, Infinity, -1))).toEqual([0, null, null, -1]);
  });
});

describe("partWithCode", () => {
  const line = [0, 1, 2, null, 4, 5];
  it("keeps one neighbour on either side, so that the part joins the rest", () => {
    expect(partWithCode(line, Uint8Array.of(0, 0, 3, 4, 0, 0), 3)).toEqual([null, 1, 2, null, null, null]);
    expect(partWithCode(line, Uint8Array.of(2, 0, 0, 0, 0, 2), 2)).toEqual([0, 1, null, null, 4, 5]);
  });
  it("is nothing where no sample has the code", () => {
    expect(partWithCode(line, new Uint8Array(6), 1).every((v) => v === null)).toBe(true);
  });
});

describe("stretches", () => {
  it("finds runs, also at both ends", () => {
    expect(stretches(Uint8Array.of(1, 1, 0, 2, 0, 1))).toEqual([[0, 2], [3, 4], [5, 6]]);
    expect(stretches(Uint8Array.of(1, 2, 3, 1), 2)).toEqual([[1, 3]]);
  });
  it("finds nothing in nothing", () => {
    expect(stretches(null)).toEqual([]);
    expect(stretches(Uint8Array.of(0, 0))).toEqual([]);
  });
});
