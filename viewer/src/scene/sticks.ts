// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { bare, isLeft, otherSide } from "./facing.ts";
import type { Scene } from "./scene.ts";
import { at, isThere } from "./track.ts";
import { distance } from "./vec.ts";

/** Two markers that a line joins. */
export type Stick = readonly [from: number, to: number];

/** Names of the conventional gait marker set (Davis et al. 1991; Kadaba et al. 1990) and lines between them. */
const conventional: readonly (readonly [string, string])[] = [
  ["LFHD", "RFHD"], ["RFHD", "RBHD"], ["RBHD", "LBHD"], ["LBHD", "LFHD"],
  ["C7", "CLAV"], ["CLAV", "STRN"], ["STRN", "T10"], ["T10", "C7"],
  ["LASI", "RASI"], ["RASI", "RPSI"], ["RPSI", "LPSI"], ["LPSI", "LASI"],
  ["LASI", "SACR"], ["RASI", "SACR"],
  ...["L", "R"].flatMap((s): [string, string][] => [
    [`${s}SHO`, "CLAV"], [`${s}SHO`, "C7"], [`${s}SHO`, `${s}ELB`], [`${s}ELB`, `${s}WRA`], [`${s}ELB`, `${s}WRB`],
    [`${s}WRA`, `${s}WRB`], [`${s}WRA`, `${s}FIN`], [`${s}WRB`, `${s}FIN`],
    [`${s}ASI`, `${s}KNE`], [`${s}KNE`, `${s}ANK`], [`${s}ANK`, `${s}HEE`], [`${s}HEE`, `${s}TOE`], [`${s}TOE`, `${s}ANK`],
  ]),
];
const leastConventional = 10;

/** A distance that changes no more than this is one of a segment, soft tissue included. */
const mostSpread = 0.008;
const mostLength = 0.6;
const looks = 150;

/**
 * Lines that make a body of points: of the conventional gait set where the names are of it, otherwise the fewest
 * that join markers whose distance stays the same. None where nothing moves: then no distance tells.
 */
export function sticks(scene: Scene): Stick[] {
  const named = areConventional(scene.names) ? namedSticks(scene.names) : [];
  const joined = new Set(named.flat());
  const main = scene.names.filter((_, m) => scene.isMain[m]).length;
  return 2 * joined.size > main ? named : rigidSticks(scene, named);
}

/** Enough names are of the conventional gait set. */
export const areConventional = (names: readonly string[]): boolean => namedSticks(names).length >= leastConventional;

/** Sticks of the conventional set, for every subject of the recording. */
export function namedSticks(names: readonly string[]): Stick[] {
  const subjects = new Map<string, Map<string, number>>();
  for (const [m, name] of names.entries()) {
    const own = bare(name);
    const subject = name.slice(0, name.length - own.length);
    const known = subjects.get(subject) ?? new Map<string, number>();
    known.set(own.toUpperCase(), m);
    subjects.set(subject, known);
  }
  return [...subjects.values()].flatMap((known) =>
    conventional.flatMap(([a, b]): Stick[] => {
      const from = known.get(a);
      const to = known.get(b);
      return from === undefined || to === undefined ? [] : [[from, to]];
    }),
  );
}

interface Pair {
  a: number;
  b: number;
  mean: number;
  spread: number;
}

function rigidSticks(scene: Scene, known: readonly Stick[]): Stick[] {
  const { points, names, markers } = scene;
  const usable = names.map((_, m) => m).filter((m) => scene.isMain[m]);
  if (usable.length > 250) return [...known];
  const stride = Math.max(1, Math.floor(points / looks));
  const pairs: Pair[] = [];
  const spreads: number[] = [];
  for (const [i, a] of usable.entries()) {
    for (const b of usable.slice(i + 1)) {
      let n = 0;
      let mean = 0;
      let squares = 0;
      for (let p = 0; p < points; p += stride) {
        if (!isThere(markers, points, a, p) || !isThere(markers, points, b, p)) continue;
        const d = distance(at(markers.x, points, a, p), at(markers.x, points, b, p));
        ++n;
        const off = d - mean;
        mean += off / n;
        squares += off * (d - mean);
      }
      if (n < 10) continue;
      const spread = Math.sqrt(squares / n);
      spreads.push(spread);
      if (spread <= mostSpread && mean <= mostLength && mean > 1e-3) pairs.push({ a, b, mean, spread });
    }
  }
  spreads.sort((x, y) => x - y);
  if ((spreads[Math.floor(0.75 * spreads.length)] ?? 0) < 0.01) return [...known];
  return forest(pairs, names, known);
}

/** The cheapest lines that join what can be joined (Kruskal 1956): rigid and short ones first. */
function forest(pairs: Pair[], names: readonly string[], known: readonly Stick[]): Stick[] {
  const cost = (p: Pair): number => p.spread + 0.02 * p.mean + (sidesDiffer(names[p.a]!, names[p.b]!) ? 0.004 : 0);
  const root = names.map((_, m) => m);
  const find = (m: number): number => {
    while (root[m] !== m) m = root[m] = root[root[m]!]!;
    return m;
  };
  const out: Stick[] = [...known];
  for (const [a, b] of known) root[find(a)] = find(b);
  for (const { a, b } of [...pairs].sort((p, q) => cost(p) - cost(q))) {
    if (find(a) === find(b)) continue;
    root[find(a)] = find(b);
    out.push([a, b]);
  }
  return out;
}

/** A left and a right place that are not the same one of the two sides. */
const sidesDiffer = (a: string, b: string): boolean =>
  otherSide(a) !== null && otherSide(b) !== null && isLeft(a) !== isLeft(b) && otherSide(a) !== b;
