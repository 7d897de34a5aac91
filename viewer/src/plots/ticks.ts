// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** Round numbers from `low` to `high`, about `count` of them; the range itself where it has no length. */
export function ticks(low: number, high: number, count = 6): number[] {
  if (!(high > low)) return [low];
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = ([1, 2, 5, 10].find((s) => s * power >= raw - 1e-12 * power) ?? 10) * power;
  const out: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) out.push(k * step + 0);
  return out;
}

/** As many decimals as these ticks need. */
export const decimalsFor = (values: readonly number[]): number => {
  const step = values.length > 1 ? Math.abs(values[1]! - values[0]!) : Math.abs(values[0] ?? 1) || 1;
  return Math.min(8, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)));
};
