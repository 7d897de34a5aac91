// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { decodeBytes, decodeFloats } from "../../src/curves.ts";
import { decode } from "../../src/decode.ts";
import { inflated, packedCodes, packedCurve } from "../packed.ts";
import { simulated } from "../simulated.ts";

describe("decodeFloats", () => {
  it("reads multiples of the step, and what is missing", () => {
    expect([...decodeFloats(inflated(packedCurve([1, -2.5, NaN], 0.5)), 3)]).toEqual([1, -2.5, NaN]);
  });
  it("refuses a series of another length and says both", () => {
    expect(() => decodeFloats(inflated(packedCurve([1])), 2)).toThrow("a series holds 5 codes; 10 points need as many");
    expect(() => decodeBytes(inflated(packedCodes([0, 1, 2])), 2)).toThrow("3 codes");
  });
  it("refuses a series that nobody has inflated", () => {
    expect(() => decodeFloats(packedCurve([1]), 1)).toThrow("must be inflated");
  });
});

describe("decode", () => {
  it("gives every series the length of the time axis", () => {
    const trial = decode(inflated(simulated(400)));
    expect(trial.time.length).toBe(400);
    expect(trial.time[250]).toBeCloseTo(2.5, 12);
    for (const c of trial.coordinates) expect(c.value.length).toBe(400);
    expect(trial.coordinates[1]!.value[230]).toBeNaN();
    expect(trial.coordinates[1]!.undetermined![230]).toBe(1);
    expect(trial.coordinates[2]!.sd).toBeNull();
    expect(trial.gaps[1]![199]).toBe(0);
    expect(trial.gaps[1]![200]).toBe(2);
    expect(trial.gaps[3]).toBeNull();
  });
  it("spaces thinned points by their step", () => {
    const data = simulated(400);
    data.series.frame_step = 5;
    data.summary.first_time_s = 2;
    expect(decode(inflated(data)).time[3]).toBeCloseTo(2.15, 12);
  });
  it("refuses another schema", () => {
    const data = simulated();
    Object.assign(data.summary, { schema_version: 3 });
    expect(() => decode(inflated(data))).toThrow("version 3");
  });
});
