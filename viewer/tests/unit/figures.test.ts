// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { PrecisionMap } from "../../src/page_types.ts";
import { describe, expect, it } from "vitest";
import { fake, install, type FakeElement } from "../fake_dom.ts";

install();
const { forest } = await import("../../src/plots/forest.ts");
const { edgesOf, heatMap } = await import("../../src/plots/heat_map.ts");
const { decimalsFor, ticks } = await import("../../src/plots/ticks.ts");

const texts = (chart: FakeElement): string[] => chart.tagged("text").map((t) => t.textContent);

describe("ticks", () => {
  it("are round, inside the range, and evenly spaced", () => {
    expect(ticks(0, 10)).toEqual([0, 2, 4, 6, 8, 10]);
    expect(ticks(-0.31, 0.32, 5)).toEqual([-0.2, 0, 0.2]);
    expect(ticks(3, 3)).toEqual([3]);
    expect(decimalsFor([0, 0.25])).toBe(1);
    expect(decimalsFor([0, 0.05])).toBe(2);
    expect(decimalsFor([0, 200])).toBe(0);
  });
});

describe("forest", () => {
  const rows = [
    { name: "thigh", value: 400, low: 390, high: 410, before: 420 },
    { name: "shank", value: 380, low: 300, high: 460, open: true },
    { name: "lost", value: null, low: null, high: null },
  ];
  const chart = fake(forest(rows, { label: "Lengths", axis: "length (mm)", reference: 400 }));
  const x = (node: FakeElement): number => Number(node.getAttribute("cx"));
  it("puts estimates where they are, in order, with what is not known left out", () => {
    const dots = chart.tagged("circle");
    expect(dots.length).toBe(2);
    expect(x(dots[0]!)).toBeGreaterThan(x(dots[1]!));
    expect(texts(chart)).toContain("thigh");
    expect(texts(chart)).not.toContain("lost");
    expect(texts(chart)).toContain("length (mm)");
    expect(chart.getAttribute("aria-label")).toBe("Lengths");
  });
  it("draws intervals to scale: four times as wide is four times as long", () => {
    const ends = chart.classed("interval").map((p) => /^M([\d.]+) [\d.]+H([\d.]+)/.exec(p.getAttribute("d")!)!.slice(1).map(Number) as [number, number]);
    expect((ends[1]![1] - ends[1]![0]) / (ends[0]![1] - ends[0]![0])).toBeCloseTo(8, 1);
  });
  it("tells apart what the data do not determine", () => {
    expect(chart.tagged("circle").map((d) => d.getAttribute("class"))).toEqual(["dot", "dot open"]);
  });
  it("is at peace with one number and with none", () => {
    expect(fake(forest([{ name: "a", value: 5, low: null, high: null }], { label: "", axis: "" })).tagged("circle").length).toBe(1);
    expect(fake(forest([], { label: "", axis: "" })).tagged("circle").length).toBe(0);
  });
  it("begins at 0 where asked", () => {
    expect(texts(fake(forest([{ name: "a", value: 50, low: 45, high: 55 }], { label: "", axis: "", fromZero: true })))).toContain("0");
  });
});

describe("heatMap", () => {
  const cells: PrecisionMap = { axes: [0, 2], first_m: [-0.2, 0], cell_m: 0.1, columns: 4, rows: 2, sd_mm: [1, 2, 3, 4, 5, null, 6, 7], samples: [1, 2, 3, 4, 5, 0, 6, 7] };
  it("has a cell for each number, and none where there is none", () => {
    const chart = fake(heatMap(cells, "Precision"));
    const drawn = chart.tagged("rect").filter((r) => r.tagged("title").length > 0);
    expect(drawn.length).toBe(7);
    expect(drawn[0]!.getAttribute("class")).toBe("heat-0");
    expect(drawn[6]!.getAttribute("class")).toBe("heat-5");
    expect([drawn[0]!, drawn[6]!].map((cell) => cell.tagged("title")[0]!.textContent)).toEqual(["1.00 mm, 1 point", "7.00 mm, 7 points"]);
    expect(texts(chart)).toContain("x (m)");
    expect(texts(chart)).toContain("z (m)");
  });
  it("has edges that hold as many cells each", () => {
    expect(edgesOf([6, 5, 4, 3, 2, 1], 3)).toEqual([1, 3, 5, 6]);
    expect(edgesOf([null])).toEqual([]);
  });
});
