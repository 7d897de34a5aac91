// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { bytes, duration, number, percent, plural, seconds } from "../../src/format.ts";

describe("format", () => {
  it("writes numbers for people", () => {
    expect(number(14200)).toBe("14,200");
    expect(number(-3.14159, 2)).toBe("−3.14");
    expect(number(-0.001, 1)).toBe("0.0");
    expect(number(null, 2)).toBe("–");
    expect(number(NaN)).toBe("–");
  });
  it("never rounds a share up to all or down to nothing", () => {
    expect(percent(1)).toBe("100 %");
    expect(percent(0.99999)).toBe("> 99.9 %");
    expect(percent(0.838333)).toBe("83.8 %");
    expect(percent(0.0004)).toBe("0.04 %");
    expect(percent(0.00001)).toBe("< 0.01 %");
    expect(percent(0)).toBe("0 %");
    expect(percent(null)).toBe("–");
  });
  it("writes times, sizes and counts", () => {
    expect(seconds(2.5)).toBe("2.500 s");
    expect(duration(6)).toBe("6.00 s");
    expect(duration(125.2)).toBe("2 min 5 s");
    expect(duration(3599.9)).toBe("1 h 0 min");
    expect(bytes(999)).toBe("999 B");
    expect(bytes(184320)).toBe("184 kB");
    expect(bytes(999999)).toBe("1.00 MB");
    expect(plural(1, "note")).toBe("1 note");
    expect(plural(2000, "note")).toBe("2,000 notes");
  });
});
