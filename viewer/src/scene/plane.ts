// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Scene } from "./scene.ts";
import { at, isThere } from "./track.ts";
import { add, cross, dot, scaled, sub, unit, type Vec } from "./vec.ts";

/** The plane that fits a path best, in the sense of the smallest sum of squared distances. */
export interface Plane {
  centre: Vec;
  /** Orthonormal, right-handed: along the longest and the second longest spread, and across the plane. */
  axes: [Vec, Vec, Vec];
  /** Where the path begins and ends along the axes, m from the centre. */
  low: Vec;
  high: Vec;
  /** Distance of the path from the plane, root mean square, m. */
  rms: number;
  samples: number;
}

type Matrix = [Vec, Vec, Vec];

/** Eigenvectors of a symmetric matrix by Jacobi's rotations, the largest eigenvalue first. */
export function eigen(symmetric: Matrix): { values: Vec; vectors: Matrix } {
  const a = symmetric.map((row) => [...row]) as unknown as Matrix;
  const v: Matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let sweep = 0; sweep < 30; ++sweep) {
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]] as const) {
      if (Math.abs(a[p][q]) < 1e-300) continue;
      const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const t = (theta < 0 ? -1 : 1) / (Math.abs(theta) + Math.hypot(theta, 1));
      const c = 1 / Math.hypot(t, 1);
      const s = t * c;
      for (let k = 0; k < 3; ++k) {
        const [x, y] = [a[k]![p]!, a[k]![q]!];
        a[k]![p] = c * x - s * y;
        a[k]![q] = s * x + c * y;
      }
      for (let k = 0; k < 3; ++k) {
        const [x, y] = [a[p]![k]!, a[q]![k]!];
        a[p]![k] = c * x - s * y;
        a[q]![k] = s * x + c * y;
        const [m, n] = [v[k]![p]!, v[k]![q]!];
        v[k]![p] = c * m - s * n;
        v[k]![q] = s * m + c * n;
      }
    }
  }
  const order = [0, 1, 2].sort((i, j) => a[j]![j]! - a[i]![i]!);
  const column = (i: number): Vec => [v[0]![i]!, v[1]![i]!, v[2]![i]!];
  return {
    values: order.map((i) => a[i]![i]!) as Vec,
    vectors: order.map(column) as Matrix,
  };
}

/** Of a marker's path on the points from `first` to `last`; null with fewer than three samples. */
export function planeOf(scene: Scene, marker: number, first: number, last: number): Plane | null {
  const places: Vec[] = [];
  for (let p = first; p <= last; ++p) {
    if (isThere(scene.markers, scene.points, marker, p)) places.push(at(scene.markers.x, scene.points, marker, p));
  }
  if (places.length < 3) return null;
  const centre = scaled(places.reduce((sum, x) => add(sum, x), [0, 0, 0] as Vec), 1 / places.length);
  const spread: Matrix = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  for (const x of places) {
    const d = sub(x, centre);
    for (const i of [0, 1, 2] as const) for (const j of [0, 1, 2] as const) spread[i][j] += d[i] * d[j];
  }
  const { vectors } = eigen(spread);
  const axes: Plane["axes"] = [vectors[0], vectors[1], unit(cross(vectors[0], vectors[1]))];
  const low: Vec = [Infinity, Infinity, Infinity];
  const high: Vec = [-Infinity, -Infinity, -Infinity];
  let squares = 0;
  for (const x of places) {
    const d = sub(x, centre);
    axes.forEach((axis, k) => {
      low[k as 0] = Math.min(low[k as 0], dot(d, axis));
      high[k as 0] = Math.max(high[k as 0], dot(d, axis));
    });
    squares += dot(d, axes[2]) ** 2;
  }
  return { centre, axes, low, high, rms: Math.sqrt(squares / places.length), samples: places.length };
}

/** The eight corners of the box about the path, in the order of their bits along the three axes. */
export const cornersOf = (plane: Plane): Vec[] =>
  [0, 1, 2, 3, 4, 5, 6, 7].map((i) => {
    let x = plane.centre;
    plane.axes.forEach((axis, k) => (x = add(x, axis, (i >> k) & 1 ? plane.high[k as 0] : plane.low[k as 0])));
    return x;
  });
