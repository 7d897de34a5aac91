// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
export type Vec = [x: number, y: number, z: number];

export const add = (a: Vec, b: Vec, k = 1): Vec => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
export const sub = (a: Vec, b: Vec): Vec => add(a, b, -1);
export const scaled = (a: Vec, k: number): Vec => [k * a[0], k * a[1], k * a[2]];
export const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec, b: Vec): Vec => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Vec): number => Math.hypot(a[0], a[1], a[2]);
export const distance = (a: Vec, b: Vec): number => length(sub(a, b));
export const unit = (a: Vec): Vec => scaled(a, 1 / (length(a) || 1));

/** Two directions on the floor, so that (first, second, up) is right-handed; the first is an axis of the laboratory. */
export function floorAxes(up: Vec): [first: Vec, second: Vec] {
  const vertical = Math.abs(up[0]) > 0.7 ? 0 : Math.abs(up[1]) > 0.7 ? 1 : 2;
  const axis: Vec = vertical === 2 ? [1, 0, 0] : vertical === 1 ? [0, 0, 1] : [0, 1, 0];
  const first = unit(add(axis, up, -dot(axis, up)));
  return [first, cross(up, first)];
}
