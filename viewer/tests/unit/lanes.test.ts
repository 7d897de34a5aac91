// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { fake, FakeElement, install, nextFrame, type Drawn } from "../fake_dom.ts";
import { problemsOf } from "../../schema/problems.ts";
import { deflated } from "../packed.ts";
import { simulatedMarkers } from "../simulated_markers.ts";

install();
const { binsIn, LanePlot, rowHeight, trialAt } = await import("../../src/plots/lanes.ts");
const { lanesInWords, unpackLanes } = await import("../../src/sections/neural.ts");
const { View } = await import("../../src/view.ts");
const { palette } = await import("../../src/theme.ts");

const codes = (bytes: Uint8Array) => ({ kind: "codes" as const, data: deflated(bytes) });

/** Two units over 10 s in bins of 0.1 s; a trial from 2 to 4 s; a channel whose second bin holds nothing. */
function packed() {
  const one = new Uint8Array(100);
  one[20] = 1;
  one[50] = 3;
  return {
    start_s: 0,
    bin_s: 0.1,
    bins: 100,
    unit_count: 2,
    units: [
      { id: "7", spikes: 4, counts: codes(one) },
      { id: "9", spikes: 0, counts: codes(new Uint8Array(100)) },
    ],
    trials: [{ label: "side left", start_s: 2, stop_s: 4 }],
    fields: [
      {
        name: "lfp",
        unit: "volts",
        start_s: 0,
        bin_s: 5,
        bins: 2,
        channels: [{ name: "electrode 0", least: -1e-4, step: 1e-6, low: codes(Uint8Array.of(0, 255)), high: codes(Uint8Array.of(200, 255)) }],
      },
    ],
  };
}

async function make() {
  install();
  const lanes = await unpackLanes(packed());
  const view = new View([0, 10]);
  const plot = new LanePlot(new FakeElement("div") as unknown as HTMLElement, view, lanes);
  plot.draw();
  const canvas = fake(plot.canvas);
  const rects = (colour: string): number[][] =>
    canvas
      .getContext()
      .drawn.filter((d: Drawn) => d.what === "rect" && d.colour === colour)
      .map((d: Drawn) => d.numbers);
  return { lanes, view, plot, canvas, rects };
}

describe("lanes", () => {
  it("are counts and codes as the program packs them", async () => {
    const { lanes } = await make();
    expect(lanes.units[0]!.counts[50]).toBe(3);
    expect(lanes.fields[0]!.high[0]).toBe(200);
    expect(lanesInWords(lanes, 2)).toBe("2 units with 4 spikes, 1 trial, 1 channel of field potentials");
    expect(lanesInWords({ ...lanes, trials: [], fields: [] }, 900)).toContain("900 units with 4 spikes, the first 2 shown");
  });
  it("follow the schema of pages", () => {
    expect(problemsOf({ ...simulatedMarkers(), neural: packed() })).toEqual([]);
    expect(problemsOf({ ...simulatedMarkers(), neural: { ...packed(), bins: 0 } })).not.toEqual([]);
  });
  it("draw a mark where a unit fires, and an envelope where there are samples", async () => {
    const { rects } = await make();
    const marks = rects(palette().line);
    expect(marks.length).toBe(3);
    const gutter = marks[0]![0]! - 0.2 * (620 - (marks[0]![0]! - 0.2 * 620) / 0.8);
    expect(marks[1]![0]! - gutter).toBeCloseTo(0.5 * (620 - gutter), 6);
    expect(marks[2]![2]).toBeCloseTo(0.5 * (620 - gutter), 6);
  });
  it("say what lies at the time that is pointed at", async () => {
    const { view, plot } = await make();
    expect(plot.readout.textContent).toContain("Point at the raster");
    view.set({ focus: 2.05 });
    nextFrame();
    expect(plot.readout.textContent).toContain("trial 1 (side left)");
    expect(plot.readout.textContent).toContain("1 of 2 units fire within 100 ms");
    expect(plot.readout.textContent).toContain("electrode 0 \u2212100 to 100 uV");
    view.set({ focus: 8 });
    nextFrame();
    expect(plot.readout.textContent).not.toContain("trial");
    expect(plot.readout.textContent).not.toContain("electrode");
  });
  it("follow the range of the other plots", async () => {
    const { view, rects } = await make();
    view.set({ range: [4, 6] });
    nextFrame();
    const marks = rects(palette().line);
    expect(marks.at(-2)![0]).toBeGreaterThan(300);
    expect(marks.at(-2)![0]).toBeLessThan(400);
  });
  it("keep hundreds of units on a screen", () => {
    expect(rowHeight(1)).toBe(12);
    expect(rowHeight(240)).toBe(2);
    expect(rowHeight(5000)).toBe(2);
  });
  it("touch the bins of a range", () => {
    expect(binsIn(0.25, 0.35, 0, 0.1, 100)).toEqual([2, 4]);
    expect(binsIn(-5, -1, 0, 0.1, 100)).toEqual([0, 0]);
    expect(binsIn(20, 30, 0, 0.1, 100)).toEqual([100, 100]);
    const trials = [{ label: "", startS: 1, stopS: 2 }];
    expect(trialAt(trials, 1.5)).toBe(0);
    expect(trialAt(trials, 2.5)).toBe(-1);
  });
});
