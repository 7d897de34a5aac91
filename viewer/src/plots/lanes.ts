// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el, fitCanvas } from "../dom.ts";
import { number, seconds } from "../format.ts";
import { onThemeChange, palette } from "../theme.ts";
import type { TimeRange, View } from "../view.ts";
import { TimeLine } from "./time_line.ts";

/** Spikes of a unit, counted in bins. */
export interface UnitRow {
  id: string;
  spikes: number;
  counts: Uint8Array;
}

/** A channel of field potentials: codes of the least and largest value in each bin, 255 where none is. */
export interface FieldRow {
  name: string;
  unit: string;
  startS: number;
  binS: number;
  least: number;
  step: number;
  low: Uint8Array;
  high: Uint8Array;
}

export interface TrialSpan {
  label: string;
  startS: number;
  stopS: number;
}

export interface Lanes {
  startS: number;
  binS: number;
  units: readonly UnitRow[];
  trials: readonly TrialSpan[];
  fields: readonly FieldRow[];
}

export const noSample = 255;
const fieldHeight = 44;
const trialHeight = 18;
const axisHeight = 22;
const gap = 8;

/** Height of a unit's row: hundreds of units fit a screen. */
export const rowHeight = (units: number): number => Math.max(2, Math.min(12, Math.floor(480 / Math.max(1, units))));

/** Bins [first, last) that [from, to] touches. */
export function binsIn(from: number, to: number, startS: number, binS: number, bins: number): [first: number, last: number] {
  const first = Math.min(bins, Math.max(0, Math.floor((from - startS) / binS)));
  const last = Math.min(bins, Math.max(first, Math.ceil((to - startS) / binS)));
  return [first, last];
}

/** The index of the trial at a time, or -1. */
export const trialAt = (trials: readonly TrialSpan[], time: number): number => trials.findIndex((t) => t.startS <= time && time <= t.stopS);

/** Trials, a raster of units and field potentials under one axis of time. */
export class LanePlot {
  readonly canvas = el("canvas", { role: "img", "aria-label": "Raster of spikes: a row per unit, time to the right; field potentials below" });
  readonly readout = el("p", { class: "readout", id: "neural-readout" });
  readonly #pointed = new TimeLine("pointed");
  readonly #asked = new TimeLine("asked");
  #gutter = 70;
  #width = 600;
  #drawn: TimeRange | null = null;

