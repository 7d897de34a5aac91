// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PackedCodes, PackedCurve } from "../../src/page_types.ts";
import { describe, expect, it } from "vitest";
import { coarsest, decimalsOfStep, decodeBytes, decodeFloats, inflateAll, precisionWords, stepOf } from "../../src/curves.ts";

const curve = (data: string, rest: Partial<PackedCurve>): PackedCurve => ({ kind: "rounded", step: 1, order: 0, bytes: 1, absent: false, data, ...rest });

// The program is held to the same bytes: src/kinemark/stages/report/curve_block_test.cc. The streams were made with another zlib.
describe("packed curves", () => {
  const page = {
    first: curve("eNo7wcTCwMbAwMDIAAAIMgDW", { step: 0.01, order: 1, absent: true }),
    second: [curve("eNoTZmJhYQEAAIQAIg==", { step: 0.5, order: 2 })],
    none: curve("eNqLCI9gYmICAAU1AQ4=", { bytes: 2 }),
    codes: { kind: "codes", data: "eNpjYGYEAAAKAAU=" } as PackedCodes,
    nothing: null,
    words: "as it was",
  };
  it("come back as the program packed them", async () => {
    await inflateAll(page);
    const first = decodeFloats(page.first, 5);
    [1, 1.01, 1.03, NaN, 1.06].forEach((v, i) => (Number.isNaN(v) ? expect(first[i]).toBeNaN() : expect(first[i]).toBeCloseTo(v, 6)));
    expect([...decodeFloats(page.second[0]!, 5)]).toEqual([-5, -4.5, -3, -0.5, 3]);
    expect([...decodeFloats(page.none, 3)]).toEqual([300, -300, 300]);
    expect([...decodeBytes(page.codes, 3)]).toEqual([0, 3, 1]);
    expect(page.words).toBe("as it was");
  });
  it("may be inflated once more without harm, and are refused at another length", async () => {
    await inflateAll(page);
    expect(() => decodeFloats(page.second[0]!, 4)).toThrow("a series holds 5 codes; 4 points need as many");
  });
  it("tell what they are rounded to; one that is absent is not", () => {
    expect(stepOf(page.first)).toBe(0.01);
    expect(stepOf(null)).toBeNull();
    expect(coarsest(null, 0.5, undefined, 0.2)).toBe(0.5);
    expect(coarsest(null, undefined)).toBeNull();
    expect([0.01, 0.005, 0.5, 1, 20, 1e-6].map(decimalsOfStep)).toEqual([2, 3, 1, 0, 0, 6]);
  });
  it("say in words what the page holds of them", () => {
    expect(precisionWords({ step: 0.005, framesOfPair: 30 }, "mm")).toBe("smallest and largest of 30 frames each, rounded to 0.005 mm");
    expect(precisionWords({ step: null, framesOfPair: 1 }, "")).toBe("");
  });
});
