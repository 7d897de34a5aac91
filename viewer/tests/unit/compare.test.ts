// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { IkPage } from "../../src/page_types.ts";
import { describe, expect, it, vi } from "vitest";
import FakePlot from "../fake_plot.ts";
import { fake, install } from "../fake_dom.ts";
import { inflated } from "../packed.ts";
import { simulated } from "../simulated.ts";

vi.mock("uplot", () => import("../fake_plot.ts"));
install();
const { decode } = await import("../../src/decode.ts");
const { pairsOf } = await import("../../src/pairs.ts");
const { compare, dataOfPage, differences, onClock } = await import("../../src/sections/compare.ts");
const { View, wholeOf } = await import("../../src/view.ts");

describe("pairsOf", () => {
  it("puts both sides together, whatever words they use, and leaves the rest as it is", () => {
    const names = ["pelvis_tx", "hip_r", "hip_l", "RKnee", "LKnee", "left_wrist", "right_wrist", "lumbar"];
    expect(pairsOf(names)).toEqual([
      { title: "pelvis_tx", right: 0, left: -1 },
      { title: "hip", right: 1, left: 2 },
      { title: "Knee", right: 3, left: 4 },
      { title: "wrist", right: 6, left: 5 },
      { title: "lumbar", right: 7, left: -1 },
    ]);
  });
  it("does not take a name for a side that has no other", () => {
    expect(pairsOf(["arm_r", "roll"]).map((p) => [p.title, p.left])).toEqual([["arm_r", -1], ["roll", -1]]);
  });
});

describe("onClock", () => {
  it("takes the nearest sample, and nothing where there is none near", () => {
    const values = Float32Array.from([10, 20, 30]);
    const on = onClock(Float64Array.from([0, 0.9, 2, 5]), Float64Array.from([0, 1, 2]), values);
    expect([...on]).toEqual([10, 20, 30, NaN]);
  });
});

describe("dataOfPage", () => {
  const page = (data: unknown): string => `<html><script type="application/json" id="kinemark-data">${JSON.stringify(data).replaceAll("<", "\\u003c")}</script></html>`;
  it("reads the data of a page of joint angles", () => {
    expect(dataOfPage(page(simulated())).summary.frames).toBe(400);
  });
  it("says what is wrong with others", () => {
    expect(() => dataOfPage("<p>")).toThrow("no page of kinemark");
    expect(() => dataOfPage(page(null))).toThrow("not one of joint angles");
    expect(() => dataOfPage(page({ summary: { schema: "kinemark.clean_report" } }))).toThrow("not one of joint angles");
  });
});

describe("differences", () => {
  it("are 0 of a result and itself, and what was added of another", () => {
    const a = decode(inflated(simulated()));
    const b = decode(inflated(simulated()));
    expect(differences(a, b)).toBe("angles 0.00 deg apart RMS");
    for (const c of b.coordinates) c.value = c.value.map((v) => v + 2);
    expect(differences(a, b)).toBe("angles 2.00 deg apart RMS");
    b.summary.coordinates.forEach((c) => (c.name += "?"));
    expect(differences(a, b)).toBe("none of them angles at the same times");
  });
});

describe("compare", () => {
  const withTorques = (): IkPage => {
    const data = simulated();
    data.summary.mass_kg = 50;
    data.series.torques = data.series.coordinates.map((c) => ({ value: c.value, sd: null }));
    return data;
  };
  it("draws a plot for each chosen coordinate, with torques per kg where asked", () => {
    FakePlot.made = [];
    const trial = decode(inflated(withTorques()));
    const section = compare(trial, new View(wholeOf(trial.summary)));
    section.start();
    expect(FakePlot.made.length).toBe(Math.min(4, trial.summary.coordinates.length));
    const middle = (): number => (FakePlot.made[0]!.data[3] as number[])[50]!;
    const angle = middle();
    const buttons = fake(section.node).tagged("button");
    buttons.find((b) => b.textContent === "Torques")!.fire("click");
    expect(middle()).toBeCloseTo(angle, 5);
    buttons.find((b) => b.textContent.startsWith("per kg"))!.fire("click");
    expect(middle()).toBeCloseTo(angle / 50, 5);
    expect(FakePlot.made[0]!.axes[1]!.label).toMatch(/N m\/kg/);
  });
  it("offers no torques where none were computed", () => {
    const trial = decode(inflated(simulated()));
    const node = fake(compare(trial, new View(wholeOf(trial.summary))).node);
    expect(node.tagged("button").map((b) => b.textContent)).not.toContain("Torques");
  });
});
