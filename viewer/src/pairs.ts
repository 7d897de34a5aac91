// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** Words of a side in names of coordinates, right and left. */
const sides: readonly (readonly [right: RegExp, left: string])[] = [
  [/_r$/, "_l"],
  [/_R$/, "_L"],
  [/_right$/i, "_left"],
  [/^r_/, "l_"],
  [/^R_/, "L_"],
  [/^right_/i, "left_"],
  [/^Right(?=[A-Z])/, "Left"],
  [/^R(?=[A-Z][a-z])/, "L"],
];

/** One coordinate of the middle, or the same of both sides; indices, -1: none. */
export interface Pair {
  title: string;
  right: number;
  left: number;
}

/** Coordinates in their order, those of both sides together under the name that they share. */
export function pairsOf(names: readonly string[]): Pair[] {
  const taken = new Set<number>();
  const rightOf = new Map<number, number>();
  names.forEach((name, right) => {
    for (const [pattern, word] of sides) {
      if (!pattern.test(name)) continue;
      const left = names.findIndex((n) => n.toLowerCase() === name.replace(pattern, word).toLowerCase() && n !== name);
      if (left >= 0) {
        rightOf.set(left, right);
        rightOf.set(right, right);
        return;
      }
    }
  });
  return names.flatMap((name, i): Pair[] => {
    if (taken.has(i)) return [];
    const right = rightOf.get(i);
    if (right === undefined) return [{ title: name, right: i, left: -1 }];
    const left = [...rightOf].find(([at, to]) => to === right && at !== right)![0];
    taken.add(left).add(right);
    const pattern = sides.find(([p]) => p.test(names[right]!))![0];
    return [{ title: names[right]!.replace(pattern, ""), right, left }];
  });
}
