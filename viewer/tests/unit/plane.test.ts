// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { cross, dot, length, type Vec } from "../../src/scene/vec.ts";
import { install } from "../fake_dom.ts";
import { sceneWith } from "../scene_with.ts";

install();
const { cornersOf, eigen, planeOf } = await import("../../src/scene/plane.ts");

describe("eigen", () => {
  it("agrees with A v = lambda v, the largest first", () => {
    const a: [Vec, Vec, Vec] = [[4, 1, -2], [1, 3, 0.5], [-2, 0.5, 6]];
    const { values, vectors } = eigen(a);
    expect(values[0]).toBeGreaterThanOrEqual(values[1]);
    expect(values[1]).toBeGreaterThanOrEqual(values[2]);
    expect(values[0] + values[1] + values[2]).toBeCloseTo(13, 12);
    vectors.forEach((v, i) => {
      expect(length(v)).toBeCloseTo(1, 12);
      a.forEach((row, k) => expect(dot(row, v)).toBeCloseTo(values[i as 0] * v[k as 0], 10));
    });
  });
  it("is at peace with zeros and with a multiple of the identity", () => {
    expect(eigen([[0, 0, 0], [0, 0, 0], [0, 0, 0]]).values).toEqual([0, 0, 0]);
    expect(eigen([[2, 0, 0], [0, 2, 0], [0, 0, 2]]).values).toEqual([2, 2, 2]);
  });
});

describe("planeOf", () => {
  // An ellipse, half axes 3 and 1, in the plane whose normal is (1, 2, 2) / 3.
  const [u, v]: [Vec, Vec] = [[2 / 3, -2 / 3, 1 / 3], [2 / 3, 1 / 3, -2 / 3]];
  const normal = cross(u, v);
  const off = (p: number): number => (p % 2 === 0 ? 0.02 : -0.02);
  const scene = sceneWith(["A"], 200, (_m, p) => {
    const t = (2 * Math.PI * p) / 200;
    return [0, 1, 2].map((k) => 5 + 3 * Math.cos(t) * u[k]! + Math.sin(t) * v[k]! + off(p) * normal[k]!) as Vec;
  });
  it("finds axes, extent and how far the path is off", () => {
    const plane = planeOf(scene, 0, 0, 199)!;
    expect(Math.abs(dot(plane.axes[0], u))).toBeCloseTo(1, 4);
    expect(Math.abs(dot(plane.axes[2], normal))).toBeCloseTo(1, 4);
    expect(dot(cross(plane.axes[0], plane.axes[1]), plane.axes[2])).toBeCloseTo(1, 6);
    plane.centre.forEach((c) => expect(c).toBeCloseTo(5, 5));
    expect(plane.rms).toBeCloseTo(0.02, 4);
    expect(plane.high[0] - plane.low[0]).toBeCloseTo(6, 3);
    expect(plane.high[1] - plane.low[1]).toBeCloseTo(2, 2);
    expect(plane.samples).toBe(200);
  });
  it("takes only what is there, and says nothing of fewer than three samples", () => {
    scene.markers.states.fill(4, 2);
    expect(planeOf(scene, 0, 0, 199)).toBeNull();
    scene.markers.states.fill(0);
    expect(planeOf(scene, 0, 10, 12)!.samples).toBe(3);
  });
  it("has a box whose corners are all different", () => {
    const corners = cornersOf(planeOf(scene, 0, 0, 199)!);
    expect(new Set(corners.map((c) => c.map((x) => x.toFixed(6)).join())).size).toBe(8);
  });
});
