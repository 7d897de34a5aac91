// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { columnRange, firstAtOrAfter, nearest, worstCode } from "../downsample.ts";
import { el, fitCanvas } from "../dom.ts";
import { seconds } from "../format.ts";
import { onThemeChange, palette } from "../theme.ts";
import type { TimeRange, View } from "../view.ts";
import { TimeLine } from "./time_line.ts";

/** What the codes of a row mean: the worse, the larger; 0 is as it should be. */
export interface MapKind {
  /** Prefix of the classes that colour the legend. */
  group: string;
  words: readonly string[];
  /** Asked for at every redraw. */
  colours: () => readonly string[];
}

export interface MapRow {
  name: string;
  kind: MapKind;
  /** One per point, or null when not known. */
  codes: Uint8Array | null;
  /** Index of the marker that a click chooses, or -1. */
  marker: number;
  faint?: boolean;
  /** More to say of a point, or "". */
  remark?: (point: number) => string;
}

const rowHeight = 14;
const top = 4;
const groupGap = 8;

/** Rows by time: where each marker's samples came from. Rows of another kind stand apart. */
export class GapMap {
  readonly canvas = el("canvas", { role: "img", "aria-label": "Map of gaps: one row per marker, time to the right" });
  readonly readout = el("p", { class: "readout" });
  #rows: readonly MapRow[];
  #tops: number[] = [];
  #gutter = 120;

  constructor(
    readonly box: HTMLElement,
    readonly time: Float64Array,
    readonly view: View,
    rows: readonly MapRow[],
  ) {
    this.#rows = rows;
    this.#layOut();
    box.append(this.canvas, this.#pointed.node, this.#asked.node);
    this.canvas.addEventListener("mousemove", (e) => this.#point(e));
    this.canvas.addEventListener("mouseleave", () => {
      this.readout.textContent = "";
      view.set({ pointer: null });
    });
    this.canvas.addEventListener("click", (e) => {
      const marker = this.#rowAt(e.offsetY)?.marker ?? -1;
      view.set(marker < 0 ? { focus: this.#timeAt(e.offsetX) } : { focus: this.#timeAt(e.offsetX), marker });
    });
    new ResizeObserver(() => this.draw()).observe(box);
    onThemeChange(() => this.draw());
    view.onChange(() => {
      if (view.range === this.#drawn[0] && view.marker === this.#drawn[1]) this.#putLines();
      else this.draw();
    });
  }

  readonly #pointed = new TimeLine("pointed");
  readonly #asked = new TimeLine("asked");
  #drawn: [range: TimeRange | null, marker: number] = [null, -1];

  /** Show other rows of the same recording. */
  setRows(rows: readonly MapRow[]): void {
    this.#rows = rows;
    this.#layOut();
    this.draw();
  }

  #layOut(): void {
    let y = top;
    this.#tops = this.#rows.map((row, r) => {
      if (r > 0 && this.#rows[r - 1]!.kind !== row.kind) y += groupGap;
      y += rowHeight;
      return y - rowHeight;
    });
  }

  #width = 600;

  #rowAt(y: number): MapRow | undefined {
    return this.#rows[this.#tops.findIndex((t) => t <= y && y < t + rowHeight)];
  }

  #timeAt(x: number): number {
    const [from, to] = this.view.range;
    const share = (x - this.#gutter) / (this.#width - this.#gutter);
    return from + Math.min(1, Math.max(0, share)) * (to - from);
  }

  #point(event: MouseEvent): void {
    const time = this.#timeAt(event.offsetX);
    const i = nearest(this.time, time);
    const row = this.#rowAt(event.offsetY);
    this.view.set({ pointer: time });
    if (i < 0 || row === undefined) return;
    const word = row.codes === null ? "not known" : row.kind.words[row.codes[i]!]!;
    this.readout.textContent = `${row.name} at ${seconds(this.time[i]!)}: ${word}${row.remark?.(i) ?? ""}`;
  }

  draw(): void {
    this.#width = Math.max(280, Math.floor(this.box.clientWidth));
    const height = (this.#tops.at(-1) ?? top) + rowHeight + 22;
    const pen = fitCanvas(this.canvas, this.#width, height);
    pen.font = "11px system-ui, sans-serif";
    const longest = Math.max(...this.#rows.map((r) => pen.measureText(r.name).width), 40);
    this.#gutter = Math.min(Math.ceil(longest) + 12, 0.35 * this.#width);

    this.#rows.forEach((row, r) => {
      pen.globalAlpha = row.faint ? 0.5 : 1;
      const selected = row.marker >= 0 && row.marker === this.view.marker;
      this.#strip(pen, this.#tops[r]!, row.codes, row.kind.colours(), row.name, selected);
    });
    pen.globalAlpha = 1;
    this.#axis(pen, height);
    this.#drawn = [this.view.range, this.view.marker];
    this.#putLines();
  }

  #strip(
    pen: CanvasRenderingContext2D,
    y: number,
    codes: Uint8Array | null,
    colours: readonly string[],
    name: string,
    selected: boolean,
  ): void {
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    pen.fillStyle = selected ? palette().line : palette().ink;
    pen.font = `${selected ? "600 " : ""}11px system-ui, sans-serif`;
    pen.fillText(name, this.#gutter - 8, y + rowHeight / 2, this.#gutter - 10);
    if (codes === null) return;
    const { time } = this;
    const [from, to] = this.view.range;
    const first = firstAtOrAfter(time, from - 1e-9);
    const last = Math.max(first + 1, firstAtOrAfter(time, to + 1e-9));
    const columns = Math.max(1, Math.min(Math.floor(this.#width - this.#gutter), last - first));
    const columnWidth = (this.#width - this.#gutter) / columns;
    for (let c = 0; c < columns; ) {
      const code = this.#code(codes, first, last, columns, c);
      const start = c;
      while (c < columns && this.#code(codes, first, last, columns, c) === code) ++c;
      pen.fillStyle = colours[code]!;
      // The worse a state is, the higher it stands, so that the map is readable without colour.
      const inset = code === 0 ? 3 : 1;
      const width = Math.max(code === 0 ? 0 : 2, (c - start) * columnWidth);
      pen.fillRect(this.#gutter + start * columnWidth, y + inset, width, rowHeight - 2 * inset);
    }
  }

  #code(codes: Uint8Array, first: number, last: number, columns: number, column: number): number {
    return worstCode(codes, ...columnRange(first, last, columns, column));
  }

  #axis(pen: CanvasRenderingContext2D, height: number): void {
    const [from, to] = this.view.range;
    const rough = (to - from) / Math.max(2, (this.#width - this.#gutter) / 80);
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough)!;
    pen.fillStyle = palette().muted;
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    for (let t = Math.ceil(from / step) * step; t <= to + 1e-9; t += step) {
      const x = this.#gutter + ((t - from) / (to - from)) * (this.#width - this.#gutter);
      pen.fillRect(x, height - 20, 1, 4);
      pen.fillText(`${t.toFixed(decimals)} s`, Math.min(x, this.#width - 18), height - 1);
    }
  }

  #putLines(): void {
    const [from, to] = this.view.range;
    const place = (time: number | null): number | null =>
      time === null || time < from || time > to ? null : Math.round(this.#gutter + ((time - from) / (to - from)) * (this.#width - this.#gutter));
    this.#pointed.put(place(this.view.pointer));
    this.#asked.put(place(this.view.focus));
  }
}
