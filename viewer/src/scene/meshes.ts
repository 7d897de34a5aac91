// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PackedMeshes } from "../page_types.ts";
import { inflated, unpack } from "./unpack.ts";
import { cross, sub, type Vec } from "./vec.ts";

/** The surface of one body, in the axes of the body. */
export interface BodyMesh {
  /** Which of the bodies. */
  body: number;
  /** 3 x N, m */
  places: Float32Array;
  /** 3 x N, length 1: outward, the mean of the triangles around. */
  normals: Float32Array;
  /** Three corners a triangle. */
  corners: Uint16Array;
  /** 4 x P: unit quaternions w, x, y, z that turn the body into the laboratory. */
  turn: Float32Array;
}

/** Normal of each point: that of the triangles around it, by their areas. */
export function normalsOf(places: Float32Array, corners: Uint16Array): Float32Array {
  const out = new Float32Array(places.length);
  const place = (i: number): Vec => [places[3 * i]!, places[3 * i + 1]!, places[3 * i + 2]!];
  for (let t = 0; t < corners.length; t += 3) {
    const [a, b, c] = [corners[t]!, corners[t + 1]!, corners[t + 2]!];
    const normal = cross(sub(place(b), place(a)), sub(place(c), place(a)));
    for (const i of [a, b, c]) for (const k of [0, 1, 2] as const) out[3 * i + k]! += normal[k];
  }
  for (let i = 0; i < out.length; i += 3) {
    const size = Math.hypot(out[i]!, out[i + 1]!, out[i + 2]!);
    if (size > 0) for (let k = 0; k < 3; ++k) out[i + k]! /= size;
    else out[i + 2] = 1;
  }
  return out;
}

/** Corners of all triangles: each the one before it and a change, lower bytes of all, then upper ones. */
export function unpackCorners(bytes: Uint8Array, triangles: number): Uint16Array {
  if (bytes.length !== 6 * triangles) throw new Error(`a packed mesh holds ${bytes.length} bytes; ${triangles} triangles need ${6 * triangles}`);
  const out = new Uint16Array(3 * triangles);
  let word = 0;
  for (let i = 0; i < out.length; ++i) out[i] = word = (word + bytes[i]! + 256 * bytes[out.length + i]!) & 0xffff;
  return out;
}

const sum = (numbers: readonly number[]): number => numbers.reduce((a, b) => a + b, 0);

export async function unpackMeshes(packed: PackedMeshes, points: number): Promise<BodyMesh[]> {
  const [places, turns, bytes] = await Promise.all([unpack(packed.positions_m), unpack(packed.turn), inflated(packed.corners)]);
  const all = sum(packed.points);
  if (places.length !== 3 * all || turns.length !== 4 * packed.body.length * points) {
    throw new Error(`the space view needs ${all} places and ${packed.body.length} turns on ${points} points`);
  }
  const corners = unpackCorners(bytes, sum(packed.triangles));
  let [point, corner] = [0, 0];
  return packed.body.map((body, i) => {
    const count = packed.points[i]!;
    const own = new Float32Array(3 * count);
    for (let n = 0; n < count; ++n) for (let k = 0; k < 3; ++k) own[3 * n + k] = places[k * all + point + n]!;
    const faces = corners.slice(corner, corner + 3 * packed.triangles[i]!);
    if (faces.some((c) => c >= count)) throw new Error("a packed mesh has corners that are none of its points");
    point += count;
    corner += faces.length;
    return { body, places: own, normals: normalsOf(own, faces), corners: faces, turn: turns.slice(4 * i * points, 4 * (i + 1) * points) };
  });
}

/** Axes of a body on a point, as columns: where its x, y and z point in the laboratory. */
export function axesOf(mesh: BodyMesh, points: number, point: number): [Vec, Vec, Vec] {
  const q = [0, 1, 2, 3].map((k) => mesh.turn[k * points + point]!) as [number, number, number, number];
  const size = Math.hypot(...q) || 1;
  const [w, x, y, z] = q.map((v) => v / size) as [number, number, number, number];
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
}
