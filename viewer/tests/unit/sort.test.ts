// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { sorted } from "../../src/sort.ts";
import { simulated } from "../simulated.ts";

describe("sorted", () => {
  it("puts the worst frame first and leaves its input alone", () => {
    const frames = [...simulated().summary.worst_frames].reverse();
    expect(sorted(frames, (w) => w.rms_error_mm, "descending").map((w) => w.frame)).toEqual([100, 10]);
    expect(sorted(frames, (w) => w.time_s, "ascending").map((w) => w.frame)).toEqual([10, 100]);
    expect(frames.map((w) => w.frame)).toEqual([10, 100]);
  });
  it("keeps unknown values last in both directions", () => {
    const rows = [null, 3, null, 1];
    expect(sorted(rows, (r) => r, "ascending")).toEqual([1, 3, null, null]);
    expect(sorted(rows, (r) => r, "descending")).toEqual([3, 1, null, null]);
  });
  it("counts in names as people do and keeps equal rows in order", () => {
    expect(sorted(["M10", "M9", "m1"], (r) => r, "ascending")).toEqual(["m1", "M9", "M10"]);
    const rows = [{ k: 1, n: "a" }, { k: 1, n: "b" }, { k: 0, n: "c" }];
    expect(sorted(rows, (r) => r.k, "descending").map((r) => r.n)).toEqual(["a", "b", "c"]);
  });
});
