// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { fake, FakeElement, install, nextFrame, resizeAll } from "../fake_dom.ts";
import FakePlot from "../fake_plot.ts";

install();
vi.mock("uplot", () => ({ default: FakePlot }));
const { TimePlot, tickTexts, yRange } = await import("../../src/plots/time_plot.ts");
const { View } = await import("../../src/view.ts");

const box = (): HTMLElement => new FakeElement("div") as unknown as HTMLElement;

function make(hatched: [number, number][] = []) {
  install();
  const view = new View([0, 10]);
  const element = box();
  const time = new TimePlot(element, view, {
    label: "A plot",
    height: 200,
    series: [
      { stroke: (dense) => (dense ? "dense" : "line"), width: 2 },
      { stroke: () => "made", width: 3, hidden: true },
    ],
    bands: [{ series: [1, 2], of: 1, fill: () => "band" }],
    unit: () => "position (mm)",
    hatched: () => hatched,
  });
  time.setData([[0, 5, 10], [1, 2, 3], [null, null, 1]]);
  return { view, plot: FakePlot.made.at(-1)!, element: fake(element) };
}

describe("TimePlot", () => {
  beforeEach(() => (FakePlot.made = []));

  it("shows the range of the view and says what it is", () => {
    const { plot } = make();
    expect(plot.scales["x"]).toEqual({ min: 0, max: 10 });
    expect(plot.axes[1]!.label).toBe("position (mm)");
    expect(plot.root.getAttribute("aria-label")).toBe("A plot");
    expect(plot.data.length).toBe(3);
  });
  it("follows the view once per frame", () => {
    const { view, plot } = make();
    view.set({ range: [2, 3] });
    expect(plot.scales["x"]).toEqual({ min: 0, max: 10 });
    nextFrame();
    expect(plot.scales["x"]).toEqual({ min: 2, max: 3 });
  });
  it("tells the view what was dragged, and clears the mark", () => {
    const { view, plot } = make();
    plot.select = { left: 200, width: 300 };
    plot.hook("setSelect");
    expect(view.range[0]).toBeCloseTo(2);
    expect(view.range[1]).toBeCloseTo(5);
    expect(plot.select.width).toBe(0);
    plot.select = { left: 200, width: 2 };
    plot.hook("setSelect");
    expect(view.range[1]).toBeCloseTo(5);
  });
  it("chooses what shall be edited with Shift, where that can be done, and zooms otherwise", () => {
    const { view, plot } = make();
    plot.over.fire("mousedown", { offsetX: 200, shiftKey: true });
    plot.select = { left: 200, width: 300 };
    plot.hook("setSelect");
    expect(view.stretch).toBeNull();
    expect(view.range[0]).toBeCloseTo(2);
    view.set({ range: [0, 10] });
    view.editable = true;
    plot.over.fire("mousedown", { offsetX: 200, shiftKey: true });
    plot.select = { left: 200, width: 300 };
    plot.hook("setSelect");
    expect(view.stretch![0]).toBeCloseTo(2);
    expect(view.stretch![1]).toBeCloseTo(5);
    expect(view.range).toEqual([0, 10]);
    plot.over.fire("mousedown", { offsetX: 200, shiftKey: false });
    plot.select = { left: 400, width: 100 };
    plot.hook("setSelect");
    expect(view.range[0]).toBeCloseTo(4);
    expect(view.stretch![0]).toBeCloseTo(2);
  });
  it("shows everything after a double click", () => {
    const { view, plot } = make();
    view.set({ range: [2, 3], focus: 2.5 });
    plot.over.fire("dblclick");
    expect(view.range).toEqual([0, 10]);
    expect(view.focus).toBeNull();
  });
  it("speaks for the pointer only when it is above it", () => {
    const { view, plot } = make();
    plot.cursor.left = 400;
    plot.hook("setCursor");
    expect(view.pointer).toBeNull();
    plot.root.hovered = true;
    plot.hook("setCursor");
    expect(view.pointer).toBeCloseTo(4);
    plot.over.fire("mouseleave");
    expect(view.pointer).toBeNull();
  });
  it("is told where the pointer is when it is elsewhere", () => {
    const { view, plot } = make();
    view.set({ pointer: 7 });
    nextFrame();
    expect(plot.toldCursor).toBeCloseTo(700);
    view.set({ pointer: null });
    nextFrame();
    expect(plot.toldCursor).toBe(-10);
  });
  it("draws the line paler where swings are narrower than a pixel", () => {
    const { plot } = make();
    const [line] = plot.drawnSeries();
    plot.series = [{ idxs: [0, 100] }];
    expect(line!.stroke(plot)).toBe("line");
    plot.series = [{ idxs: [0, 100_000] }];
    expect(line!.stroke(plot)).toBe("dense");
    expect(plot.drawnSeries()[1]!.points.show).toBe(false);
  });
  it("stripes what is inside the plot, paler where it is narrower than a pixel", () => {
    const { plot } = make([[2, 4], [8, 30], [6, 6.001]]);
    plot.hook("drawClear");
    const rects = plot.ctx.drawn.filter((d) => d.what === "rect");
    expect(rects.map((r) => r.numbers.map(Math.round))).toEqual([[300, 10, 200, 200], [900, 10, 200, 200], [700, 10, 1, 200]]);
    expect(rects.map((r) => r.alpha)).toEqual([1, 1, 0.3]);
  });
  it("marks the time that was asked for, if it can be seen, without drawing anew", () => {
    const { view, plot } = make();
    const [line] = plot.over.classed("time-line");
    const { redraws } = plot;
    expect(line!.hidden).toBe(true);
    view.set({ focus: 5 });
    nextFrame();
    expect([line!.hidden, line!.style["transform"]]).toEqual([false, "translateX(500.0px)"]);
    view.set({ focus: 50 });
    nextFrame();
    expect(line!.hidden).toBe(true);
    expect(plot.redraws).toBe(redraws);
  });
  it("draws anew what is to be edited", () => {
    const { view, plot } = make();
    const { redraws } = plot;
    view.set({ stretch: [2, 3] });
    nextFrame();
    view.set({ focus: 4 });
    nextFrame();
    expect(plot.redraws).toBe(redraws + 1);
  });
  it("takes the width of its box", () => {
    const { plot, element } = make();
    expect(plot.width).toBe(620);
    element.clientWidth = 100;
    resizeAll();
    expect(plot.width).toBe(260);
  });
});

describe("yRange", () => {
  it("leaves room, and does not magnify the noise of what stands still", () => {
    const [low, high] = yRange(-1, 1, false);
    expect([low, high]).toEqual([-1.12, 1.12]);
    const [still, top] = yRange(1000, 1000.0001, false);
    expect(top - still).toBeGreaterThan(1.9);
    expect(yRange(0, 0, false)[1]).toBeGreaterThan(0);
  });
  it("begins at zero where that is asked, and survives nothing", () => {
    expect(yRange(3, 10, true)).toEqual([0, 10.8]);
    expect(yRange(0, 0, true)).toEqual([0, 1]);
    expect(yRange(null, null, false)).toEqual([0, 1]);
    expect(yRange(NaN, 2, false)).toEqual([0, 1]);
  });
});

describe("tickTexts", () => {
  it("writes as many decimals as the step needs, the same for all", () => {
    expect(tickTexts([0, 0.5, 1])).toEqual(["0.0", "0.5", "1.0"]);
    expect(tickTexts([-1000, 0, 1000])).toEqual(["−1,000", "0", "1,000"]);
    expect(tickTexts([0.0025, 0.005])).toEqual(["0.0025", "0.0050"]);
    expect(tickTexts([3])).toEqual(["3"]);
  });
});
