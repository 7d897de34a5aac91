// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

export type Key = string | number | null;
export type Direction = "ascending" | "descending";

/** Sorted copy. Unknown keys (null) always come last; equal keys keep their order; names sort as people count. */
export function sorted<T>(rows: readonly T[], key: (row: T) => Key, direction: Direction): T[] {
  const sign = direction === "ascending" ? 1 : -1;
  return [...rows].sort((a, b) => {
    const x = key(a);
    const y = key(b);
    if (x === null || y === null) return (x === null ? 1 : 0) - (y === null ? 1 : 0);
    if (typeof x === "string" || typeof y === "string") {
      return sign * String(x).localeCompare(String(y), "en", { numeric: true });
    }
    return sign * (x - y);
  });
}
