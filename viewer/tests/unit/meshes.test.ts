// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PackedMeshes } from "../../src/page_types.ts";
import validator from "gltf-validator";
import { Scene as Stage } from "three";
import { describe, expect, it } from "vitest";
import type { BodyMesh } from "../../src/scene/meshes.ts";
import { length, type Vec } from "../../src/scene/vec.ts";
import { install } from "../fake_dom.ts";
import { sceneWith } from "../scene_with.ts";
import { packMeshes } from "../simulated_meshes.ts";

install();
const { axesOf, normalsOf, unpackCorners, unpackMeshes } = await import("../../src/scene/meshes.ts");
const { Skins } = await import("../../src/scene/skins.ts");
const { glbOf } = await import("../../src/scene/glb.ts");
const { bodyFacts } = await import("../../src/sections/space_parts.ts");

/** A box of these half sizes, twelve triangles seen from outside. */
function box(half: Vec): { places: Float32Array; corners: Uint16Array } {
  const places = new Float32Array(24);
  for (let i = 0; i < 8; ++i) [1, 2, 4].forEach((bit, k) => (places[3 * i + k] = (i & bit ? 1 : -1) * half[k as 0]));
  return { places, corners: Uint16Array.from([0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5]) };
}

const half = Math.SQRT1_2;

/** A box that turns a quarter about z from the first to the second point. */
function turning(): BodyMesh {
  const { places, corners } = box([1, 2, 3]);
  return { body: 1, places, corners, normals: normalsOf(places, corners), turn: Float32Array.from([1, half, 0, 0, 0, 0, 0, half]) };
}

const withMesh = (mesh: BodyMesh, note = ""): ReturnType<typeof sceneWith> =>
  sceneWith(["A"], 2, () => [0, 0, 0], {
    bodies: {
      names: ["plain", "bone"], massKg: [1, 0], origin: Float32Array.from([0, 0, 0, 0, 0, 0, 10, 10, 20, 20, 30, 40]), end: new Float32Array(12), meshes: [mesh], meshesNote: note,
    },
  });

/** As the program writes them. */
const packed = (meshes: { places: Float32Array; corners: Uint16Array }[], turn: number[][]): PackedMeshes =>
  packMeshes(meshes.map((_, i) => i), meshes.map((m) => ({ places: [...m.places], corners: [...m.corners] })), [turn]);

describe("meshes of bodies", () => {
  it("come back from what is packed, each with its own points and corners", async () => {
    const [a, b] = [box([1, 2, 3]), box([0.1, 0.1, 0.5])];
    const meshes = await unpackMeshes(packed([a, b], [[1, 1], [0, 0], [0, 0], [0, 0], [half, 0], [0, 1], [half, 0], [0, 0]]), 2);
    expect(meshes.length).toBe(2);
    for (const [mesh, made] of [[meshes[0]!, a], [meshes[1]!, b]] as const) {
      expect(mesh.corners).toEqual(made.corners);
      mesh.places.forEach((v, i) => expect(v).toBeCloseTo(made.places[i]!, 3));
    }
    expect(axesOf(meshes[1]!, 2, 1)[0][0]).toBeCloseTo(1, 3);
    expect(axesOf(meshes[1]!, 2, 1)[2][2]).toBeCloseTo(-1, 3);
  });
  it("are refused where they lie about their size or their corners", async () => {
    const good = packed([box([1, 1, 1])], [[1], [0], [0], [0]]);
    await expect(unpackMeshes({ ...good, points: [7] }, 1)).rejects.toThrow("places");
    await expect(unpackMeshes({ ...good, triangles: [13] }, 1)).rejects.toThrow("triangles");
    await expect(unpackMeshes(good, 2)).rejects.toThrow("turns");
    const wrong = box([1, 1, 1]);
    wrong.corners[5] = 8;
    await expect(unpackMeshes(packed([wrong], [[1], [0], [0], [0]]), 1)).rejects.toThrow("none of its points");
    expect(() => unpackCorners(new Uint8Array(5), 1)).toThrow("6");
  });
  it("have normals that point outwards, of length 1", () => {
    const { places, corners } = box([1, 1, 1]);
    const normals = normalsOf(places, corners);
    for (let i = 0; i < 24; i += 3) {
      const n: Vec = [normals[i]!, normals[i + 1]!, normals[i + 2]!];
      expect(length(n)).toBeCloseTo(1, 6);
      expect(n[0] * places[i]! + n[1] * places[i + 1]! + n[2] * places[i + 2]!).toBeGreaterThan(0.9);
    }
  });
  it("stand where their bodies stand, turned as they are, in one mesh", () => {
    const stage = new Stage();
    const skins = new Skins(stage, withMesh(turning()));
    skins.put(1, true);
    expect(stage.children.length).toBe(1);
    const position = skins.mesh.geometry.getAttribute("position");
    // Corner 7, at (1, 2, 3) of the body: a quarter about z makes it (-2, 1, 3), at the body's place (10, 20, 40).
    expect(position.getX(7)).toBeCloseTo(8, 5);
    expect(position.getY(7)).toBeCloseTo(21, 5);
    expect(position.getZ(7)).toBeCloseTo(43, 5);
    skins.put(0, true);
    expect(position.getX(7)).toBeCloseTo(11, 5);
    skins.put(0, false);
    expect(skins.mesh.visible).toBe(false);
  });
  it("go into the GLB as bones that turn, to the validator's content", async () => {
    const bytes = glbOf(withMesh(turning()), [], "trial");
    const report = await validator.validateBytes(bytes);
    expect([report.issues.numErrors, report.issues.numWarnings]).toEqual([0, 0]);
    const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + new DataView(bytes.buffer).getUint32(12, true)))) as { nodes: { name: string; mesh?: number }[]; meshes: { name: string; primitives: { attributes: object; material: number }[] }[]; materials: { name: string }[] };
    const bone = json.nodes.find((n) => n.name === "bone")!;
    expect(json.meshes[bone.mesh!]!.name).toBe("bone");
    expect(Object.keys(json.meshes[bone.mesh!]!.primitives[0]!.attributes)).toEqual(["POSITION", "NORMAL"]);
    expect(json.materials[json.meshes[bone.mesh!]!.primitives[0]!.material]!.name).toBe("bone");
  });
  it("are told in words", () => {
    const bodies = withMesh(turning(), "1 body drawn from the model's meshes").bodies!;
    expect(bodyFacts(bodies).join("; ")).toBe("1 body drawn from the model's meshes; 1 body is an ellipsoid of the model's mass at 1,000 kg/m³, not its shape");
    expect(bodyFacts({ ...bodies, meshes: [], meshesNote: "" })).toEqual(["", "bodies are ellipsoids of the model's masses at 1,000 kg/m³, not its shape"]);
    expect(bodyFacts(null)).toEqual([]);
  });
});
