// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { install } from "../fake_dom.ts";
import { sceneWith } from "../scene_with.ts";
import type { Vec } from "../../src/scene/vec.ts";

install();
const { boundsAt, goesFar, middleAt } = await import("../../src/scene/journey.ts");

const walking = (metres: number) => sceneWith(["A", "B"], 101, (m, p): Vec => [(metres * p) / 100, 0, m]);

describe("goesFar", () => {
  it("tells a walk through the room from one on the spot", () => {
    expect(goesFar(walking(8))).toBe(true);
    expect(goesFar(walking(1))).toBe(false);
    expect(goesFar(sceneWith([], 0, (): Vec => [0, 0, 0]))).toBe(false);
  });
  it("looks at the whole room where plates or cameras stand in it", () => {
    const square: Vec[] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    expect(goesFar({ ...walking(8), plates: [square] })).toBe(false);
  });
});

describe("middleAt, boundsAt", () => {
  it("count what is there", () => {
    const scene = walking(8);
    expect(middleAt(scene, 50)).toEqual([4, 0, 0.5]);
    scene.markers.states[101 + 50] = 4;
    expect(middleAt(scene, 50)).toEqual([4, 0, 0]);
    expect(boundsAt(scene, 50)).toEqual([[4, 0, 0], [4, 0, 0]]);
    scene.markers.states[50] = 5;
    expect(middleAt(scene, 50)).toBeNull();
    expect(boundsAt(scene, 50)[1][0]).toBeGreaterThan(7);
  });
});
