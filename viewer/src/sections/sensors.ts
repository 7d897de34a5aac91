// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { IkSensors, SensorSummary } from "../page_types.ts";
import { withBreaks } from "../band.ts";
import { framesOfPair } from "../curves.ts";
import type { SensorCurves, Trial } from "../decode.ts";
import { nearest } from "../downsample.ts";
import { el, section } from "../dom.ts";
import { number, percent, plural, seconds } from "../format.ts";
import { TimePlot } from "../plots/time_plot.ts";
import { palette } from "../theme.ts";
import type { View } from "../view.ts";
import { barCell, nameCell } from "./cells.ts";
import { plain } from "./settings.ts";
import { sortableTable } from "./table.ts";

const headings: Record<string, string> = {
  motion: "estimated from the motion",
  markers: "estimated from markers and sensors",
  "facing axis": "given by the axis that faces forward",
};
const placings: Record<string, string> = { pose: "the pose", model: "the model", markers: "markers" };

/** How the sensors were placed, their heading, their noise. */
export function sensorFacts(facts: IkSensors): [string, string][] {
  const count = (by: string): string => {
    const rows = facts.rows.filter((r) => r.placed_by === by).length;
    return rows === 0 ? "" : `${number(rows)} by ${placings[by] ?? by}`;
  };
  const placed = Object.keys(placings).map(count).filter((words) => words !== "").join(", ");
  const byPose = facts.rows.some((r) => r.placed_by === "pose");
  const sd = facts.heading_sd_deg;
  return [
    ["Placed on their bodies", placed === "" ? "–" : placed],
    ...(byPose ? [["Largest turn within the pose", `${number(facts.pose_drift_deg, 2)} deg`] as [string, string]] : []),
    [
      "Heading of the sensors' world",
      facts.heading_from === "model" ? "that of the angles: the model places the sensors" : `${number(facts.heading_deg, 1)} deg${sd === null || sd === 0 ? "" : ` ± ${number(sd, 2)} deg (1 SD)`}, ${headings[facts.heading_from] ?? facts.heading_from}`,
    ],
    ["Noise about each axis", facts.noise_sd_deg === null ? "not known" : `${number(facts.noise_sd_deg, 2)} deg`],
  ];
}

/** How far the model's bodies are turned from what their sensors say: over time, and in a table. */
export function sensors(trial: Trial, curves: SensorCurves, view: View, chosen: (sensor: number) => void): { node: HTMLElement; start: () => void } {
  const { facts } = curves;
  const indexOf = new Map(facts.rows.map((r, i) => [r, i]));
  const largest = Math.max(1e-9, ...facts.rows.map((r) => r.rms_deg ?? 0));
  const box = el("div", { class: "plot", id: "sensor-plot" });
  const readout = el("p", { class: "readout", id: "sensor-readout" });
  const choose = (r: SensorSummary): void => {
    const i = indexOf.get(r)!;
    const next = i === view.sensor ? -1 : i;
    view.set({ sensor: next });
    chosen(next);
  };
  const jump = (r: SensorSummary): Node => {
    const text = number(r.max_deg, 1);
    const time = r.max_time_s;
    if (time === null) return document.createTextNode(text);
    const click = (event: Event): void => {
      event.stopPropagation();
      view.set({ sensor: indexOf.get(r)! });
      view.jumpTo(time, "sensors");
    };
    return el("button", { type: "button", class: "jump plain", title: `Show ${seconds(time)}`, click }, text);
  };
  const table = sortableTable<SensorSummary>(
    "Misses per sensor",
    [
      { title: "Sensor", key: (r) => r.name, cell: (r) => nameCell(r.name) },
      { title: "Body", key: (r) => r.body, cell: (r) => r.body },
      { title: "Placed by", key: (r) => r.placed_by, cell: (r) => placings[r.placed_by] ?? r.placed_by },
      { title: "Seen", unit: "%", numeric: true, key: (r) => r.seen_frames, cell: (r) => percent(trial.summary.frames === 0 ? null : r.seen_frames / trial.summary.frames).replace(" %", "") },
      { title: "Left out", unit: "samples", numeric: true, key: (r) => r.rejected_samples, cell: (r) => number(r.rejected_samples) },
      { title: "RMS", unit: "deg", numeric: true, key: (r) => r.rms_deg, cell: (r) => barCell(r.rms_deg, largest) },
      { title: "Largest", unit: "deg", numeric: true, key: (r) => r.max_deg, cell: jump },
    ],
    facts.rows,
    { column: 5, direction: "descending" },
    choose,
  );

  function show(): void {
    const t = view.pointer ?? view.focus;
    const i = t === null ? -1 : nearest(trial.time, t);
    const name = facts.rows[view.sensor]?.name;
    const rms = el("span", { class: "key rms" }, "All sensors, RMS");
    const one = name === undefined ? null : el("span", { class: "key one" }, name);
    const value = (v: number | undefined): string => (v === undefined || Number.isNaN(v) ? " not used" : ` ${number(v, 2)} deg`);
    if (i < 0) {
      readout.replaceChildren(rms, "  ", one ?? "Choose a sensor in the table to see it beside the others.");
      return;
    }
    readout.replaceChildren(`${seconds(trial.time[i]!)}: `, rms, value(curves.rmsDeg[i]), "  ");
    if (one !== null) readout.append(one, value(curves.errorDeg[view.sensor]?.[i]));
  }

  function start(): void {
    const plot = new TimePlot(box, view, {
      label: "Angle between sensors and model over time: all sensors together and the chosen one",
      height: 220,
      series: [
        { stroke: (dense) => (dense ? palette().dense : palette().line), width: 1.6 },
        { stroke: () => palette().second, width: 1.4 },
      ],
      unit: () => "angle (deg)",
      precision: () => ({ step: curves.stepDeg[Math.max(0, view.sensor)] ?? null, framesOfPair: framesOfPair(trial.frameStep) }),
      fromZero: true,
      hatched: () => [],
    });
    let drawn = -2;
    const rms = withBreaks(curves.rmsDeg);
    const nothing = rms.map(() => null);
    const update = (): void => {
      if (view.sensor !== drawn) {
        drawn = view.sensor;
        const series = curves.errorDeg[drawn];
        plot.setData([trial.time, rms, series === undefined ? nothing : withBreaks(series)]);
        table.mark((r) => indexOf.get(r) === drawn);
      }
      show();
    };
    view.onChange(update);
    update();
  }

  const node = section(
    "sensors",
    "Sensors",
    `Angle between what each inertial sensor says of its body and how the model turns it. ${plural(facts.rows.length, "sensor")}, ${number(facts.rms_deg, 2)} deg RMS, ${number(facts.max_deg, 1)} deg at most.`,
    plain("Calibration and heading", ["What", "Value"], sensorFacts(facts)),
    readout,
    box,
    table.node,
  );
  return { node, start };
}
