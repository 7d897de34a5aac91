// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding, IkSensors, IkSummary } from "../page_types.ts";
import { el } from "../dom.ts";
import { duration, number, percent, plural } from "../format.ts";

export const tile = (value: string, label: string, detail: string): HTMLElement =>
  el("div", { class: "tile" }, el("dd", {}, value), el("dt", {}, label), el("dd", { class: "detail" }, detail));

/** Name of the trial beside the verdict. */
export function titleRow(
  what: string,
  trial: string,
  below: HTMLElement,
  { verdict, findings }: { verdict: "good" | "attention"; findings: readonly Finding[] },
): HTMLElement {
  const notes = findings.filter((f) => f.level === "note").length;
  const serious = findings.length - notes;
  return el(
    "div",
    { class: "title" },
    el("div", {}, el("p", { class: "brand" }, el("b", {}, "kinemark"), ` ${what}`), el("h1", {}, trial), below),
    el(
      "p",
      { class: `verdict ${verdict}`, id: "verdict" },
      el("b", {}, verdict === "good" ? "Good" : "Needs attention"),
      el(
        "span",
        {},
        [serious > 0 ? plural(serious, "problem") : "no problems", notes > 0 ? plural(notes, "note") : ""]
          .filter((t) => t !== "")
          .join(", "),
      ),
    ),
  );
}

/** The first tile of every report. */
export const framesTile = (frames: number, rateHz: number): HTMLElement =>
  tile(
    number(frames),
    "frames",
    `${duration(frames / rateHz)} at ${number(rateHz, Number.isInteger(rateHz) ? 0 : 2)} Hz`,
  );

/** The middle of the numbers that are known; null without any. */
export function medianOf(values: readonly (number | null | undefined)[]): number | null {
  const known = values.filter((v): v is number => typeof v === "number" && Number.isFinite(v)).sort((a, b) => a - b);
  const half = known.length / 2;
  return known.length === 0 ? null : (known[Math.floor(half - 0.5)]! + known[Math.floor(half)]!) / 2;
}

/** Trial, model, verdict, and the numbers that people look for first. */
export function header(summary: IkSummary, sensors: IkSensors | null = null): HTMLElement {
  const used = summary.markers.filter((m) => m.used).length;
  const asked = summary.coordinates.filter((c) => !c.locked).length;
  const locked = summary.coordinates.length - asked;
  const realTime = summary.frames_per_s === null ? null : summary.frames_per_s / summary.rate_hz;
  const sd = medianOf(summary.coordinates.filter((c) => !c.locked && c.unit === "deg").map((c) => c.median_sd));
  const besides = sensors === null ? "" : `, ${plural(sensors.rows.length, "sensor")} besides`;
  const alone = sensors !== null && summary.markers.length === 0;
  const solved = summary.status_frames.converged + summary.status_frames.underdetermined;
  return el(
    "header",
    {},
    titleRow(
      `joint angles by ${summary.method || "inverse kinematics"}`,
      summary.trial,
      el("p", { class: "model" }, "Model ", el("b", {}, summary.model)),
      summary,
    ),
    el(
      "dl",
      { class: "tiles" },
      framesTile(summary.frames, summary.rate_hz),
      tile(
        percent(summary.frames === 0 ? null : solved / summary.frames),
        "frames converged",
        solved === summary.frames ? "every frame" : `all but ${number(summary.frames - solved)}`,
      ),
      alone
        ? tile(number(sensors.rows.length), "sensors used", `heading ${number(sensors.heading_deg, 1)} deg${sensors.heading_sd_deg ? ` ± ${number(sensors.heading_sd_deg, 1)}` : ""}`)
        : tile(`${used} of ${summary.markers.length}`, "markers used", `${used === summary.markers.length ? "none left out" : `${summary.markers.length - used} left out`}${besides}`),
      tile(
        percent(summary.determined_fraction),
        "determined",
        `of ${plural(asked, "coordinate")}${locked > 0 ? `, ${locked} held fixed` : ""}`,
      ),
      alone
        ? tile(`${number(sensors.rms_deg, 2)} deg`, "RMS of sensors to model", `largest ${number(sensors.max_deg, 1)} deg`)
        : tile(`${number(summary.rms_error_mm, 1)} mm`, "RMS marker error", `largest ${number(summary.max_error_mm, 1)} mm`),
      tile(
        sd === null ? "–" : `${number(sd, 2)} deg`,
        "median SD of an angle",
        realTime === null ? "not timed" : `solved at ${number(realTime, realTime < 10 ? 1 : 0)} × real time`,
      ),
    ),
  );
}
