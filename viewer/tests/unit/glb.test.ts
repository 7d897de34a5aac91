// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import validator from "gltf-validator";
import { describe, expect, it } from "vitest";
import type { Vec } from "../../src/scene/vec.ts";
import { install } from "../fake_dom.ts";
import { sceneWith } from "../scene_with.ts";

install();
const { glbOf, towards } = await import("../../src/scene/glb.ts");

const scene = sceneWith(["A", "B"], 50, (m, p): Vec => [m, 0.01 * p, 0.5 * m]);
scene.markers.states.fill(4, 10, 20);

interface Gltf {
  nodes: { name: string; children?: number[]; rotation?: number[] }[];
  animations: { samplers: { input: number; output: number; interpolation: string }[]; channels: { sampler: number; target: { node: number; path: string } }[] }[];
  accessors: { bufferView: number; count: number; min?: number[]; max?: number[] }[];
  bufferViews: { byteOffset: number; byteLength: number }[];
}

function parse(bytes: Uint8Array): { json: Gltf; floats: (accessor: number) => Float32Array } {
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length))) as Gltf;
  const start = 28 + length;
  return {
    json,
    floats: (accessor) => {
      const part = json.bufferViews[json.accessors[accessor]!.bufferView]!;
      return new Float32Array(bytes.slice(start + part.byteOffset, start + part.byteOffset + part.byteLength).buffer);
    },
  };
}

const track = ({ json, floats }: ReturnType<typeof parse>, node: number, path: string): Float32Array => {
  const { channels, samplers } = json.animations[0]!;
  return floats(samplers[channels.find((c) => c.target.node === node && c.target.path === path)!.sampler]!.output);
};

/** Turn a vector by a quaternion x, y, z, w. */
function turned([x, y, z, w]: readonly number[], v: Vec): Vec {
  const t = [2 * (y! * v[2] - z! * v[1]), 2 * (z! * v[0] - x! * v[2]), 2 * (x! * v[1] - y! * v[0])];
  return [
    v[0] + w! * t[0]! + y! * t[2]! - z! * t[1]!,
    v[1] + w! * t[1]! + z! * t[0]! - x! * t[2]!,
    v[2] + w! * t[2]! + x! * t[1]! - y! * t[0]!,
  ];
}

describe("towards", () => {
  it("turns +y to any direction, straight down too", () => {
    for (const d of [[1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0.6, -0.8, 0]] as Vec[]) {
      turned(towards(d), [0, 1, 0]).forEach((v, k) => expect(v).toBeCloseTo(d[k as 0], 9));
    }
  });
});

describe("glbOf", () => {
  it("passes the validator of glTF without a word", async () => {
    const report = await validator.validateBytes(glbOf(scene, [[0, 1]], "walk"));
    expect(report.issues.numErrors).toBe(0);
    expect(report.issues.numWarnings).toBe(0);
  });
  it("moves markers as they moved, and hides them where they are absent", () => {
    const file = parse(glbOf(scene, [], "walk"));
    expect(file.json.nodes.map((n) => n.name)).toEqual(["A", "B", "walk"]);
    const [x, size] = [track(file, 1, "translation"), track(file, 0, "scale")];
    expect(x[3 * 30 + 1]).toBeCloseTo(0.3, 6);
    expect(size[3 * 9]).toBeCloseTo(0.009, 9);
    expect(size[3 * 10]).toBeLessThan(1e-5);
    expect(size[3 * 20]).toBeCloseTo(0.009, 9);
    expect([...x].every(Number.isFinite)).toBe(true);
  });
  it("turns up to +y", () => {
    const root = parse(glbOf(scene, [], "walk")).json.nodes[2]!;
    turned(root.rotation!, [0, 0, 1]).forEach((v, k) => expect(v).toBeCloseTo([0, 1, 0][k]!, 9));
  });
  it("lays a rod between its ends", () => {
    const file = parse(glbOf(scene, [[0, 1]], "walk"));
    expect(track(file, 2, "scale")[1]).toBeCloseTo(Math.hypot(1, 0.5), 6);
    expect(track(file, 2, "translation")[0]).toBeCloseTo(0.5, 6);
  });
  it("keeps 2,000 instants of a long recording, and its length", () => {
    const long = sceneWith(["A"], 9001, (_m, p): Vec => [p, 0, 0]);
    const { json } = parse(glbOf(long, [], "long"));
    const times = json.accessors[json.animations[0]!.samplers[0]!.input]!;
    expect(times.count).toBeLessThanOrEqual(2000);
    expect(times.max![0]).toBeGreaterThan(89.9);
  });
  it("is a valid file of nothing", async () => {
    const nothing = sceneWith([], 10, (): Vec => [0, 0, 0]);
    expect((await validator.validateBytes(glbOf(nothing, [], "nothing"))).issues.numErrors).toBe(0);
  });
});