  constructor(
    readonly box: HTMLElement,
    readonly view: View,
    readonly lanes: Lanes,
  ) {
    box.append(this.canvas, this.#pointed.node, this.#asked.node);
    this.canvas.addEventListener("mousemove", (e) => this.#point(e));
    this.canvas.addEventListener("mouseleave", () => view.set({ pointer: null }));
    this.canvas.addEventListener("click", (e) => view.set({ focus: this.#timeAt(e.offsetX) }));
    new ResizeObserver(() => this.draw()).observe(box);
    onThemeChange(() => this.draw());
    view.onChange(() => {
      if (view.range === this.#drawn) this.#putLines();
      else this.draw();
      this.#read();
    });
    this.#read();
  }

  get #row(): number {
    return rowHeight(this.lanes.units.length);
  }
  get #rasterTop(): number {
    return this.lanes.trials.length > 0 ? trialHeight + 4 : 4;
  }
  get #fieldTop(): number {
    const { units } = this.lanes;
    return this.#rasterTop + units.length * this.#row + (units.length > 0 ? gap : 0);
  }
  get #height(): number {
    return this.#fieldTop + this.lanes.fields.length * fieldHeight + axisHeight;
  }

  #timeAt(x: number): number {
    const [from, to] = this.view.range;
    const share = (x - this.#gutter) / (this.#width - this.#gutter);
    return from + Math.min(1, Math.max(0, share)) * (to - from);
  }

  #xOf(time: number): number {
    const [from, to] = this.view.range;
    return this.#gutter + ((time - from) / (to - from)) * (this.#width - this.#gutter);
  }

  #pointedRow = -1;

  #point(event: MouseEvent): void {
    const row = Math.floor((event.offsetY - this.#rasterTop) / this.#row);
    this.#pointedRow = row >= 0 && row < this.lanes.units.length ? row : -1;
    this.view.set({ pointer: this.#timeAt(event.offsetX) });
  }

  /** What lies at the time under the pointer, or that was asked for. */
  #read(): void {
    const time = this.view.pointer ?? this.view.focus;
    if (time === null) {
      this.readout.textContent = "Point at the raster to read it; click to go there.";
      return;
    }
    const { units, trials, fields, startS, binS } = this.lanes;
    const bin = Math.floor((time - startS) / binS);
    const firing = units.filter((u) => (u.counts[bin] ?? 0) > 0).length;
    const trial = trials[trialAt(trials, time)];
    const unit = units[this.#pointedRow];
    const words = [
      seconds(time),
      ...(trial === undefined ? [] : [`trial ${number(trials.indexOf(trial) + 1)}${trial.label === "" ? "" : ` (${trial.label})`}`]),
      ...(units.length === 0 ? [] : [`${number(firing)} of ${number(units.length)} units fire within ${number(1e3 * binS, 0)} ms`]),
      ...(unit === undefined ? [] : [`unit ${unit.id}: ${number(unit.counts[bin] ?? 0)}`]),
      ...fields.slice(0, 1).flatMap((f) => {
        const at = Math.floor((time - f.startS) / f.binS);
        const code = f.low[at] ?? noSample;
        return code === noSample ? [] : [`${f.name} ${number(1e6 * (f.least + f.step * code), 0)} to ${number(1e6 * (f.least + f.step * f.high[at]!), 0)} ${f.unit === "volts" ? "uV" : "1e-6 " + f.unit}`];
      }),
    ];
    this.readout.textContent = words.join(", ");
  }

  draw(): void {
    this.#width = Math.max(280, Math.floor(this.box.clientWidth));
    const pen = fitCanvas(this.canvas, this.#width, this.#height);
    pen.font = "11px system-ui, sans-serif";
    const names = [...this.lanes.units.map((u) => u.id), ...this.lanes.fields.map((f) => f.name)];
    const longest = Math.max(40, ...names.map((n) => pen.measureText(n).width));
    this.#gutter = Math.min(Math.ceil(longest) + 12, 0.3 * this.#width);
    this.#trials(pen);
    this.#raster(pen);
    this.lanes.fields.forEach((field, f) => this.#field(pen, field, this.#fieldTop + f * fieldHeight));
    this.#axis(pen);
    this.#drawn = this.view.range;
    this.#putLines();
  }

  #name(pen: CanvasRenderingContext2D, name: string, y: number): void {
    pen.fillStyle = palette().ink;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    pen.fillText(name, this.#gutter - 8, y, this.#gutter - 10);
  }

  #trials(pen: CanvasRenderingContext2D): void {
    const { trials } = this.lanes;
    if (trials.length === 0) return;
    this.#name(pen, "trials", trialHeight / 2);
    const [from, to] = this.view.range;
    trials.forEach((trial, i) => {
      if (trial.stopS < from || trial.startS > to) return;
      const left = Math.max(this.#gutter, this.#xOf(trial.startS));
      const width = Math.max(1, Math.min(this.#width, this.#xOf(trial.stopS)) - left);
      pen.fillStyle = palette().band;
      pen.fillRect(left, 2, width, this.#fieldTop - 4);
      pen.fillStyle = palette().ink;
      pen.textAlign = "left";
      const words = trial.label === "" ? `${i + 1}` : `${i + 1}: ${trial.label}`;
      if (width > pen.measureText(words).width + 8) pen.fillText(words, left + 4, trialHeight / 2 + 1);
      else if (width > 20) pen.fillText(`${i + 1}`, left + 4, trialHeight / 2 + 1);
    });
  }

  #raster(pen: CanvasRenderingContext2D): void {
    const { units, startS, binS } = this.lanes;
    const row = this.#row;
    const every = Math.max(1, Math.ceil(11 / row));
    const [from, to] = this.view.range;
    units.forEach((unit, u) => {
      const y = this.#rasterTop + u * row;
      if (u % every === 0) this.#name(pen, unit.id, y + Math.max(row, 11) / 2);
      pen.fillStyle = palette().line;
      const [first, last] = binsIn(from, to, startS, binS, unit.counts.length);
      // A mark is full at a spike a bin, or at twice the unit's mean where this is more; bins that share a pixel are drawn together.
      const full = Math.max(1, (2 * unit.spikes) / unit.counts.length);
      const together = Math.max(1, Math.round(binS > 0 ? (1.5 * (to - from)) / (this.#width - this.#gutter) / binS : 1));
      for (let b = first; b < last; b += together) {
        const spikes = unit.counts.subarray(b, Math.min(last, b + together)).reduce((n, c) => n + c, 0);
        if (spikes === 0) continue;
        const x = Math.max(this.#gutter, this.#xOf(startS + b * binS));
        const width = Math.max(1, Math.min(3, this.#xOf(startS + (b + together) * binS) - x));
        pen.globalAlpha = Math.min(1, 0.3 + (0.7 * spikes) / (together * full));
        pen.fillRect(x, y + (row > 4 ? 1 : 0), width, Math.max(1, row - (row > 4 ? 2 : 0)));
      }
      pen.globalAlpha = 1;
    });
  }

  #field(pen: CanvasRenderingContext2D, field: FieldRow, top: number): void {
    this.#name(pen, field.name, top + fieldHeight / 2);
    const [from, to] = this.view.range;
    const [first, last] = binsIn(from, to, field.startS, field.binS, field.low.length);
    pen.fillStyle = palette().line;
    const y = (code: number): number => top + fieldHeight - 4 - (code / 254) * (fieldHeight - 8);
    for (let b = first; b < last; ++b) {
      const low = field.low[b]!;
      const high = field.high[b]!;
      if (low === noSample) continue;
      const x = Math.max(this.#gutter, this.#xOf(field.startS + b * field.binS));
      const end = Math.min(this.#width, this.#xOf(field.startS + (b + 1) * field.binS));
      if (end < x) continue;
      pen.fillRect(x, y(high), Math.max(1, end - x), Math.max(1, y(low) - y(high)));
    }
  }

  #axis(pen: CanvasRenderingContext2D): void {
    const [from, to] = this.view.range;
    const rough = (to - from) / Math.max(2, (this.#width - this.#gutter) / 80);
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough)!;
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    pen.fillStyle = palette().muted;
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    for (let t = Math.ceil(from / step) * step; t <= to + 1e-9; t += step) {
      const x = this.#xOf(t);
      pen.fillRect(x, this.#height - 20, 1, 4);
      pen.fillText(`${t.toFixed(decimals)} s`, Math.min(x, this.#width - 18), this.#height - 1);
    }
  }

  #putLines(): void {
    const [from, to] = this.view.range;
    const place = (time: number | null): number | null => (time === null || time < from || time > to ? null : Math.round(this.#xOf(time)));
    this.#pointed.put(place(this.view.pointer));
    this.#asked.put(place(this.view.focus));
  }
}
