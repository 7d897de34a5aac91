// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { fake, install } from "../fake_dom.ts";
import { base64, simulated } from "../simulated.ts";
import type { EncodedCycles } from "../../src/cycles.ts";

vi.mock("uplot", () => import("../fake_plot.ts"));
install();
const { countWords, decodeCycles } = await import("../../src/cycles.ts");
const { decode } = await import("../../src/decode.ts");
const { cyclePlot } = await import("../../src/plots/cycle_plot.ts");
const { compare } = await import("../../src/sections/compare.ts");
const { cycleFigure, cyclesCsv } = await import("../../src/sections/cycles.ts");
const { View, wholeOf } = await import("../../src/view.ts");

const curve = (values: number[]): string => base64(Float32Array.from(values));

/** Two cycles of the right foot on five points, the second without its third; one of the left. */
const encoded = (coordinate = "knee_r"): EncodedCycles => ({
  points: 5,
  curves: [
    { coordinate, side: "Right", count: 2, whole: 1, fewest: 1, most: 2, drawn: 2, each: curve([0, 1, 2, 1, 0, 2, 3, NaN, 3, 2]), mean: curve([1, 2, 2, 2, 1]), sd: curve([1, 1, NaN, 1, 1]) },
    { coordinate, side: "Left", count: 1, whole: 1, fewest: 1, most: 1, drawn: 1, each: curve([5, 6, 7, 6, 5]), mean: curve([5, 6, 7, 6, 5]), sd: null },
  ],
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
    expect(whole!.startsWith("M64.0 ")).toBe(true);
    expect(/L546\.0 [\d.]+$/.test(whole!)).toBe(true);
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
    const trial = decode(simulated());
    const names = trial.summary.coordinates.map((c) => c.name);
    return { names, ...compare(trial, new View(wholeOf(trial.summary)), null, encoded(names[0]!)) };
  };
  it("is there where events mark cycles alone", () => {
    const { node } = made();
    expect(fake(node).all((e) => e.getAttribute("id") === "over-cycle").length).toBe(1);
    const trial = decode(simulated());
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
