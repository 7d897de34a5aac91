// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CoordinateSeries } from "../decode.ts";
import { columnRange, extremes, firstAtOrAfter, shareAbove0 } from "../downsample.ts";
import { fitCanvas } from "../dom.ts";
import { hatch, palette } from "../theme.ts";
import { yRange } from "./time_plot.ts";
import type { TimeRange } from "../view.ts";

/** One coordinate in the size of a stamp: line, +-2 SD band, hatched where it is not determined. */
export function drawSmallMultiple(
  canvas: HTMLCanvasElement,
  series: CoordinateSeries,
  time: Float64Array,
  range: TimeRange,
  width: number,
  height: number,
): void {
  const pen = fitCanvas(canvas, width, height);
  const first = firstAtOrAfter(time, range[0] - 1e-9);
  const last = Math.max(first + 1, firstAtOrAfter(time, range[1] + 1e-9));
  const columns = Math.max(1, Math.min(Math.floor(width), last - first));
  const columnWidth = width / columns;
  const dense = last - first > 8 * columns;

  // Per column: middle of the line and the outer edges of line and band.
  const lows = new Float64Array(columns);
  const highs = new Float64Array(columns);
  const middles = new Float64Array(columns);
  const sds = new Float64Array(columns);
  pen.fillStyle = hatch(pen, 1);
  for (let c = 0; c < columns; ++c) {
    const [from, to] = columnRange(first, last, columns, c);
    const [low, high] = extremes(series.value, from, to);
    const sd = series.sd === null ? 0 : extremes(series.sd, from, to)[1];
    middles[c] = (low + high) / 2;
    sds[c] = Number.isFinite(sd) ? 2 * sd : 0;
    lows[c] = low;
    highs[c] = high;
    const share = series.undetermined === null ? 0 : shareAbove0(series.undetermined, from, to);
    if (share > 0) {
      pen.globalAlpha = 0.25 + 0.75 * share;
      pen.fillRect(c * columnWidth, 0, columnWidth + 0.5, height);
    }
  }
  pen.globalAlpha = 1;
  const [bottom] = extremes(lows.map((low, c) => low - sds[c]!), 0, columns);
  const [, top] = extremes(highs.map((high, c) => high + sds[c]!), 0, columns);
  const [yLow, yHigh] = yRange(bottom, top, false);
  const y = (value: number): number => height - 2 - ((value - yLow) / (yHigh - yLow)) * (height - 4);
  const x = (column: number): number => (column + 0.5) * columnWidth;

  for (let c = 0; c < columns; ++c) {
    if (Number.isNaN(middles[c]!)) continue;
    const from = c;
    while (c < columns && !Number.isNaN(middles[c]!)) ++c;
    pen.fillStyle = palette().band;
    pen.beginPath();
    for (let k = from; k < c; ++k) pen.lineTo(x(k), y(highs[k]! + sds[k]!));
    for (let k = c - 1; k >= from; --k) pen.lineTo(x(k), y(lows[k]! - sds[k]!));
    pen.fill();
    if (dense) {
      pen.fillStyle = palette().dense;
      pen.beginPath();
      for (let k = from; k < c; ++k) pen.lineTo(x(k), y(highs[k]!));
      for (let k = c - 1; k >= from; --k) pen.lineTo(x(k), y(lows[k]!));
      pen.fill();
      // The edge shows where the values hardly differ.
      pen.strokeStyle = palette().dense;
      pen.lineWidth = 1;
      pen.stroke();
      continue;
    }
    pen.strokeStyle = palette().line;
    pen.lineWidth = 1.4;
    pen.lineJoin = "round";
    pen.beginPath();
    for (let k = from; k < c; ++k) {
      pen.lineTo(x(k), y(lows[k]!));
      if (highs[k] !== lows[k]) pen.lineTo(x(k), y(highs[k]!));
    }
    if (c === from + 1) pen.lineTo(x(from) + 1, y(middles[from]!));
    pen.stroke();
  }
}
