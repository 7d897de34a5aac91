// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Plate } from "../../src/page_types.ts";
import { describe, expect, it } from "vitest";
import type { Scene } from "../../src/scene/scene.ts";
import type { Vec } from "../../src/scene/vec.ts";
import { install } from "../fake_dom.ts";
import { deflated } from "../packed.ts";
import { pack, placeOf, simulatedMarkers } from "../simulated_markers.ts";

install();
const { facing, isLeft, otherSide } = await import("../../src/scene/facing.ts");
const { floorHeight, floorLines, floorOf } = await import("../../src/scene/floor.ts");
const { areComputed, bounds, pointAt, unpackScene } = await import("../../src/scene/scene.ts");
const { areConventional, namedSticks, sticks } = await import("../../src/scene/sticks.ts");
const { at, isThere } = await import("../../src/scene/track.ts");
const { inflated, unpackWords } = await import("../../src/scene/unpack.ts");
const { upright } = await import("../../src/scene/upright.ts");

/** A scene from a function of marker and point. */
function sceneOf(names: string[], points: number, place: (m: number, p: number) => Vec, up: Vec = [0, 0, 1]): Scene {
  const x = new Float32Array(3 * names.length * points);
  for (let m = 0; m < names.length; ++m) for (let p = 0; p < points; ++p) place(m, p).forEach((v, k) => (x[(3 * m + k) * points + p] = v));
  const states = new Uint8Array(names.length * points);
  return {
    points, frameStep: 1, firstFrame: 0, rateHz: 100, time: Float64Array.from({ length: points }, (_, i) => i / 100), names, isMain: names.map(() => true),
    up, upFrom: "", markers: { x, states }, before: null, model: null, worst: states, plates: [], forces: [], bodies: null, skeleton: null, cameras: [],
  };
}

describe("unpack", () => {
  it("reads what a zlib stream holds", async () => {
    const bytes = Uint8Array.from({ length: 1000 }, (_, i) => (i * i) & 255);
    expect(await inflated(deflated(bytes))).toEqual(bytes);
  });
  it("refuses a damaged stream and one of another size", async () => {
    await expect(inflated("AAAA")).rejects.toThrow();
    expect(() => unpackWords(new Uint8Array(3), { kind: "int16", series: 1, points: 2 })).toThrow("need 4");
  });
  it("reads float32 to the bit, byte planes and differences", () => {
    const values = Float32Array.from([1.5, -2e9, 3.25e-20, 3.25e-20]);
    const bits = new Uint32Array(values.buffer);
    const bytes = new Uint8Array(16);
    bits.forEach((word, i) => {
      const change = (word - (i === 0 || i === 2 ? 0 : bits[i - 1]!)) >>> 0;
      for (let b = 0; b < 4; ++b) bytes[4 * b + i] = (change >>> (8 * b)) & 255;
    });
    expect(unpackWords(bytes, { kind: "float32", series: 2, points: 2 })).toEqual(values);
  });
  it("reads steps of 16 bits that go down as well as up", async () => {
    const packed = pack([[0.5, 0.1, 0.3], [7, 7, 7]]);
    const out = unpackWords(await inflated(packed.data), packed);
    [0.5, 0.1, 0.3, 7, 7, 7].forEach((v, i) => expect(out[i]).toBeCloseTo(v, 4));
  });
});

