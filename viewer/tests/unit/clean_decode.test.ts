// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { decodeClean } from "../../src/clean_decode.ts";
import { inflated, packedCurve } from "../packed.ts";
import { simulatedClean } from "../simulated_clean.ts";

describe("decodeClean", () => {
  it("gives every series the length of the time axis", () => {
    const trial = decodeClean(inflated(simulatedClean(400)));
    expect(trial.time.length).toBe(400);
    expect(trial.time[250]).toBeCloseTo(2.5, 12);
    for (const axis of trial.marker(0).position) expect(axis!.length).toBe(400);
    expect(trial.before.map((b) => b.length)).toEqual([400, 400, 400, 400]);
    expect(trial.before[1]![100]).toBe(4);
    expect(trial.after[1]![100]).toBe(3);
    expect(trial.after[2]![50]).toBe(5);
  });
  it("tells values of one axis from those of another", () => {
    const { position, raw, change } = decodeClean(inflated(simulatedClean())).marker(1);
    expect(position[0]![0]).toBeCloseTo(200, 3);
    expect(position[2]![0]).toBeCloseTo(220 + 50 * Math.sin(2), 3);
    expect(raw[0]![0]! - position[0]![0]!).toBeCloseTo(change[0]![0]!, 3);
    expect(raw[0]![120]).toBeNaN();
  });
  it("leaves out what the result does not have", () => {
    const trial = decodeClean(inflated(simulatedClean()));
    expect(trial.marker(2).velocity).toEqual([null, null, null]);
    expect(trial.marker(0).velocity[1]).not.toBeNull();
  });
  it("reads a marker once, when it is asked for", () => {
    const data = simulatedClean();
    data.series.markers[1]!.position_mm[0] = packedCurve([1]);
    const trial = decodeClean(inflated(data));
    expect(trial.marker(0)).toBe(trial.marker(0));
    expect(() => trial.marker(1)).toThrow("5 codes; 2000 points");
    expect(() => trial.marker(9)).toThrow("no marker 9");
  });
  it("spaces thinned points by their step", () => {
    const data = simulatedClean();
    data.series.frame_step = 10;
    data.summary.first_time_s = 3;
    expect(decodeClean(inflated(data)).time[5]).toBeCloseTo(3.5, 12);
  });
  it("says of each axis what it is rounded to", () => {
    const data = simulatedClean(3);
    data.series.markers[0]!.position_mm = [packedCurve([1, 2, 3], 0.01), packedCurve([1, 2, 3], 0.002), null];
    expect(decodeClean(inflated(data)).marker(0).steps.position).toEqual([0.01, 0.002, null]);
    expect(decodeClean(inflated(data)).marker(2).steps.velocity).toEqual([null, null, null]);
  });
  it("refuses another schema and a page with too few series", () => {
    const other = simulatedClean();
    Object.assign(other.summary, { schema_version: 3 });
    expect(() => decodeClean(inflated(other))).toThrow("cannot read kinemark.clean_report version 3");
    const short = simulatedClean();
    short.series.markers.pop();
    expect(() => decodeClean(inflated(short))).toThrow("3 series; 4 markers");
  });
});
