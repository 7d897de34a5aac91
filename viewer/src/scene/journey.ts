// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { bounds, type Scene } from "./scene.ts";
import { at, isThere } from "./track.ts";
import { add, length, scaled, sub, type Vec } from "./vec.ts";

/** Marks that are there on a point. */
function placesAt(scene: Scene, point: number): Vec[] {
  const all = !scene.isMain.includes(true);
  return scene.names.flatMap((_, m) => ((all || scene.isMain[m]) && isThere(scene.markers, scene.points, m, point) ? [at(scene.markers.x, scene.points, m, point)] : []));
}

/** Middle of what is there; null where nothing is. */
export function middleAt(scene: Scene, point: number): Vec | null {
  const places = placesAt(scene, point);
  return places.length === 0 ? null : scaled(places.reduce((sum, x) => add(sum, x), [0, 0, 0] as Vec), 1 / places.length);
}

/** Smallest and largest coordinates of what is there on a point; of the whole scene where nothing is. */
export function boundsAt(scene: Scene, point: number): [low: Vec, high: Vec] {
  const places = placesAt(scene, point);
  if (places.length === 0) return bounds(scene);
  const of = (pick: (...v: number[]) => number): Vec => [0, 1, 2].map((k) => pick(...places.map((x) => x[k as 0]))) as Vec;
  return [of(Math.min), of(Math.max)];
}

/** Whether the recording reaches so much farther than its markers at an instant that they would look small in it. */
export function goesFar(scene: Scene): boolean {
  if (scene.cameras.length > 0 || scene.plates.length > 0 || scene.points === 0) return false;
  const [low, high] = bounds(scene);
  const sizes: number[] = [];
  for (let i = 0; i < 9; ++i) {
    const [a, b] = boundsAt(scene, Math.floor((i * (scene.points - 1)) / 8));
    sizes.push(length(sub(b, a)));
  }
  sizes.sort((a, b) => a - b);
  return sizes[4]! > 0.05 && length(sub(high, low)) > 2.2 * sizes[4]!;
}
