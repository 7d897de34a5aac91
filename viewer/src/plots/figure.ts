// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { decimalsOfStep, precisionWords, type Precision } from "../curves.ts";
import { number } from "../format.ts";
import { csv } from "../save.ts";

export interface FigureLine {
  /** What it is, for the heading of its numbers; not there: the only one, or one of several without names. */
  name?: string;
  colour: string;
  width: number;
  values: readonly (number | null | undefined)[];
}

/** A plot over time as numbers: what is drawn, in which range. */
export interface Figure {
  title: string;
  unit: string;
  x: ArrayLike<number>;
  range: readonly [from: number, to: number];
  height: readonly [low: number, high: number];
  /** Two standard deviations to each side of a line; `of` is its index among the lines. */
  bands: { colour: string; upper: readonly (number | null | undefined)[]; lower: readonly (number | null | undefined)[]; of?: number }[];
  lines: FigureLine[];
  striped: readonly (readonly [from: number, to: number])[];
  /** What the page holds of the result; not there: all of it. */
  precision?: Precision;
}

/** Round numbers inside a range, about `count` of them. */
export function ticks(low: number, high: number, count: number): number[] {
  const rough = (high - low) / Math.max(1, count);
  if (!(rough > 0) || !Number.isFinite(rough)) return [];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough * 0.999)!;
  const out: number[] = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(i * step);
  return out;
}

const escaped = (text: string): string =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");