describe("unpackScene", () => {
  it("has each marker where it was, and its state", async () => {
    const { summary, scene: packed } = simulatedMarkers();
    const scene = await unpackScene(packed, summary, (m) => m !== 7);
    for (const [m, p] of [[0, 0], [2, 60], [6, 199]] as const) {
      at(scene.markers.x, scene.points, m, p).forEach((v, k) => expect(v).toBeCloseTo(placeOf(m, p)[k]!, 4));
    }
    expect(isThere(scene.markers, scene.points, 4, 49)).toBe(true);
    expect(isThere(scene.markers, scene.points, 4, 50)).toBe(false);
    expect(scene.isMain).toEqual([true, true, true, true, true, true, true, false]);
    expect(scene.time[199]).toBeCloseTo(2.99);
    expect(scene.worst).toBe(scene.markers.states);
    expect(scene.forces[0]!.force[2 * scene.points]).toBeCloseTo(700, 0);
  });
  it("refuses what does not fit together", async () => {
    const { summary, scene } = simulatedMarkers();
    await expect(unpackScene({ ...scene, names: ["one"] }, summary)).rejects.toThrow("1 markers");
  });
  it("leaves out plates without corners", async () => {
    const { summary, scene } = simulatedMarkers();
    const plates: Plate[] = [{ type: 1, corners_m: [[null, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] }];
    expect((await unpackScene({ ...scene, plates }, summary)).plates).toEqual([]);
  });
  it("finds what is up where nobody says so", async () => {
    const { summary, scene } = simulatedMarkers();
    expect((await unpackScene({ ...scene, up: null, up_from: "" }, summary)).upFrom).not.toBe("the force plates");
  });
});

describe("pointAt", () => {
  it("is the nearest point, and never outside", () => {
    const scene = { points: 10, frameStep: 3, rateHz: 30, time: Float64Array.from({ length: 10 }, (_, i) => 5 + i / 10) };
    expect([pointAt(scene, 5.24), pointAt(scene, 0), pointAt(scene, 99)]).toEqual([2, 0, 9]);
  });
});

describe("what names tell", () => {
  it("knows the other side", () => {
    expect(otherSide("Ann:LASI")).toBe("Ann:RASI");
    expect(otherSide("r_knee")).toBe("l_knee");
    expect(otherSide("R.Knee.Lat")).toBe("L.Knee.Lat");
    expect(otherSide("LeftToe")).toBe("RightToe");
    expect(otherSide("Lumbar")).toBe(null);
    expect([isLeft("LASI"), isLeft("RASI"), isLeft("Ann:LeftToe")]).toEqual([true, false, true]);
  });
  it("knows axes that Plug-in Gait computed, four to a segment", () => {
    expect(areComputed(["LFEO", "LFEA", "LFEL", "LFEP", "LASI", "PELO"])).toEqual([true, true, true, true, false, false]);
  });
  it("joins the conventional gait set of every subject", () => {
    const legs = ["ASI", "KNE", "ANK", "HEE", "TOE"].flatMap((n) => [`L${n}`, `R${n}`]);
    expect(areConventional(legs)).toBe(true);
    expect(areConventional(["a", "b"])).toBe(false);
    const two = namedSticks(["A:LKNE", "A:LANK", "B:LKNE", "B:LANK"]);
    expect(two).toEqual([[0, 1], [2, 3]]);
  });
});

describe("sticks", () => {
  const moving = (m: number, p: number): Vec => {
    // Two bars that turn about a common end: 0-1 and 1-2; marker 3 goes its own way.
    const [a, b] = [0.03 * p, 2 + 0.05 * p];
    const middle: Vec = [0.001 * p, 0, 1];
    if (m === 1) return middle;
    if (m === 3) return [Math.sin(0.1 * p), Math.cos(0.07 * p), 0.2];
    const [angle, size] = m === 0 ? [a, 0.3] : [b, 0.4];
    return [middle[0] + size * Math.cos(angle), size * Math.sin(angle), 1];
  };
  it("joins what keeps its distance, and nothing else", () => {
    expect([...sticks(sceneOf(["p", "q", "r", "s"], 200, moving))].map((s) => [...s].sort()).sort()).toEqual([[0, 1], [1, 2]]);
  });
  it("says nothing where nothing moves", () => {
    expect(sticks(sceneOf(["p", "q", "r"], 100, (m) => [0.1 * m, 0, 0]))).toEqual([]);
  });
});

describe("facing", () => {
  const pair = (up: Vec, left: Vec, right: Vec): number => facing(sceneOf(["LASI", "RASI"], 10, (m) => (m === 0 ? left : right), up));
  it("is across left and right", () => {
    expect(pair([0, 0, 1], [0, 1, 1], [0, -1, 1])).toBeCloseTo(0);
    expect(pair([0, 0, 1], [-1, 0, 1], [1, 0, 1])).toBeCloseTo(Math.PI / 2);
  });
  it("is the way that markers go, otherwise", () => {
    expect(facing(sceneOf(["a"], 100, (_, p) => [0, 0.03 * p, 0]))).toBeCloseTo(Math.PI / 2);
    expect(facing(sceneOf(["a"], 100, (_, p) => [0, 0.001 * p, 0]))).toBe(0);
  });
});

describe("upright", () => {
  it("is the axis along which a body stands", () => {
    const standing = (axis: number): Scene => sceneOf(["a", "b", "c", "d", "e"], 20, (m) => [0, 1, 2].map((k) => (k === axis ? 0.4 * m : 0.1 * (m % 2))) as Vec);
    for (const axis of [0, 1, 2]) expect(upright(standing(axis).markers, 5, 20)![axis]).toBe(1);
    const small = sceneOf(["a", "b"], 20, (m) => [0, 0, 0.1 * m]);
    expect(upright(small.markers, 2, 20)).toBe(null);
  });
});

describe("the floor", () => {
  it("is under the feet, at the plates, or at 0", () => {
    expect(floorHeight(sceneOf(["a", "b"], 10, (m) => [0, 0, 0.1 + m]))).toBe(0);
    expect(floorHeight(sceneOf(["a", "b"], 10, (m) => [0, 0, 3 + m]))).toBeCloseTo(2.98);
    const onPlate = { ...sceneOf(["a"], 10, () => [0, 0, 1]), plates: [[[0, 0, 0.2], [1, 0, 0.2], [1, 1, 0.2], [0, 1, 0.2]] as Vec[]] };
    expect(floorHeight(onPlate)).toBe(0.2);
  });
  it("reckons how far a recording reaches once, unless its samples change", () => {
    const scene = sceneOf(["a"], 3, (_, p) => [p, 2, 3]);
    expect(bounds(scene, 0)).toEqual([[0, 2, 3], [2, 2, 3]]);
    scene.markers.x[2] = 50;
    expect(bounds(scene, 0)[1][0]).toBe(2);
    expect(bounds({ ...scene, changes: true }, 0)[1][0]).toBe(50);
    expect(bounds({ ...scene, extent: [[7, 7, 7], [8, 8, 8]] }, 0)[0]).toEqual([7, 7, 7]);
  });
  it("reaches beyond everything, with lines at whole multiples", () => {
    const scene = sceneOf(["a"], 100, (_, p) => [0.05 * p, 0, 1]);
    const floor = floorOf(scene);
    const [low, high] = bounds(scene);
    expect(floor.low[0]).toBeLessThan(low[0]);
    expect(floor.high[0]).toBeGreaterThan(high[0]);
    expect(Math.abs(floor.low[0] / floor.spacing - Math.round(floor.low[0] / floor.spacing))).toBeLessThan(1e-9);
    const { positions, strong } = floorLines(floor);
    expect(positions.length).toBe(3 * strong.length);
    expect(floor.below([1, 2, 3], 0.5)).toEqual([1, 2, expect.closeTo(floor.height + 0.5)]);
  });
});
