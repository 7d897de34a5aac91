// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** Digits that people can read: a real minus, commas between thousands, a dash for what is not known. */
export function number(value: number | null | undefined, decimals = 0): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const text = Math.abs(value).toLocaleString("en-US", {
    minimumFractionDigits: decimals,
    maximumFractionDigits: decimals,
  });
  return value < 0 && Number(text.replaceAll(",", "")) !== 0 ? `−${text}` : text;
}

/** Decimals that suit a unit. */
export const decimalsOf = (unit: "deg" | "m"): number => (unit === "deg" ? 2 : 4);

/** A share as a percentage; never 100 % unless it is all, never 0 % unless it is nothing. */
export function percent(fraction: number | null): string {
  if (fraction === null || !Number.isFinite(fraction)) return "–";
  const decimals = fraction > 0 && fraction < 0.001 ? 2 : 1;
  const value = 100 * fraction;
  if (fraction > 0 && value < 0.01) return "< 0.01 %";
  if (fraction < 1 && value > 99.9) return "> 99.9 %";
  return Number.isInteger(value) ? `${value} %` : `${value.toFixed(decimals)} %`;
}

export function seconds(value: number | null): string {
  return value === null ? "–" : `${number(value, 3)} s`;
}

/** Length of a recording: 6.00 s, 2 min 5 s, 1 h 0 min. */
export function duration(s: number): string {
  if (s < 60) return `${number(s, 2)} s`;
  const whole = Math.round(s);
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  const minutes = Math.round(s / 60);
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

export function bytes(count: number): string {
  if (count < 1000) return `${count} B`;
  const units = ["kB", "MB", "GB", "TB"];
  let value = count / 1000;
  let i = 0;
  while (value >= 999.5 && i < units.length - 1) {
    value /= 1000;
    ++i;
  }
  return `${value.toFixed(value < 10 ? 2 : value < 100 ? 1 : 0)} ${units[i]}`;
}

export const plural = (count: number, one: string, many = `${one}s`): string =>
  `${number(count)} ${count === 1 ? one : many}`;
