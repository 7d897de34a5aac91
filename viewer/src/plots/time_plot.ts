// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import uPlot from "uplot";
import { precisionWords, type Precision } from "../curves.ts";
import { el } from "../dom.ts";
import { number } from "../format.ts";
import { fileName, save } from "../save.ts";
import { hatch, onThemeChange, palette } from "../theme.ts";
import type { TimeRange, View } from "../view.ts";
import { figureCsv, figureSvg, type Figure } from "./figure.ts";
import { TimeLine } from "./time_line.ts";

export interface TimePlotOptions {
  label: string;
  height: number;
  /** Lines above the first, which is the time. The colours are asked for at every redraw. */
  series: { name?: string; stroke: (dense: boolean) => string; width: number; hidden?: boolean; dash?: number[] }[];
  /** Two standard deviations to each side of the line `of`. */
  bands?: { series: [upper: number, lower: number]; of: number; fill: () => string }[];
  unit: () => string;
  fromZero?: boolean;
  /** Stretches to hatch, in s. */
  hatched: () => [from: number, to: number][];
  /** What the page holds of the curves; stands beside the buttons and in the saved numbers. */
  precision?: () => Precision;
  /** Heights of dashed lines, where they are in sight. */
  levels?: () => readonly number[];
}

/** uPlot tied to the shared view: same time axis, same pointer, a line at the time that was asked for. */
export class TimePlot {
  readonly plot: uPlot;
  readonly #view: View;
  readonly #box: HTMLElement;
  readonly #height: number;