const texts = (values: readonly number[]): string[] => {
  const step = values.length > 1 ? values[1]! - values[0]! : 1;
  const decimals = Math.min(6, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  return values.map((v) => number(v, decimals));
};

/** The figure as a drawing for a paper: black axes on white, 720 by 300. */
export function figureSvg(figure: Figure): string {
  const [width, height] = [720, 300];
  const [left, right, top, bottom] = [70, 15, 34, 46];
  const [from, to] = figure.range;
  const [low, high] = figure.height;
  const x = (t: number): number => left + ((t - from) / (to - from || 1)) * (width - left - right);
  const y = (v: number): number => height - bottom - ((v - low) / (high - low || 1)) * (height - top - bottom);
  const inside = (i: number): boolean => figure.x[i]! >= from - 1e-9 && figure.x[i]! <= to + 1e-9;
  const path = (values: FigureLine["values"]): string => {
    let d = "";
    let pen = "M";
    for (let i = 0; i < figure.x.length; ++i) {
      const v = values[i];
      if (v === null || v === undefined || !inside(i)) {
        pen = "M";
        continue;
      }
      d += `${pen}${x(figure.x[i]!).toFixed(2)} ${y(v).toFixed(2)}`;
      pen = "L";
    }
    return d;
  };
  const area = (upper: FigureLine["values"], lower: FigureLine["values"]): string => {
    let d = "";
    for (let i = 0; i < figure.x.length; ++i) {
      const known = (k: number): boolean => inside(k) && k < figure.x.length && typeof upper[k] === "number" && typeof lower[k] === "number";
      if (!known(i)) continue;
      const first = i;
      while (known(i + 1)) ++i;
      const there = Array.from({ length: i - first + 1 }, (_, k) => `${x(figure.x[first + k]!).toFixed(2)} ${y(upper[first + k]!).toFixed(2)}`);
      const back = Array.from({ length: i - first + 1 }, (_, k) => `${x(figure.x[i - k]!).toFixed(2)} ${y(lower[i - k]!).toFixed(2)}`);
      d += `M${[...there, ...back].join("L")}Z`;
    }
    return d;
  };
  const parts: string[] = [
    `<rect width="${width}" height="${height}" fill="#ffffff"/>`,
    `<defs><clipPath id="in"><rect x="${left}" y="${top}" width="${width - left - right}" height="${height - top - bottom}"/></clipPath>` +
      `<pattern id="stripes" width="6" height="6" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><path d="M0 0V6" stroke="#b3bec6" stroke-width="1.5"/></pattern></defs>`,
    `<text x="${left}" y="20" font-weight="600">${escaped(figure.title)}</text>`,
  ];
  for (const [a, b] of figure.striped) {
    const [x0, x1] = [Math.max(left, x(a)), Math.min(width - right, x(b))];
    if (x1 > x0) parts.push(`<rect x="${x0.toFixed(2)}" y="${top}" width="${(x1 - x0).toFixed(2)}" height="${height - top - bottom}" fill="url(#stripes)"/>`);
  }
  const across = ticks(from, to, 8);
  texts(across).forEach((text, i) => {
    const at = x(across[i]!).toFixed(2);
    parts.push(`<path d="M${at} ${height - bottom}v5" stroke="#1b2730"/><text x="${at}" y="${height - bottom + 18}" text-anchor="middle">${text}</text>`);
  });
  const upwards = ticks(low, high, 5);
  texts(upwards).forEach((text, i) => {
    const at = y(upwards[i]!).toFixed(2);
    parts.push(`<path d="M${left - 5} ${at}h5" stroke="#1b2730"/><path d="M${left} ${at}H${width - right}" stroke="#e6ebee"/><text x="${left - 8}" y="${at}" dy="4" text-anchor="end">${text}</text>`);
  });
  for (const band of figure.bands) parts.push(`<path clip-path="url(#in)" d="${area(band.upper, band.lower)}" fill="${escaped(band.colour)}"/>`);
  for (const line of figure.lines) {
    const d = path(line.values);
    if (d !== "") parts.push(`<path clip-path="url(#in)" d="${d}" fill="none" stroke="${escaped(line.colour)}" stroke-width="${line.width}" stroke-linejoin="round"/>`);
  }
  parts.push(
    `<path d="M${left} ${top}V${height - bottom}H${width - right}" fill="none" stroke="#1b2730"/>`,
    `<text x="${(left + width - right) / 2}" y="${height - 8}" text-anchor="middle">time (s)</text>`,
    `<text transform="translate(14 ${(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">${escaped(figure.unit)}</text>`,
  );
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="Helvetica, Arial, sans-serif" font-size="12" fill="#1b2730">${parts.join("")}</svg>\n`;
}

/** Standard deviation that a band of two of them to each side shows; empty where there is none. */
function deviationText({ upper, lower }: Figure["bands"][number], i: number): string {
  const [high, low] = [upper[i], lower[i]];
  return typeof high === "number" && typeof low === "number" ? String(Number(((high - low) / 4).toPrecision(3))) : "";
}

/** The numbers of a figure, a row an instant: each line, and its SD where a band shows one; what the page holds of them stands in the heading. */
export function figureCsv(figure: Figure): string {
  const { step = null } = figure.precision ?? {};
  const held = figure.precision === undefined ? "" : precisionWords(figure.precision, "");
  const text = (v: number): string => String(Number(step === null ? v.toPrecision(9) : v.toFixed(decimalsOfStep(step))));
  // What has no value has no column.
  const columns = figure.lines.flatMap((line, i) => (line.values.some((v) => typeof v === "number") ? [{ line, band: figure.bands.find((b) => b.of === i) }] : []));
  const heading = ["time (s)", ...columns.flatMap(({ line, band }, i) => {
    const name = line.name === undefined ? `${figure.unit}${i === 0 ? "" : ` ${i + 1}`}` : `${figure.unit}, ${line.name}`;
    return [`${name}${held === "" ? "" : `, ${held}`}`, ...(band === undefined ? [] : [`SD of ${name}`])];
  })];
  const rows: string[][] = [];
  for (let i = 0; i < figure.x.length; ++i) {
    if (figure.x[i]! < figure.range[0] - 1e-9 || figure.x[i]! > figure.range[1] + 1e-9) continue;
    const value = (v: number | null | undefined): string => (typeof v === "number" ? text(v) : "");
    rows.push([String(Number(figure.x[i]!.toFixed(9))), ...columns.flatMap(({ line, band }) => [value(line.values[i]), ...(band === undefined ? [] : [deviationText(band, i)])])]);
  }
  return csv([heading, ...rows]);
}
