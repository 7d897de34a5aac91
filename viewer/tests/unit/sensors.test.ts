// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { decode, seenBy } from "../../src/decode.ts";
import { fake, FakeElement, install, nextFrame } from "../fake_dom.ts";
import FakePlot from "../fake_plot.ts";
import { inflated } from "../packed.ts";
import { hostile, simulated, simulatedSensors } from "../simulated.ts";

install();
vi.mock("uplot", () => ({ default: FakePlot }));
const { ikPage } = await import("../../src/pages/ik.ts");
const { gaps } = await import("../../src/sections/gaps.ts");
const { header } = await import("../../src/sections/header.ts");
const { sensorFacts, sensors } = await import("../../src/sections/sensors.ts");
const { View } = await import("../../src/view.ts");

const withId = (node: FakeElement, id: string): FakeElement => node.all((e) => e.getAttribute("id") === id)[0]!;
const column = (plot: FakePlot, k: number): (number | null)[] => plot.data[k] as (number | null)[];

describe("sensors", () => {
  const make = () => {
    install();
    FakePlot.made = [];
    const view = new View([0, 3.99]);
    const trial = decode(inflated(simulatedSensors(true)));
    const chosen = vi.fn();
    const made = sensors(trial, trial.sensors!, view, chosen);
    made.start();
    return { view, node: fake(made.node), plot: FakePlot.made[0]!, chosen };
  };
  const row = (node: FakeElement, name: string): FakeElement => node.tagged("tbody").at(-1)!.tagged("tr").find((r) => r.textContent.startsWith(name))!;
  it("draw the chosen one beside all of them, and stop when it is chosen again", () => {
    const { view, node, plot, chosen } = make();
    expect(plot.axes[1]!.label).toBe("angle (deg)");
    expect(column(plot, 1)[100]).toBeCloseTo(8.7, 4);
    expect(column(plot, 2).every((v) => v === null)).toBe(true);
    row(node, "shank_imu").fire("click");
    nextFrame();
    expect(view.sensor).toBe(1);
    expect(chosen).toHaveBeenLastCalledWith(1);
    expect(column(plot, 2)[100]).toBe(12);
    expect(column(plot, 2)[230]).toBeNull();
    row(node, "shank_imu").fire("click");
    expect([view.sensor, chosen.mock.lastCall]).toEqual([-1, [-1]]);
  });
  it("say in a table what was seen and left out, and jump to the largest angle", () => {
    const { view, node } = make();
    expect(row(node, "shank_imu").textContent).toContain("shankthe pose851");
    expect(row(node, "trunk").textContent).toContain(hostile);
    node.classed("jump").find((b) => b.textContent === "12.0")!.fire("click");
    expect([view.sensor, view.focus]).toEqual([1, 1]);
  });
  it("read both angles under the pointer", () => {
    const { view, node } = make();
    const readout = (): string => {
      nextFrame();
      return withId(node, "sensor-readout").textContent;
    };
    expect(readout()).toContain("Choose a sensor");
    view.set({ pointer: 1, sensor: 1 });
    expect(readout()).toBe("1.000 s: All sensors, RMS 8.70 deg  shank_imu 12.00 deg");
    view.set({ pointer: 2.3 });
    expect(readout()).toBe("2.300 s: All sensors, RMS 3.50 deg  shank_imu not used");
  });
});

describe("facts of the sensors", () => {
  const facts = simulatedSensors(true).sensors!;
  it("say how they were placed and what the heading follows from", () => {
    expect(sensorFacts(facts)).toEqual([
      ["Placed on their bodies", "2 by the pose"],
      ["Largest turn within the pose", "0.75 deg"],
      ["Heading of the sensors' world", "30.0 deg ± 0.50 deg (1 SD), estimated from the motion"],
      ["Noise about each axis", "not known"],
    ]);
  });
  it("claim no pose and no deviation where there is none", () => {
    const rows = facts.rows.map((r) => ({ ...r, placed_by: "model" }));
    expect(sensorFacts({ ...facts, rows, heading_from: "model", noise_sd_deg: 1.234 })).toEqual([
      ["Placed on their bodies", "2 by the model"],
      ["Heading of the sensors' world", "that of the angles: the model places the sensors"],
      ["Noise about each axis", "1.23 deg"],
    ]);
    expect(sensorFacts({ ...facts, heading_sd_deg: 0, heading_from: "facing axis" })[2]![1]).toBe("30.0 deg, given by the axis that faces forward");
  });
});

describe("a page of sensors", () => {
  it("alone has no section of markers and speaks of sensors", async () => {
    const page = await ikPage(inflated(simulatedSensors(true)));
    const ids = page.sections.map((s) => fake(s).getAttribute("id"));
    expect(ids).toContain("sensors");
    expect(ids).not.toContain("markers");
    expect(ids).not.toContain("worst");
    const text = page.sections.map((s) => fake(s).textContent).join(" ");
    expect(text).toContain("the sensors do not fix the coordinate there");
    expect(text).not.toContain("visible markers");
    const tiles = fake(page.header).textContent;
    expect(tiles).toContain("2sensors used");
    expect(tiles).toContain("3.60 degRMS of sensors to model");
    expect(tiles).not.toContain("marker");
  });
  it("beside markers has both", async () => {
    const page = await ikPage(inflated(simulatedSensors(false)));
    const ids = page.sections.map((s) => fake(s).getAttribute("id"));
    expect(ids).toEqual(expect.arrayContaining(["markers", "sensors", "worst"]));
    expect(fake(page.header).textContent).toContain("2 sensors besides");
  });
  it("of markers alone has none", async () => {
    const page = await ikPage(inflated(simulated()));
    expect(page.sections.map((s) => fake(s).getAttribute("id"))).not.toContain("sensors");
    expect(fake(header(simulated().summary)).textContent).not.toContain("sensor");
    expect(seenBy(decode(inflated(simulated())))).toBe("visible markers");
  });
  it("has a row of the map of gaps for each sensor", () => {
    const names = (data: ReturnType<typeof simulated>): string => {
      const trial = decode(inflated(data));
      return fake(gaps(trial, new View([0, 3.99])).node).textContent;
    };
    expect(names(simulatedSensors(true))).toContain("Where each sensor's samples come from");
    expect(names(simulatedSensors(false))).toContain("each marker's and each sensor's");
    expect(names(simulated())).toContain("Where each marker's samples come from");
  });
});
