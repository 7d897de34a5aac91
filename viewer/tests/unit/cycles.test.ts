// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { EncodedCycles } from "../../src/page_types.ts";
import { describe, expect, it, vi } from "vitest";
import { fake, install } from "../fake_dom.ts";
import { inflated, packedCurve } from "../packed.ts";
import { simulated } from "../simulated.ts";

vi.mock("uplot", () => import("../fake_plot.ts"));
install();
const { countWords, cutIntoCycles, decodeCycles } = await import("../../src/cycles.ts");
const { decode } = await import("../../src/decode.ts");
const { cyclePlot } = await import("../../src/plots/cycle_plot.ts");
const { compare } = await import("../../src/sections/compare.ts");
const { cycleFigure, cyclesCsv } = await import("../../src/sections/cycles.ts");
const { View, wholeOf } = await import("../../src/view.ts");

/** Two cycles of the right foot on five points, the second without its third; one of the left. */
const encoded = (coordinate = "knee_r"): EncodedCycles => ({
  points: 5,
  curves: [
    { coordinate, side: "Right", count: 2, whole: 1, fewest: 1, most: 2, drawn: 2, each: packedCurve([0, 1, 2, 1, 0, 2, 3, NaN, 3, 2]), mean: packedCurve([1, 2, 2, 2, 1]), sd: packedCurve([1, 1, NaN, 1, 1]) },
    { coordinate, side: "Left", count: 1, whole: 1, fewest: 1, most: 1, drawn: 1, each: packedCurve([5, 6, 7, 6, 5]), mean: packedCurve([5, 6, 7, 6, 5]), sd: null },
  ],
});

describe("cutIntoCycles", () => {
  const step = 1 / 200;
  const sine = (n: number): number[] => Array.from({ length: n }, (_, i) => Math.sin((2 * Math.PI * i * step) / 1.25));
  const spans = { Left: [[2.625, 3.875]], Right: [[2, 3.25], [3.25, 4.5], [4.5, 5.75]] } as const;
  it("is the swing from strike to strike, of each foot", () => {
    const [left, right] = cutIntoCycles("x", sine(800), 2, step, spans);
    expect([left!.side, left!.count, left!.sd]).toEqual(["Left", 1, null]);
    expect([right!.count, right!.whole, right!.each.length, right!.fewest, right!.most]).toEqual([3, 3, 3, 3, 3]);
    for (let p = 0; p <= 100; ++p) {
      expect(Math.abs(right!.mean[p]! - Math.sin((2 * Math.PI * p) / 100))).toBeLessThan(2e-4);
      expect(Math.abs(left!.mean[p]! + Math.sin((2 * Math.PI * p) / 100))).toBeLessThan(2e-4);
      expect(right!.sd![p]!).toBeLessThan(1e-5);
    }
  });
  it("has the spread between cycles with N - 1, point by point", () => {
    const values = sine(800).map((v, i) => v + (i < 250 ? 1 : i < 500 ? 2 : 3));
    const [, right] = cutIntoCycles("x", values, 2, step, spans);
    expect(right!.mean[50]).toBeCloseTo(2, 3);
    expect(right!.sd![50]).toBeCloseTo(1, 3);
  });
  it("leaves out what is missing, and cycles beyond the recording", () => {
    const values = sine(800);
    values.fill(NaN, 100, 130);
    const all = cutIntoCycles("x", values, 2, step, { Left: [[10, 11]], Right: spans.Right });
    expect(all.length).toBe(1);
    expect([all[0]!.count, all[0]!.whole, all[0]!.fewest, all[0]!.most]).toEqual([3, 2, 2, 3]);
    expect(all[0]!.each[0]![45]).toBeNaN();
  });
  it("draws twenty of many, the first and the last among them, and counts all", () => {
    const many = Array.from({ length: 50 }, (_, i): [number, number] => [i, i + 1]);
    const [one] = cutIntoCycles("x", Array.from({ length: 10_001 }, (_, i) => Math.floor(i / 200)), 0, step, { Left: [], Right: many });
    expect([one!.count, one!.each.length, one!.each[0]![50], one!.each[19]![50]]).toEqual([50, 20, 0, 49]);
  });
});

describe("decodeCycles", () => {
  it("has each cycle apart", async () => {
    const [right, left] = await decodeCycles(encoded());
    expect(right!.each.map((e) => [...e])).toEqual([[0, 1, 2, 1, 0], [2, 3, NaN, 3, 2]]);
    expect([...left!.mean]).toEqual([5, 6, 7, 6, 5]);
    expect(left!.sd).toBeNull();
  });
});

