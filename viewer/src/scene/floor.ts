// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { bounds, type Scene } from "./scene.ts";
import { add, dot, floorAxes, scaled, type Vec } from "./vec.ts";

/** The ground that things stand on, with lines every half metre. */
export interface Floor {
  axes: [first: Vec, second: Vec];
  up: Vec;
  /** Height along `up`, m. */
  height: number;
  /** Along the two axes, m; multiples of `spacing`. */
  low: [number, number];
  high: [number, number];
  spacing: number;
  /** Where the axes are drawn: a corner of the floor. */
  origin: Vec;
  /** The place on the floor under x, so much above it. */
  below: (x: Vec, above: number) => Vec;
}

/** At the plates, or at 0 where the markers begin not far above it, else just below them. */
export function floorHeight(scene: Scene): number {
  const [low, high] = bounds(scene);
  const vertical = (v: Vec): number => dot(v, scene.up);
  const lowest = Math.min(vertical(low), vertical(high));
  const heights = scene.plates.flat().map(vertical);
  if (heights.length > 0) return Math.min(...heights);
  return lowest > -0.05 && lowest < 0.3 ? 0 : lowest - 0.02;
}

export function floorOf(scene: Scene): Floor {
  const axes = floorAxes(scene.up);
  const [low, high] = bounds(scene);
  const height = floorHeight(scene);
  const ends = [low, high, ...scene.plates.flat()];
  const reach = axes.map((axis) => {
    const along = ends.map((x) => dot(x, axis));
    return [Math.min(...along), Math.max(...along)] as const;
  });
  const size = Math.max(...reach.map(([a, b]) => b - a), 0.5);
  const spacing = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10].find((s) => size / s <= 16) ?? 10 ** Math.ceil(Math.log10(size / 16));
  const margin = 0.12 * size;
  const floorLow = reach.map(([a]) => spacing * Math.floor((a - margin) / spacing)) as [number, number];
  const floorHigh = reach.map(([, b]) => spacing * Math.ceil((b + margin) / spacing)) as [number, number];
  const place = (a: number, b: number): Vec => add(add(scaled(axes[0], a), axes[1], b), scene.up, height);
  return {
    axes,
    up: scene.up,
    height,
    low: floorLow,
    high: floorHigh,
    spacing,
    origin: place(floorLow[0], floorLow[1]),
    below: (x, above) => add(x, scene.up, height + above - dot(x, scene.up)),
  };
}

/** Ends of the lines of a floor, and of each end whether its line is one of every second or an edge. */
export function floorLines(floor: Floor): { positions: number[]; strong: boolean[] } {
  const positions: number[] = [];
  const strong: boolean[] = [];
  const place = (a: number, b: number): Vec => add(add(scaled(floor.axes[0], a), floor.axes[1], b), floor.up, floor.height);
  for (const k of [0, 1] as const) {
    const count = Math.round((floor.high[k] - floor.low[k]) / floor.spacing);
    const [from, to] = [floor.low[1 - k]!, floor.high[1 - k]!];
    for (let i = 0; i <= count; ++i) {
      const v = floor.low[k] + i * floor.spacing;
      positions.push(...(k === 0 ? [...place(v, from), ...place(v, to)] : [...place(from, v), ...place(to, v)]));
      const edge = i === 0 || i === count || Math.round(v / floor.spacing) % 2 === 0;
      strong.push(edge, edge);
    }
  }
  return { positions, strong };
}
