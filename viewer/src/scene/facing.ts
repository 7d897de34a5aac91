// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Scene } from "./scene.ts";
import { at, isThere } from "./track.ts";
import { add, cross, dot, floorAxes, length, scaled, sub, type Vec } from "./vec.ts";

/** A name without its subject: "LASI" of "Ann:LASI". */
export const bare = (name: string): string => name.slice(name.lastIndexOf(":") + 1);

/** The name of the same place on the other side, or null: L and R, Left and Right. */
export function otherSide(name: string): string | null {
  const start = name.slice(0, name.lastIndexOf(":") + 1);
  const own = bare(name);
  const words: [RegExp, string][] = [
    [/^L(?=[A-Z0-9._ ])/, "R"],
    [/^R(?=[A-Z0-9._ ])/, "L"],
    [/^Left/, "Right"],
    [/^Right/, "Left"],
    [/^l_/, "r_"],
    [/^r_/, "l_"],
  ];
  for (const [from, to] of words) if (from.test(own)) return start + own.replace(from, to);
  return null;
}

export const isLeft = (name: string): boolean => /^(L(?=[A-Z0-9._ ])|Left|l_)/.test(bare(name));

/** Onto the floor. */
const flat = (v: Vec, up: Vec): Vec => add(v, up, -dot(v, up));

/**
 * Azimuth (as Camera has it) that people face: across the pairs of left and right markers, else the way that the
 * markers go by half a metre or more, else along the first axis of the floor.
 */
export function facing(scene: Scene): number {
  const { names, points, markers, up } = scene;
  const index = new Map(names.map((n, i) => [n, i]));
  const stride = Math.max(1, Math.floor(points / 40));
  let across: Vec = [0, 0, 0];
  for (const [left, name] of names.entries()) {
    const right = isLeft(name) ? index.get(otherSide(name) ?? "") : undefined;
    if (right === undefined) continue;
    for (let p = 0; p < points; p += stride) {
      if (!isThere(markers, points, left, p) || !isThere(markers, points, right, p)) continue;
      across = add(across, sub(at(markers.x, points, right, p), at(markers.x, points, left, p)));
    }
  }
  let ahead = flat(cross(up, across), up);
  if (length(ahead) < 1e-6) ahead = journey(scene);
  if (length(ahead) < 1e-6) return 0;
  const [first, second] = floorAxes(up);
  return Math.atan2(dot(ahead, second), dot(ahead, first));
}

/** From the middle of the markers at first to their middle at last, on the floor; nothing below half a metre. */
function journey(scene: Scene): Vec {
  const middle = (from: number, to: number): Vec => {
    let sum: Vec = [0, 0, 0];
    let count = 0;
    for (let m = 0; m < scene.names.length; ++m) {
      for (let p = from; p < to; p += Math.max(1, Math.floor((to - from) / 50))) {
        if (!isThere(scene.markers, scene.points, m, p)) continue;
        sum = add(sum, at(scene.markers.x, scene.points, m, p));
        ++count;
      }
    }
    return scaled(sum, 1 / Math.max(1, count));
  };
  const part = Math.max(1, Math.floor(scene.points / 10));
  const way = flat(sub(middle(scene.points - part, scene.points), middle(0, part)), scene.up);
  return length(way) >= 0.5 ? way : [0, 0, 0];
}
