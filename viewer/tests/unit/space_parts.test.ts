// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { install } from "../fake_dom.ts";
import { sceneWith } from "../scene_with.ts";

install();
const { pressed } = await import("../../src/sections/space_pointer.ts");
const { labelsOf } = await import("../../src/sections/space_labels.ts");
const { spaceFacts, thinnedNote } = await import("../../src/sections/space_parts.ts");

describe("keys of the space view", () => {
  const keys = () => ({ seeFrom: vi.fn(), nearer: vi.fn(), startOver: vi.fn(), time: { toggle: vi.fn(), step: vi.fn(), toEnd: vi.fn() } });
  it("mean views, distances and instants", () => {
    const k = keys();
    for (const key of ["1", "4", "+", "-", "0", " ", "End"]) expect(pressed(key, false, k)).toBe(true);
    expect(pressed("ArrowLeft", true, k)).toBe(true);
    expect(k.seeFrom.mock.calls).toEqual([["front"], ["corner"]]);
    expect(k.nearer.mock.calls).toEqual([[0.87], [1.15]]);
    expect(k.startOver).toHaveBeenCalledOnce();
    expect(k.time.toggle).toHaveBeenCalledOnce();
    expect(k.time.toEnd.mock.calls).toEqual([[true]]);
    expect(k.time.step.mock.calls).toEqual([[-10]]);
  });
  it("leave to the page what means nothing here", () => {
    const k = keys();
    expect(pressed("x", false, k)).toBe(false);
    expect(pressed(" ", false, { ...k, time: null })).toBe(false);
    expect(pressed("0", false, { ...k, time: null })).toBe(true);
  });
});

describe("names in the picture", () => {
  const scene = sceneWith(["A", "B", "C"], 1, (m) => [m, 0, 0]);
  const camera = { target: [0, 0, 0], up: [0, 0, 1], azimuth: 0, elevation: 0, distance: 3, perspective: true } as const;
  const names = (look: object): string[] => labelsOf(scene, [0, 0, 0], { camera: camera as never, point: 0, labelled: "none", picked: -1, hover: -1, hidden: () => false, ...look }).map(([words]) => words);
  it("are those of the markers asked for, and of the axes always", () => {
    expect(names({})).toEqual(["x", "y", "z"]);
    expect(names({ labelled: "all", hidden: (m: number) => m === 1 })).toEqual(["A", "C", "x", "y", "z"]);
    expect(names({ labelled: "picked", picked: 2 })).toEqual(["C", "x", "y", "z"]);
    expect(names({ hover: 1 })).toEqual(["B", "x", "y", "z"]);
  });
});

describe("sentences under the picture", () => {
  it("say which way is up, who says so, and what lines are", () => {
    expect(spaceFacts(sceneWith(["A"], 1, () => [0, 0, 0]), 0, false)).toBe("z is up (assumed)");
    expect(spaceFacts(sceneWith(["A"], 1, () => [0, 0, 0], { up: [0, -1, 0], upFrom: "the model's gravity" }), 0, true)).toBe("−y is up (from the model's gravity); lines join markers whose distance stays the same");
  });
  it("say when not every frame is there", () => {
    expect(thinnedNote(sceneWith(["A"], 1, () => [0, 0, 0]))).toBeNull();
    expect(thinnedNote(sceneWith(["A"], 1, () => [0, 0, 0], { frameStep: 3 }))!.textContent).toContain("every 3rd frame as it is (33.33 Hz)");
  });
});
