// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { fieldOfView, fitted, metresPerPixel, orbited, panned, poseOf, project, standardView, zoomed, type Camera } from "../../src/scene/camera.ts";
import { cross, distance, dot, floorAxes, length, type Vec } from "../../src/scene/vec.ts";

const camera: Camera = { target: [1, 2, 0.5], up: [0, 0, 1], azimuth: 0.4, elevation: 0.3, distance: 4, perspective: true };
const [width, height] = [800, 500];

describe("floorAxes", () => {
  it.each([[[0, 0, 1]], [[0, 1, 0]], [[1, 0, 0]], [[0, 0, -1]]] as [Vec][])("is right-handed for up %j", (up) => {
    const [first, second] = floorAxes(up);
    expect(dot(first, up)).toBeCloseTo(0);
    expect(distance(cross(first, second), up)).toBeCloseTo(0);
  });
});

describe("poseOf", () => {
  it("looks at the target from its distance, upright", () => {
    const pose = poseOf(camera);
    expect(distance(pose.eye, camera.target)).toBeCloseTo(4);
    expect(dot(pose.right, camera.up)).toBeCloseTo(0);
    expect(dot(pose.up, camera.up)).toBeGreaterThan(0);
    expect(distance(cross(pose.right, pose.up), [-pose.forward[0], -pose.forward[1], -pose.forward[2]])).toBeCloseTo(0);
  });
  it("is still defined straight from above", () => {
    const pose = poseOf(standardView(camera, "top", 0));
    expect(length(pose.right)).toBeCloseTo(1);
    expect(pose.forward[2]).toBeCloseTo(-1);
  });
});

describe("project", () => {
  it("has the target in the middle", () => {
    const [x, y, depth] = project(camera, poseOf(camera), width, height, camera.target);
    expect([x, y, depth]).toEqual([expect.closeTo(400), expect.closeTo(250), expect.closeTo(4)]);
  });
  it("agrees with the angle of view at the upper edge", () => {
    const pose = poseOf(camera);
    const top: Vec = [0, 1, 2].map((k) => camera.target[k]! + 4 * Math.tan(fieldOfView / 2) * pose.up[k]!) as Vec;
    expect(project(camera, pose, width, height, top)[1]).toBeCloseTo(0);
  });
  it("keeps sizes in an orthographic view, whatever the depth", () => {
    const flat = { ...camera, perspective: false };
    expect(metresPerPixel(flat, 1, height)).toBe(metresPerPixel(flat, 9, height));
    expect(metresPerPixel(camera, 8, height)).toBeCloseTo(2 * metresPerPixel(camera, 4, height));
  });
});

describe("moving the camera", () => {
  it("does not turn over", () => {
    expect(orbited(camera, 0, 9).elevation).toBeCloseTo(Math.PI / 2);
    expect(orbited(camera, 0, -9).elevation).toBeCloseTo(-Math.PI / 2);
  });
  it("takes what is under the pointer along", () => {
    const moved = panned(camera, 30, -20, height);
    const [x, y] = project(moved, poseOf(moved), width, height, camera.target);
    expect([x - 400, y - 250]).toEqual([expect.closeTo(30), expect.closeTo(-20)]);
  });
  it("comes neither into the target nor too far away", () => {
    expect(zoomed(camera, 1e-9).distance).toBe(0.05);
    expect(zoomed(camera, 1e9).distance).toBe(200);
  });
  it("sees the front from the front: who faces x looks at us", () => {
    expect(poseOf(standardView(camera, "front", 0)).forward[0]).toBeCloseTo(-1);
    expect(poseOf(standardView(camera, "side", 0)).forward[1]).toBeCloseTo(1);
  });
});

describe("fitted", () => {
  const places: Vec[] = [[0, 0, 0], [3, 0, 0], [3, 8, 0], [0, 8, 2], [1, 1, 2]];
  it.each([true, false])("shows all places and fills the picture (perspective: %s)", (perspective) => {
    for (const [w, h] of [[800, 500], [300, 500]] as const) {
      const now = fitted({ ...camera, perspective }, places, w, h);
      const seen = places.map((x) => project(now, poseOf(now), w, h, x));
      for (const [x, y] of seen) {
        expect(x).toBeGreaterThan(0);
        expect(x).toBeLessThan(w);
        expect(y).toBeGreaterThan(0);
        expect(y).toBeLessThan(h);
      }
      const span = (k: 0 | 1): number => Math.max(...seen.map((s) => s[k])) - Math.min(...seen.map((s) => s[k]));
      expect(Math.max(span(0) / w, span(1) / h)).toBeGreaterThan(0.75);
    }
  });
  it("leaves the camera where there is nothing to see", () => {
    expect(fitted(camera, [], 10, 10)).toBe(camera);
  });
});
