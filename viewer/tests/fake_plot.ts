// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type uPlot from "uplot";
import { fake, FakeElement, Pen } from "./fake_dom.ts";

type Series = { stroke: (u: unknown) => string; width: number; points: { show?: boolean } };

/** Stands in for uPlot: remembers what it was told and calls the hooks when a test says so. */
export default class FakePlot {
  static made: FakePlot[] = [];
  readonly over = new FakeElement("div");
  readonly root = Object.assign(new FakeElement("div"), { hovered: false, matches: (): boolean => this.root.hovered });
  readonly axes: { label?: string }[];
  readonly scales: Record<string, { min?: number; max?: number }> = { x: {} };
  readonly ctx = Object.assign(new Pen(), { save: (): void => undefined, restore: (): void => undefined, setLineDash: (): void => undefined });
  readonly bbox = { left: 100, top: 10, width: 1000, height: 200 };
  readonly cursor = { left: -10 };
  select = { left: 0, width: 0 };
  data: uPlot.AlignedData = [[]];
  width: number;
  series: { idxs?: [number, number] }[] = [{}];
  redraws = 0;
  toldCursor = NaN;

  constructor(
    readonly options: uPlot.Options,
    _data: undefined,
    box: unknown,
  ) {
    this.width = options.width;
    this.axes = options.axes as { label?: string }[];
    fake(box).append(this.over);
    FakePlot.made.push(this);
  }
  drawnSeries(): Series[] {
    return this.options.series.slice(1) as unknown as Series[];
  }
  batch(run: () => void): void {
    run();
  }
  setData(data: uPlot.AlignedData): void {
    this.data = data;
  }
  setScale(_key: string, range: { min: number; max: number }): void {
    this.scales["x"] = range;
  }
  setSize({ width }: { width: number }): void {
    this.width = width;
  }
  setSelect(select: { left: number; width: number }): void {
    this.select = select;
  }
  setCursor({ left }: { left: number }): void {
    this.toldCursor = left;
  }
  redraw(): void {
    ++this.redraws;
  }
  posToVal(left: number): number {
    const { min = 0, max = 1 } = this.scales["x"]!;
    return min + ((max - min) * left) / this.bbox.width;
  }
  valToPos(value: number, _key: string, onCanvas = false): number {
    const { min = 0, max = 1 } = this.scales["x"]!;
    return (onCanvas ? this.bbox.left : 0) + (this.bbox.width * (value - min)) / (max - min);
  }
  hook(name: "drawClear" | "draw" | "setSelect" | "setCursor"): void {
    for (const run of (this.options.hooks as Record<string, ((u: unknown) => void)[]>)[name]!) run(this);
  }
}