  constructor(box: HTMLElement, view: View, options: TimePlotOptions) {
    this.#view = view;
    this.#box = box;
    this.#height = options.height;
    const axis = (extra: uPlot.Axis): uPlot.Axis => ({
      stroke: () => palette().muted,
      grid: { stroke: () => palette().grid, width: 1 },
      ticks: { stroke: () => palette().grid, width: 1, size: 4 },
      font: "12px system-ui, sans-serif",
      labelFont: "12px system-ui, sans-serif",
      ...extra,
    });
    let choosing = false;
    const config: uPlot.Options = {
      width: this.#width(),
      height: options.height,
      legend: { show: false },
      padding: [10, 10, 0, 0],
      scales: {
        x: { time: false },
        y: { range: (_u, low, high) => yRange(low, high, options.fromZero ?? false) },
      },
      axes: [
        axis({ label: "time (s)", labelSize: 20, size: 30 }),
        axis({ size: 62, label: " ", labelSize: 18, values: (_u, ticks) => tickTexts(ticks) }),
      ],
      series: [
        {},
        ...options.series.map((s) => ({
          stroke: (u: uPlot) => s.stroke(isDense(u)),
          width: s.width,
          ...(s.dash === undefined ? {} : { dash: s.dash }),
          points: { show: s.hidden ? false : undefined, size: 4 },
          spanGaps: false,
        })),
      ],
      bands: (options.bands ?? []).map((b) => ({ series: b.series, fill: b.fill })),
      cursor: { y: false, drag: { x: true, y: false, setScale: false }, points: { size: 6 } },
      hooks: {
        drawClear: [(u) => this.#drawHatched(u, options.hatched()), (u) => this.#drawStretch(u)],
        draw: [() => this.#putFocus(), (u) => this.#drawLevels(u, options.levels?.() ?? [])],
        setSelect: [
          (u) => {
            if (u.select.width < 3) return;
            const range = [u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x")] as const;
            u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
            view.set(choosing ? { stretch: range } : { range });
          },
        ],
        setCursor: [
          (u) => {
            // Only the plot under the pointer tells; the others are told.
            if (u.root.matches(":hover")) {
              const left = u.cursor.left ?? -1;
              view.set({ pointer: left < 0 ? null : u.posToVal(left, "x") });
            }
          },
        ],
      },
    };
    this.plot = new uPlot(config, undefined, box);
    this.plot.over.append(this.#focus.node);
    this.plot.root.setAttribute("role", "img");
    this.plot.root.setAttribute("aria-label", options.label);
    this.plot.over.addEventListener("dblclick", () => view.set({ range: view.whole, focus: null }));
    let pressed = 0;
    this.plot.over.addEventListener("mousedown", (e) => {
      pressed = e.offsetX;
      choosing = view.editable && e.shiftKey;
    });
    this.plot.over.addEventListener("click", (e) => {
      // A drag, which zooms, ends in a click too.
      if (Math.abs(e.offsetX - pressed) < 3) view.set({ focus: this.plot.posToVal(e.offsetX, "x") });
    });
    box.append(this.#tools(options));
    this.plot.over.addEventListener("mouseleave", () => view.set({ pointer: null }));
    new ResizeObserver(() => this.#fit()).observe(box);
    onThemeChange(() => this.plot.redraw(false));
    view.onChange(() => this.#follow());
    this.#unit = options.unit;
    this.#precision = options.precision;
  }

  readonly #unit: () => string;
  readonly #precision: (() => Precision) | undefined;
  readonly #held = el("small", { class: "held" });
  readonly #focus = new TimeLine("asked");
  #stretch: TimeRange | null = null;

  /** Buttons that save what is drawn. */
  #tools(options: TimePlotOptions): HTMLElement {
    const button = (words: string, title: string, click: () => void): HTMLElement =>
      el("button", { type: "button", title, click }, words);
    const name = (ending: string): string => fileName(`${document.title.split(" · ")[0] ?? ""}_${this.#unit()}`, ending);
    const text = (kind: string, content: string): Blob => new Blob([content], { type: kind });
    return el(
      "span",
      { class: "figure-tools" },
      this.#held,
      button("SVG", "Save this figure as a drawing", () => save(name("svg"), text("image/svg+xml", figureSvg(this.#figure(options))))),
      button("PNG", "Save this figure as a picture", () => this.#savePng(name("png"))),
      button("CSV", "Save the numbers of this figure", () => save(name("csv"), text("text/csv", figureCsv(this.#figure(options))))),
    );
  }

  #figure(options: TimePlotOptions): Figure {
    const lines = options.series.flatMap((s, i) => (s.width === 0 ? [] : [i]));
    const [x, ...all] = this.plot.data;
    const { min, max } = this.plot.scales["y"]!;
    return {
      title: options.label,
      unit: this.#unit(),
      x,
      range: this.#view.range,
      height: [min ?? 0, max ?? 1],
      bands: (options.bands ?? []).map((b) => ({ colour: b.fill(), upper: [...all[b.series[0] - 1]!], lower: [...all[b.series[1] - 1]!], of: lines.indexOf(b.of - 1) })),
      lines: lines.map((i) => {
        const { name, stroke, width } = options.series[i]!;
        return { ...(name === undefined ? {} : { name }), colour: stroke(false), width, values: [...all[i]!] };
      }),
      striped: options.hatched(),
      ...(options.precision === undefined ? {} : { precision: options.precision() }),
    };
  }

  #savePng(name: string): void {
    const { canvas } = this.plot.ctx;
    const copy = el("canvas", { width: canvas.width, height: canvas.height });
    const pen = copy.getContext("2d")!;
    pen.fillStyle = palette().background;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(canvas, 0, 0);
    copy.toBlob((blob) => blob !== null && save(name, blob), "image/png");
  }

  setData(data: uPlot.AlignedData): void {
    this.plot.axes[1]!.label = this.#unit();
    if (this.#precision !== undefined) this.#held.textContent = precisionWords(this.#precision(), "");
    this.plot.batch(() => {
      this.plot.setData(data, false);
      this.plot.setScale("x", { min: this.#view.range[0], max: this.#view.range[1] });
    });
    this.plot.redraw(true, true);
  }

  #width(): number {
    return Math.max(260, Math.floor(this.#box.clientWidth));
  }

  #fit(): void {
    if (this.#width() !== this.plot.width) this.plot.setSize({ width: this.#width(), height: this.#height });
  }

  #follow(): void {
    const { range, pointer, stretch } = this.#view;
    const { min, max } = this.plot.scales["x"]!;
    if (min !== range[0] || max !== range[1]) this.plot.setScale("x", { min: range[0], max: range[1] });
    else if (stretch !== this.#stretch) this.plot.redraw(false, false);
    else this.#putFocus();
    this.#stretch = stretch;
    if (!this.plot.root.matches(":hover")) {
      const left = pointer === null || pointer < range[0] || pointer > range[1] ? -10 : this.plot.valToPos(pointer, "x");
      this.plot.setCursor({ left, top: left < 0 ? -10 : 0 }, false);
    }
  }

  #drawHatched(u: uPlot, stretchesInS: [number, number][]): void {
    if (stretchesInS.length === 0) return;
    const { ctx, bbox } = u;
    ctx.save();
    ctx.fillStyle = hatch(ctx, window.devicePixelRatio);
    for (const [from, to] of stretchesInS) {
      const left = Math.max(bbox.left, u.valToPos(from, "x", true));
      const right = Math.min(bbox.left + bbox.width, u.valToPos(to, "x", true));
      // What is narrower than a pixel is drawn paler, so that many short stretches do not look like one long one.
      ctx.globalAlpha = Math.min(1, Math.max(0.3, right - left));
      if (right > left) ctx.fillRect(left, bbox.top, Math.max(1, right - left), bbox.height);
    }
    ctx.restore();
  }

  /** What is to be edited. */
  #drawStretch(u: uPlot): void {
    if (this.#view.stretch === null) return;
    const { ctx, bbox } = u;
    const inside = (time: number): number => Math.min(bbox.left + bbox.width, Math.max(bbox.left, u.valToPos(time, "x", true)));
    const [left, right] = this.#view.stretch.map(inside) as [number, number];
    ctx.save();
    ctx.fillStyle = palette().focus;
    ctx.globalAlpha = 0.14;
    ctx.fillRect(left, bbox.top, Math.max(1, right - left), bbox.height);
    ctx.restore();
  }

  #drawLevels(u: uPlot, levels: readonly number[]): void {
    const { ctx, bbox } = u;
    for (const level of levels) {
      const y = Math.round(u.valToPos(level, "y", true));
      if (!(y >= bbox.top && y <= bbox.top + bbox.height)) continue;
      ctx.save();
      ctx.strokeStyle = palette().muted;
      ctx.lineWidth = window.devicePixelRatio;
      ctx.setLineDash([2 * window.devicePixelRatio, 3 * window.devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
      ctx.restore();
    }
  }

  #putFocus(): void {
    const { focus, range } = this.#view;
    this.#focus.put(focus === null || focus < range[0] || focus > range[1] ? null : this.plot.valToPos(focus, "x"));
  }
}

/** More than four points to a pixel: a line would be a solid block and hide the band behind it. */
function isDense(u: uPlot): boolean {
  const [first, last] = u.series[0]!.idxs ?? [0, 0];
  return last - first > 4 * u.width;
}

/** Room above and below; never so close that noise fills the plot of a coordinate that stands still. */
export function yRange(low: number | null, high: number | null, fromZero: boolean): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  if (fromZero) return [0, high > 0 ? 1.08 * high : 1];
  const margin = Math.max(0.06 * (high - low), 1e-3 * Math.max(Math.abs(low), Math.abs(high)), 1e-6);
  return [low - margin, high + margin];
}

/** As many decimals as the ticks need to be written in full, the same for all. */
export function tickTexts(ticks: number[]): string[] {
  const step = ticks.length > 1 ? Math.abs(ticks[1]! - ticks[0]!) : 1;
  let decimals = 0;
  while (decimals < 6 && ticks.some((t) => Math.abs(t - Number(t.toFixed(decimals))) > 1e-3 * step)) ++decimals;
  return ticks.map((t) => number(t, decimals));
}
