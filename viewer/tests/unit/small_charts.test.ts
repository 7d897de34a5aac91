// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { fake, install, type FakeElement } from "../fake_dom.ts";

install();
const { autocorrelationChart, decades, powerText, spectrumChart, whiteBound } = await import("../../src/plots/small_charts.ts");
const { pathOf } = await import("../../src/svg.ts");

const points = (chart: FakeElement, name: string): [number, number][] =>
  [...chart.classed(name)[0]!.getAttribute("d")!.matchAll(/[ML]([\d.]+) ([\d.]+)/g)].map((m) => [Number(m[1]), Number(m[2])]);
const texts = (chart: FakeElement): string[] => chart.tagged("text").map((t) => t.textContent);

describe("pathOf", () => {
  it("breaks where there is no point", () => {
    expect(pathOf([[1, 2], [3, 4.25], null, null, [5, 6]])).toBe("M1.0 2.0L3.0 4.3M5.0 6.0");
    expect(pathOf([null])).toBe("");
  });
});

describe("decades", () => {
  it("hold all values and are at least one", () => {
    expect(decades(0.03, 200)).toEqual([-2, 3]);
    expect(decades(1, 1)).toEqual([0, 1]);
    expect(decades(0.1, 100)).toEqual([-1, 2]);
  });
  it("are written as people write them", () => {
    expect([-12, -2, -1, 0, 1, 2, 3].map(powerText)).toEqual(["10⁻¹²", "10⁻²", "0.1", "1", "10", "100", "10³"]);
  });
});

describe("spectrumChart", () => {
  const spectrum = { frequency_hz: [0.1, 1, 10], raw_mm2_per_hz: [100, 1, 0.01], residual_mm2_per_hz: [null, 0.01, 0.01] };
  const chart = fake(spectrumChart(spectrum, 3, "of A"));
  it("is logarithmic on both axes: a power law is a straight line", () => {
    const [a, b, c] = points(chart, "raw");
    expect(b![0] - a![0]).toBeCloseTo(c![0] - b![0], 0);
    expect(b![1] - a![1]).toBeCloseTo(c![1] - b![1], 0);
    expect(a![1]).toBeLessThan(c![1]);
  });
  it("leaves out what is not known", () => {
    expect(points(chart, "residual").length).toBe(2);
    expect(points(chart, "residual")[0]).toEqual([points(chart, "raw")[1]![0], points(chart, "raw")[2]![1]]);
  });
  it("marks the cut-off between the frequencies around it, and only inside the plot", () => {
    const at = (c: FakeElement): number => Number(/M([\d.]+)/.exec(c.classed("cutoff")[0]!.getAttribute("d")!)![1]);
    expect(at(chart)).toBeGreaterThan(points(chart, "raw")[1]![0]);
    expect(at(chart)).toBeLessThan(points(chart, "raw")[2]![0]);
    expect(fake(spectrumChart(spectrum, 30, "")).classed("cutoff")).toEqual([]);
    expect(fake(spectrumChart(spectrum, null, "")).classed("cutoff")).toEqual([]);
  });
  it("names its axes and is called by its label", () => {
    expect(texts(chart)).toEqual(expect.arrayContaining(["0.1", "1", "10", "10⁻²", "frequency (Hz)"]));
    expect(chart.getAttribute("aria-label")).toBe("of A");
  });
  it("does not span the axis to arithmetic dust", () => {
    const dusty = fake(spectrumChart({ ...spectrum, residual_mm2_per_hz: [1e-30, 1e-20, 0.01] }, null, ""));
    expect(points(dusty, "residual").length).toBe(1);
    expect(texts(dusty)).not.toContain("10⁻³⁰");
  });
  it("is nothing without numbers", () => {
    expect(spectrumChart({ frequency_hz: [], raw_mm2_per_hz: [], residual_mm2_per_hz: [] }, 5, "")).toBeNull();
    expect(spectrumChart({ frequency_hz: [1, 2], raw_mm2_per_hz: [null, 0], residual_mm2_per_hz: [null, null] }, 5, "")).toBeNull();
  });
});

describe("autocorrelationChart", () => {
  const chart = fake(autocorrelationChart([0.3, -0.02, null], [], 400, "of A"));
  it("draws a bar per known lag, up or down from zero", () => {
    const bars = chart.tagged("rect").map((b) => [Number(b.getAttribute("y")), Number(b.getAttribute("height"))] as const);
    expect(bars.length).toBe(2);
    expect(bars[0]![0] + bars[0]![1]).toBeCloseTo(bars[1]![0], 0);
    expect(bars[0]![1] / bars[1]![1]).toBeCloseTo(15, 0);
    expect(texts(chart)).toEqual(expect.arrayContaining(["1", "2", "3", "lag (frames)"]));
  });
  it("tells the lags that white noise would not show", () => {
    expect(whiteBound(400)).toBeCloseTo(0.098, 3);
    expect(chart.tagged("rect").map((b) => b.getAttribute("class"))).toEqual(["bar beyond", "bar"]);
    expect(fake(autocorrelationChart([0.3], [], 20, "")).tagged("rect")[0]!.getAttribute("class")).toBe("bar");
  });
  it("judges each lag by what the filter makes of white noise", () => {
    const classes = (ifWhite: number[]): (string | null)[] =>
      fake(autocorrelationChart([-0.3, -0.3], ifWhite, 400, "")).tagged("rect").map((b) => b.getAttribute("class"));
    expect(classes([])).toEqual(["bar beyond", "bar beyond"]);
    expect(classes([-0.28, -0.1])).toEqual(["bar", "bar beyond"]);
  });
  it("stays within its axis whatever the data say", () => {
    const wild = fake(autocorrelationChart([7, -7], [], 400, ""));
    for (const b of wild.tagged("rect")) {
      expect(Number(b.getAttribute("y"))).toBeGreaterThanOrEqual(0);
      expect(Number(b.getAttribute("y")) + Number(b.getAttribute("height"))).toBeLessThanOrEqual(230);
    }
  });
  it("is nothing without numbers, and white bounds of nothing are everything", () => {
    expect(autocorrelationChart([], [], 100, "")).toBeNull();
    expect(whiteBound(0)).toBe(1);
  });
});
