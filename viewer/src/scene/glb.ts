// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { firstAbsent } from "../states.ts";
import type { BodyMesh } from "./meshes.ts";
import type { Scene } from "./scene.ts";
import { at } from "./track.ts";
import { add, cross, length, sub, unit, type Vec } from "./vec.ts";

/** Keyframes of the animation at most: a viewer loads them all. */
const mostKeys = 2000;
const tiny = 1e-6;
const colours = [["marker", "#0b6583"], ["line", "#9fb0bb"], ["joint", "#7a2a8a"]] as const;
const boneColour = ["bone", "#e4dac6"] as const;

/** An object on the instants of the animation; its size is `tiny` where it is absent. */
interface Track {
  name: string;
  /** Of the file. */
  mesh: number;
  translation: Float32Array;
  rotation: Float32Array | null;
  scale: Float32Array | null;
}

class Buffer {
  readonly views: object[] = [];
  readonly accessors: object[] = [];
  readonly #parts: Uint8Array[] = [];
  #size = 0;

  add(values: Float32Array | Uint16Array, type: "SCALAR" | "VEC3" | "VEC4", target: number | null, bounds = false): number {
    const width = { SCALAR: 1, VEC3: 3, VEC4: 4 }[type];
    const bytes = new Uint8Array(4 * Math.ceil(values.byteLength / 4));
    bytes.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength));
    this.views.push({ buffer: 0, byteOffset: this.#size, byteLength: values.byteLength, ...(target === null ? {} : { target }) });
    const of = (pick: (...v: number[]) => number): number[] =>
      Array.from({ length: width }, (_, k) => {
        let best = values[k] ?? 0;
        for (let i = k; i < values.length; i += width) best = pick(best, values[i]!);
        return best;
      });
    this.accessors.push({
      bufferView: this.views.length - 1,
      componentType: values instanceof Float32Array ? 5126 : 5123,
      count: values.length / width,
      type,
      ...(bounds ? { min: of(Math.min), max: of(Math.max) } : {}),
    });
    this.#parts.push(bytes);
    this.#size += bytes.length;
    return this.accessors.length - 1;
  }

  bytes(): Uint8Array {
    const out = new Uint8Array(this.#size);
    let at = 0;
    for (const part of this.#parts) {
      out.set(part, at);
      at += part.length;
    }
    return out;
  }
}

/** An octahedron of radius 1, and a square rod of radius 1 along y, from -0.5 to 0.5. */
const solids = [
  { positions: [1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1], faces: [2, 4, 0, 2, 0, 5, 2, 5, 1, 2, 1, 4, 3, 0, 4, 3, 5, 0, 3, 1, 5, 3, 4, 1] },
  {
    positions: [1, -0.5, 0, 0, -0.5, 1, -1, -0.5, 0, 0, -0.5, -1, 1, 0.5, 0, 0, 0.5, 1, -1, 0.5, 0, 0, 0.5, -1],
    faces: [0, 4, 1, 1, 4, 5, 1, 5, 2, 2, 5, 6, 2, 6, 3, 3, 6, 7, 3, 7, 0, 0, 7, 4],
  },
] as const;

/** Unit quaternion (x, y, z, w) that turns +y to this direction. */
export function towards(way: Vec): [number, number, number, number] {
  const d = unit(way);
  if (d[1] < -0.999999) return [1, 0, 0, 0];
  const axis = cross([0, 1, 0], d);
  const w = 1 + d[1];
  const norm = Math.hypot(...axis, w);
  return [axis[0] / norm, axis[1] / norm, axis[2] / norm, w / norm];
}

function tracksOf(scene: Scene, sticks: readonly (readonly [number, number])[], keys: readonly number[]): Track[] {
  const { markers, points, names, skeleton } = scene;
  const track = (name: string, solid: 0 | 1, material: number, place: (point: number) => { x: Vec; turn: readonly number[]; size: Vec } | null): Track => {
    const scale = new Float32Array(3 * keys.length);
    const out: Track = { name, mesh: colours.length * solid + material, translation: new Float32Array(3 * keys.length), rotation: solid === 0 ? null : new Float32Array(4 * keys.length), scale };
    let last: Vec = [0, 0, 0];
    keys.forEach((point, k) => {
      const now = place(point);
      if (now !== null) last = now.x;
      out.translation.set(last, 3 * k);
      out.rotation?.set(now?.turn ?? [0, 0, 0, 1], 4 * k);
      scale.set(now?.size ?? [tiny, tiny, tiny], 3 * k);
    });
    return out;
  };
  const marker = (m: number) => (p: number): Vec | null => (markers.states[m * points + p]! < firstAbsent ? at(markers.x, points, m, p) : null);
  const joint = (j: number) => (p: number): Vec | null => (skeleton!.states[j * points + p]! > 0 ? at(skeleton!.centres, points, j, p) : null);
  const dot = (place: (p: number) => Vec | null, r: number) => (p: number) => {
    const x = place(p);
    return x === null ? null : { x, turn: [0, 0, 0, 1], size: [r, r, r] as Vec };
  };
  const rod = (from: (p: number) => Vec | null, to: (p: number) => Vec | null, r: number) => (p: number) => {
    const [a, b] = [from(p), to(p)];
    if (a === null || b === null) return null;
    const way = sub(b, a);
    return { x: add(a, way, 0.5), turn: towards(way), size: [r, Math.max(tiny, length(way)), r] as Vec };
  };
  const bone = (mesh: BodyMesh, i: number): Track => {
    const name = scene.bodies!.names[mesh.body]!;
    const out = { name, mesh: colours.length * solids.length + i, translation: new Float32Array(3 * keys.length), rotation: new Float32Array(4 * keys.length), scale: null };
    keys.forEach((point, k) => {
      out.translation.set(at(scene.bodies!.origin, points, mesh.body, point), 3 * k);
      const [w, x, y, z] = [0, 1, 2, 3].map((n) => mesh.turn[n * points + point]!) as [number, number, number, number];
      const size = Math.hypot(w, x, y, z) || 1;
      out.rotation.set([x / size, y / size, z / size, w / size], 4 * k);
    });
    return out;
  };
  return [
    ...(scene.bodies?.meshes ?? []).map(bone),
    ...names.flatMap((name, m) => (scene.isMain[m] ? [track(name, 0, 0, dot(marker(m), 0.009))] : [])),
    ...sticks.map(([a, b]) => track(`${names[a]!} to ${names[b]!}`, 1, 1, rod(marker(a), marker(b), 0.0045))),
    ...(skeleton?.names ?? []).map((name, j) => track(name, 0, 2, dot(joint(j), 0.012))),
    ...(skeleton?.links ?? []).map(([a, b]) => track(`${skeleton!.names[a]!} to ${skeleton!.names[b]!}`, 1, 2, rod(joint(a), joint(b), 0.007))),
  ];
}

/**
 * Markers, lines, joints and the meshes of bodies of a scene as an animated GLB file, metres, y up. Absent samples shrink to nothing. A long
 * recording keeps 2,000 instants, evenly spread.
 */
export function glbOf(scene: Scene, sticks: readonly (readonly [number, number])[], name: string): Uint8Array {
  const stride = Math.max(1, Math.ceil(scene.points / mostKeys));
  const keys = Array.from({ length: Math.ceil(scene.points / stride) }, (_, i) => i * stride);
  const buffer = new Buffer();
  const meshes = solids.flatMap(({ positions, faces }, mesh) => {
    const position = buffer.add(new Float32Array(positions), "VEC3", 34962, true);
    const indices = buffer.add(new Uint16Array(faces), "SCALAR", 34963);
    return colours.map((_, material) => ({ name: `${mesh === 0 ? "point" : "rod"} ${material}`, primitives: [{ attributes: { POSITION: position }, indices, material }] }));
  });
  const bones = scene.bodies?.meshes ?? [];
  const boneMeshes = bones.map((bone) => ({
    name: scene.bodies!.names[bone.body]!,
    primitives: [
      {
        attributes: { POSITION: buffer.add(bone.places, "VEC3", 34962, true), NORMAL: buffer.add(bone.normals, "VEC3", 34962) },
        indices: buffer.add(bone.corners, "SCALAR", 34963),
        material: colours.length,
      },
    ],
  }));
  const times = buffer.add(Float32Array.from(keys, (p) => (scene.time[p] ?? 0) - (scene.time[0] ?? 0)), "SCALAR", null, true);
  const tracks = tracksOf(scene, sticks, keys);
  const samplers: object[] = [];
  const channels: object[] = [];
  const nodes: object[] = tracks.map((track, i) => {
    const animate = (path: string, values: Float32Array, type: "VEC3" | "VEC4", interpolation: string): void => {
      samplers.push({ input: times, output: buffer.add(values, type, null), interpolation });
      channels.push({ sampler: samplers.length - 1, target: { node: i, path } });
    };
    animate("translation", track.translation, "VEC3", "LINEAR");
    if (track.rotation !== null) animate("rotation", track.rotation, "VEC4", "LINEAR");
    if (track.scale !== null) animate("scale", track.scale, "VEC3", "STEP");
    return { name: track.name, mesh: track.mesh };
  });
  const root = nodes.length;
  nodes.push({ name, rotation: invert(towards(scene.up)), ...(tracks.length > 0 ? { children: tracks.map((_, i) => i) } : {}) });
  const colour = (hex: string): number[] => [1, 3, 5].map((i) => (Number.parseInt(hex.slice(i, i + 2), 16) / 255) ** 2.2);
  const bin = buffer.bytes();
  const json = {
    asset: { version: "2.0", generator: "kinemark" },
    scene: 0,
    scenes: [{ name, nodes: [root] }],
    nodes,
    meshes: [...meshes, ...boneMeshes],
    materials: [...colours, ...(bones.length > 0 ? [boneColour] : [])].map(([of, hex]) => ({ name: of, doubleSided: true, pbrMetallicRoughness: { baseColorFactor: [...colour(hex), 1], metallicFactor: 0, roughnessFactor: 0.9 } })),
    ...(tracks.length > 0 ? { animations: [{ name, samplers, channels }] } : {}),
    accessors: buffer.accessors,
    bufferViews: buffer.views,
    buffers: [{ byteLength: bin.length }],
  };
  return container(new TextEncoder().encode(JSON.stringify(json)), bin);
}

const invert = ([x, y, z, w]: [number, number, number, number]): number[] => [-x, -y, -z, w];

/** Header, JSON padded with spaces, bytes padded with zeros. */
function container(json: Uint8Array, bin: Uint8Array): Uint8Array {
  const round = (n: number): number => 4 * Math.ceil(n / 4);
  const total = 12 + 8 + round(json.length) + 8 + round(bin.length);
  const out = new Uint8Array(total);
  const view = new DataView(out.buffer);
  [0x46546c67, 2, total, round(json.length), 0x4e4f534a].forEach((v, i) => view.setUint32(4 * i, v, true));
  out.fill(0x20, 20, 20 + round(json.length));
  out.set(json, 20);
  const second = 20 + round(json.length);
  view.setUint32(second, round(bin.length), true);
  view.setUint32(second + 4, 0x004e4942, true);
  out.set(bin, second + 8);
  return out;
}
