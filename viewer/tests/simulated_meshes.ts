// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PackedBodies, PackedMeshes } from "../src/page_types.ts";
import { deflated } from "./packed.ts";
import { pack } from "./simulated_markers.ts";

export interface Shape {
  /** 3 x N, m */
  places: number[];
  /** Three corners a triangle. */
  corners: number[];
}

/** An ellipsoid about the origin, seen from outside. */
export function ellipsoid([a, b, c]: readonly [number, number, number], around = 24, across = 15): Shape {
  const places: number[] = [];
  const corners: number[] = [];
  for (let i = 0; i < across; ++i) {
    const polar = (Math.PI * (i + 1)) / (across + 1);
    for (let k = 0; k < around; ++k) {
      const turn = (2 * Math.PI * k) / around;
      places.push(a * Math.sin(polar) * Math.cos(turn), b * Math.sin(polar) * Math.sin(turn), c * Math.cos(polar));
    }
  }
  const top = around * across;
  places.push(0, 0, c, 0, 0, -c);
  for (let k = 0; k < around; ++k) {
    const [next, last] = [(k + 1) % around, (across - 1) * around];
    corners.push(top, k, next, top + 1, last + next, last + k);
    for (let i = 0; i + 1 < across; ++i) corners.push(i * around + k, (i + 1) * around + k, (i + 1) * around + next, i * around + k, (i + 1) * around + next, i * around + next);
  }
  return { places, corners };
}

/** Meshes as the program packs them; `turn` of each: w, x, y, z, on every point. */
export function packMeshes(body: number[], shapes: readonly Shape[], turn: readonly (readonly number[][])[]): PackedMeshes {
  const words = shapes.flatMap((m) => m.corners);
  const bytes = new Uint8Array(2 * words.length);
  words.forEach((word, i) => {
    const change = (word - (words[i - 1] ?? 0)) & 0xffff;
    bytes[i] = change & 255;
    bytes[words.length + i] = change >> 8;
  });
  return {
    body,
    points: shapes.map((m) => m.places.length / 3),
    triangles: shapes.map((m) => m.corners.length / 3),
    positions_m: pack([0, 1, 2].map((k) => shapes.flatMap((m) => m.places.filter((_, i) => i % 3 === k))), 1e-4),
    corners: deflated(bytes),
    turn: pack(turn.flat(), 5e-4),
  };
}

/** Where the mesh of simulatedBodies() is in a frame, m. */
export const boneOf = (frame: number): [number, number, number] => [-0.5, 0.35 + 0.0005 * frame, 0.8];

/** Two bodies: one with a mesh, 0.1 by 0.3 by 0.1 m, that turns about x, and a plain one. y is up. */
export function simulatedBodies(frames: number): PackedBodies {
  const line = (of: (f: number) => number): number[] => Array.from({ length: frames }, (_, f) => of(f));
  const places = (lift: number): number[][] => [...[0, 1, 2].map((k) => line((f) => boneOf(f)[k]!)), line(() => 0.6), line(() => 0.9 + lift), line(() => 0.2)];
  const half = (f: number): number => (0.5 * Math.PI * f) / frames;
  return {
    names: ["bone", "plain"],
    mass_kg: [0, 4],
    origin_m: pack(places(0), 1e-4),
    end_m: pack(places(0.4), 1e-4),
    meshes: packMeshes([0], [ellipsoid([0.05, 0.15, 0.05])], [[line((f) => Math.cos(half(f))), line((f) => Math.sin(half(f))), line(() => 0), line(() => 0)]]),
    meshes_note: "1 body drawn from the model's meshes",
  };
}