describe("countWords", () => {
  it("tell how many there are, and what is missing, only where it is", async () => {
    const [right, left] = await decodeCycles(encoded());
    expect(countWords(right!)).toBe("right: 2 cycles, 1 cycle with missing values, so that the mean is of 1 to 2");
    expect(countWords(left!)).toBe("left: 1 cycle");
    expect(countWords({ ...left!, count: 900, whole: 900, fewest: 900, most: 900 })).toBe("left: 900 cycles, 1 of them drawn");
  });
});

describe("cyclePlot", () => {
  const classed = (svg: unknown, name: string) => fake(svg).classed(name);
  it("draws every cycle, the means, and a band where there is a spread", async () => {
    const drawing = cyclePlot(await decodeCycles(encoded()), "knee", "angle (deg)");
    expect([classed(drawing, "cycle").length, classed(drawing, "cycle-mean").length]).toEqual([3, 2]);
    // The third point has no spread: two pieces, none of the one left cycle.
    expect(classed(drawing, "cycle-band").length).toBe(2);
    expect(classed(drawing, "cycle-band").every((b) => b.getAttribute("class")!.includes("right"))).toBe(true);
  });
  it("begins at 0 % and ends at 100 %, and breaks where a value is missing", async () => {
    const drawing = cyclePlot(await decodeCycles(encoded()), "knee", "angle (deg)");
    const [whole, broken] = classed(drawing, "cycle").map((c) => c.getAttribute("d")!);
    expect(whole!.startsWith("M92.0 ")).toBe(true);
    expect(/L534\.0 [\d.]+$/.test(whole!)).toBe(true);
    expect(whole!.match(/M/g)!.length).toBe(1);
    expect(broken!.match(/M/g)!.length).toBe(2);
  });
  it("is higher where the angle is larger", async () => {
    const drawing = cyclePlot(await decodeCycles(encoded()), "knee", "angle (deg)");
    const [right, left] = classed(drawing, "cycle-mean").map((c) => Number(/^M[\d.]+ ([\d.]+)/.exec(c.getAttribute("d")!)![1]));
    expect(left!).toBeLessThan(right!);
  });
});

describe("cyclesCsv", () => {
  it("holds mean, SD and each cycle, empty where there is none", async () => {
    const rows = cyclesCsv(await decodeCycles(encoded()), "deg").trim().split("\r\n");
    expect(rows[0]).toBe('cycle (%),"Right mean, deg","Right SD between cycles, deg","Right 1, deg","Right 2, deg","Left mean, deg","Left SD between cycles, deg","Left 1, deg"');
    expect(rows.slice(1)).toEqual(["0,1,1,0,2,5,,5", "25,2,1,1,3,6,,6", "50,2,,2,,7,,7", "75,2,1,1,3,6,,6", "100,1,1,0,2,5,,5"]);
  });
});

describe("the switch between time and cycle", () => {
  const made = () => {
    install();
    const trial = decode(inflated(simulated()));
    const names = trial.summary.coordinates.map((c) => c.name);
    return { names, ...compare(trial, new View(wholeOf(trial.summary)), null, inflated(encoded(names[0]!))) };
  };
  it("is there where events mark cycles alone", () => {
    const { node } = made();
    expect(fake(node).all((e) => e.getAttribute("id") === "over-cycle").length).toBe(1);
    const trial = decode(inflated(simulated()));
    const without = compare(trial, new View(wholeOf(trial.summary)));
    expect(fake(without.node).all((e) => e.getAttribute("id") === "over-cycle").length).toBe(0);
  });
  it("shows the cycles of what is chosen, and says where there are none", async () => {
    const { node, start } = made();
    start();
    const page = fake(node);
    const [button] = page.all((e) => e.getAttribute("id") === "over-cycle");
    const [time, cycle] = page.classed("side-by-side");
    expect([time!.hidden, cycle!.hidden]).toEqual([false, true]);
    button!.fire("click");
    await new Promise((done) => setTimeout(done));
    expect([time!.hidden, cycle!.hidden, button!.getAttribute("aria-pressed")]).toEqual([true, false, "true"]);
    expect(cycle!.classed("cycle-figure").length).toBe(1);
    expect(cycle!.textContent).toContain("right: 2 cycles, 1 cycle with missing values");
    expect(cycle!.textContent).toContain("No cycle has a value of it.");
    button!.fire("click");
    await new Promise((done) => setTimeout(done));
    expect([time!.hidden, cycle!.hidden]).toEqual([false, true]);
  });
  it("names what the figure shows for those who cannot see it", async () => {
    const figure = fake(cycleFigure("knee", await decodeCycles(encoded()), "angle (deg)"));
    expect(figure.tagged("svg")[0]!.getAttribute("aria-label")).toMatch(/^knee over the cycle: right: 2 cycles/);
  });
});
