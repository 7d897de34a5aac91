// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Made-up results of every kind that a result page shows.
import type { CalibrateResult, GaitResult, Joint, JointsResult, MeasuresResult, PackedScene, ReconstructResult, ResultPage, ResultSummary, ScaleResult, StudyResult } from "../src/page_types.ts";
import { hostile } from "./simulated.ts";
import { deflated } from "./packed.ts";
import { pack, simulatedMarkers } from "./simulated_markers.ts";

const frames = 200;

const summaryOf = <Kind extends ResultSummary["kind"]>(kind: Kind, more: Partial<ResultSummary> = {}): ResultSummary & { kind: Kind } => ({
  schema: "kinemark.result_report",
  schema_version: 1,
  trial: `${kind} ${hostile}`,
  verdict: "attention",
  version: "0.1.0",
  command_line: `kinemark ${kind} in.c3d --report page.html`,
  groups: [
    { level: "attention", title: "1 quality check missed", items: [{ level: "attention", about: "gate", subject: "g", text: `too far ${hostile}`, time_s: null }] },
    { level: "note", title: "2 remarks", items: ["first", "second"].map((text) => ({ level: "note" as const, about: "warning", subject: "", text, time_s: null })) },
  ],
  inputs: [{ role: "recording", path: "in.c3d", bytes: 1234, hash: "00ff", hash_kind: "XXH3-64" }],
  clock: null,
  ...more,
  kind,
});

const clock = { frames, rate_hz: 100, first_time_s: 1, first_frame: 101 };

/** Where joint j is in frame f, m. */
export const centreOf = (j: number, f: number): [number, number, number] => [0.4 * j, 0.2 + 0.05 * Math.sin(0.05 * f), 0.6 + 0.1 * j];

/** Two joints; the second is not placed in frames 50 to 99. */
export function sceneOfJoints(): PackedScene {
  const line = (value: (f: number) => number): number[] => Array.from({ length: frames }, (_, f) => value(f));
  const states = new Uint8Array(2 * frames).fill(3);
  states.fill(0, frames + 50, frames + 100);
  return {
    ...simulatedMarkers(frames).scene,
    skeleton: {
      names: ["elbow", hostile],
      links: [[0, 1]],
      centres_m: pack([0, 1].flatMap((j) => [0, 1, 2].map((k) => line((f) => centreOf(j, f)[k]!)))),
      roots_mm: pack([0, 1].flatMap((j) => [2 + j, 0, 3, 0, 0, 8].map((v) => line(() => v))), 1e-2),
      states: deflated(states),
    },
  };
}

export const cameraAt = (name: string, x: number, nominal = false): NonNullable<PackedScene["cameras"]>[number] => ({
  name, centre_m: [x, -2, 1], right: [1, 0, 0], down: [0, 0, -1], forward: [0, 1, 0], half_view: [0.35, 0.35], nominal,
});

const covariance: Joint["covariance_in_parent_m2"] = [[1e-6, 0, 0], [0, 4e-6, 0], [0, 0, 9e-6]];

/** What a joint has besides that the page shows. */
const besides = {
  centre_in_child_m: null, covariance_in_child_m2: null, repeatability_in_parent_m2: null, repeatability_in_child_m2: null,
  accuracy_sd_m: null, repeatability_sd_m: null, prior_share: null, source: null,
  skin: { verdict: "untested", words: "", movements: 0, alike: 0, p_value: null, explained: null, own_slide_m_per_rad: null, own_slide_limit_m_per_rad: null, gap_with_posture_m: null },
};

const joints: JointsResult = {
  schema: "kinemark.skeleton", schema_version: 2, version: "0.1.0", command: "kinemark joints in.c3d", input: { path: "in.c3d", xxh3_64: "00ff" },
  warnings: [], notes: [], left_out: [], slips: [],
  frames, first_frame: 101, rate_hz: 100, noise_sd_m: 0.0004, method: "articulated",
  segments: [{ name: "upper arm", kind: "solid", markers: [{ name: hostile, x_in_segment_m: [0.1, 0, 0] }] }, { name: "forearm", kind: "solid", markers: [] }],
  joints: [
    { ...besides, name: "elbow", kind: "hinge", parent: "upper arm", child: "forearm", method: "articulated", words: "a hinge; the motion does not show where along its axis the centre lies", range_of_motion_deg: 92, centre_in_parent_m: [0.01, -0.28, 0], covariance_in_parent_m2: covariance, axis_in_parent: [0, 0, 1], axis_sd_deg: 0.8, centre_sd_m: 0.0037, centre_sd_across_axis_m: 0.0022, frames: { determined: 180, bridged: 20, ambiguous: 0, undetermined: 0 } },
    { ...besides, name: hostile, kind: "ball", parent: "forearm", child: "upper arm", method: "articulated", words: "not found", range_of_motion_deg: null, centre_in_parent_m: null, covariance_in_parent_m2: null, centre_sd_m: null, frames: { determined: 150, bridged: 0, ambiguous: 0, undetermined: 50 } },
  ],
  lengths: [{ name: "elbow to wrist", from: "elbow", to: "wrist", length_m: 0.27, sd_m: 0.002 }],
};

const scale: ScaleResult = {
  format: "kinemark-scale", version: 1, program: "0.1.0", command: "kinemark scale", exit_status: 0, notes: [], clavicles: [], joints: [], lost: [],
  model: "gait2354", mass_kg: 71.4, factors: { pelvis: [1.02, 0.98, 1.0], femur_r: [1.05, 1.05, 1.05] },
  muscles: [{ name: "soleus", ratio: 1.04, before_m: 0.3, after_m: 0.312, straight_for_wrapped: false }],
  measurements: [{ name: "thigh", factor: 1.05, pairs: [{ markers: ["A", "B"], measured_m: 0.42, measured_sd_m: 0.001, model_m: 0.4 }] }],
  placed: { rms_m: 0.012, not_in_static_trial: ["Top.Head"], markers: [{ name: "A", body: "pelvis", before_in_body_m: [0, 0, 0], after_in_body_m: [0.01, 0, 0], error_m: 0.013, fixed: false }, { name: "B", body: "femur_r", before_in_body_m: [0, 0, 0], after_in_body_m: [0, 0, 0], error_m: 0.004, fixed: true }] },
  motion: {
    frames: 400, iterations: 7, converged: true, rms_before_m: 0.021, rms_after_m: 0.009, noise_sd_m: 0.005, soft_tissue_sd_m: 0.004, not_determined: ["head"], recommendations: [],
    lengths: [{ name: "thigh", initial_m: 0.4, length_m: 0.42, sd_m: 0.004, determined: true }],
    parameters: [
      { name: "thigh", kind: "size", initial: 1, value: 1.05, sd: 0.01, prior_sd: 0.1, determined: true },
      { name: "head", kind: "size", initial: 1, value: 1, sd: 0.1, prior_sd: 0.1, determined: false },
      { name: "A.x", kind: "marker place", initial: 0.1, value: 0.11, sd: 0.002, prior_sd: 0.01, determined: true },
    ],
  },
};

const calibrate: CalibrateResult = {
  method: "bundle", warnings: [], chi2_per_dof: 1.02, warp_degree: 10, poses: 300, sightings: 1800, outliers: 2, side_rms_mm: 0.31,
  alignment: { aligned: false, next: "Pan camera B by 2.1 deg to the right.", cameras: [{ camera: "A", right_down_forward_mm: [0, 0, 0], right_down_forward_sd_mm: [0, 0, 0], tilt_pan_roll_deg: [0, 0, 0], tilt_pan_roll_sd_deg: [0, 0, 0] }, { camera: "B", right_down_forward_mm: [4, -2, 12], right_down_forward_sd_mm: [1, 1, 2], tilt_pan_roll_deg: [0.1, 2.1, -0.3], tilt_pan_roll_sd_deg: [0.05, 0.05, 0.1] }] },
  cameras: [{ name: "A", centre_mm: [-500, -2000, 1000], centre_sd_mm: [0.5, 0.4, 1], rotation_sd_deg: [0.01, 0.01, 0.02] }, { name: "B", centre_mm: [500, -2000, 1000], centre_sd_mm: null, rotation_sd_deg: null }],
};

const reconstruct: ReconstructResult = {
  method: "smoother", frames, written: "points.csv", warnings: [],
  leds: [{ name: "hand", frames, located: 195, occluded: 5, saturated: 0, inconsistent: 0, near_edge: 3, chi2_per_dof: 1.01, cutoff_hz: 12 }, { name: "lost", frames, located: 0, occluded: 200, saturated: 0, inconsistent: 0, near_edge: 0 }],
  precision: [{ axes: [0, 2], first_m: [-0.2, 0], cell_m: 0.1, columns: 4, rows: 2, sd_mm: [1, 2, 3, 4, 5, null, 6, 7], samples: [9, 9, 9, 9, 9, 0, 9, 9] }, null],
};

const study: StudyResult = {
  title: "Study", description: `a < b ${hostile}`, classic: "1986 method", columns: "paper: as published; bound: what is asked of ours", seeds: [1, 2, 3, 7], pass: false,
  rows: [
    { quantity: "scatter", unit: "mm", paper: 1, classic: 0.8, ours: 0.43, expected: 0.41, expected_is: "Cramer-Rao bound", bound: 0.5, pass: true },
    { quantity: `share ${hostile}`, unit: "%", paper: null, classic: null, ours: 60, expected: 68.3, expected_is: "right value", bound: [62, 78], pass: false },
    { quantity: "ratio", unit: "1", paper: null, classic: null, ours: 1.05, expected: null, expected_is: null, bound: null, pass: null },
  ],
  figures: [
    { caption: `Paths ${hostile}`, body: '<svg viewBox="0 0 640 400" width="640" height="400"><path class="axis" d="M40 20V360H620"/><path d="M40 300L620 60" stroke="#1f5fa8" fill="none" onclick="alert(1)"/><text x="60" y="40">z, mm</text><script>alert(1)</script></svg><p>Words <b>below</b><img src=x onerror=alert(1)></p>' },
  ],
};

const measured = (measure: string, title: string, shown: string, value: number | null, more: Partial<MeasuresResult["measures"][number]> = {}): MeasuresResult["measures"][number] => ({
  measure, title, shown, value, subject: "RFIN", start_s: 0, end_s: 2, unit: "mm", sd: null, uncorrected: null, interval: { kind: value === null ? "none" : "two-sided", low: value, high: value, level: 0.95, approximate: false }, share_not_measured: 0.02, method: "refits, 99, seed 1", ...more,
});

const measures: MeasuresResult = {
  heading: `Paths ${hostile}`, rows: "Marker", markers: 2, regions: 2, level: 0.95, refits: 99, most_not_measured: 0.125,
  measures: [
    measured("path_length", "Path length", "1340.1 [1339.0 to 1341.2] mm", 1340.1, { region: "reach" }),
    measured("box_long", `Box ${hostile}`, "340 [about 339 to 342] mm", 340, { subject: `LFIN ${hostile}`, interval: { kind: "two-sided", low: 339, high: 342, level: 0.95, approximate: true } }),
    measured("onset", "Onset", "not determined", null, { remark: "it moves from the first sample on", share_not_measured: null }),
  ],
  figures: [
    { name: "RFIN_path", caption: `RFIN: path ${hostile}`, body: '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 400" width="640" height="400"><rect width="640" height="400" fill="#ffffff"/><path d="M40 300L620 60" stroke="#0072b2" fill="none" onclick="alert(1)"/><text x="60" y="40" font-size="14">time (s)</text></svg>' },
  ],
};

const gait: GaitResult = {
  feet: [{ cycles: 3, in_words: "Left: 3 cycles, toe-off at 60.0 ± 0.8 % (0.66 s)" }, { cycles: 1, in_words: "Right: 1 cycle, toe-off at 61.0 % (0.67 s)" }],
  angles_from: `Plug-in Gait ${hostile}`, treadmill: true, level: 0.95, norm_sources: ["B"], curve_norm: "A book (mean ± 2 SD at each point)", own_error: true,
  figures: [{ name: "gait_kinematics", caption: `Kinematics ${hostile}`, body: measures.figures[0]!.body }],
  measures: [
    { title: "Stride time", region: "", unit: "s", value: ["1.00 [0.99 to 1.01]", "1.25", ""], judgement: ["below", "within", ""], norm: "1.1 to 1.3" },
    { title: `Speed ${hostile}`, region: "", unit: "m/s", value: ["", "", "1.31"], judgement: ["", "", ""], norm: "" },
  ],
  deviation: { scores: [{ title: "Knee flexion", value_deg: [6.1, null] }], side_deg: [7.2, null], both_deg: null, lacking: ["Hip rotation"] },
  events: [{ foot: "Left", event: "Foot Strike", time_s: 0.5, sd_s: 0.012, by: "markers" }, { foot: "Right", event: "Foot Off", time_s: 0.62, sd_s: null, by: `file ${hostile}` }],
};

/** Pages of results, by kind. */
export const simulatedResults = (): Record<ResultSummary["kind"], ResultPage> => ({
  joints: { summary: summaryOf("joints", { clock }), result: joints, scene: sceneOfJoints() },
  scale: { summary: summaryOf("scale"), result: scale, scene: null },
  calibrate: { summary: summaryOf("calibrate", { clock }), result: calibrate, scene: { ...simulatedMarkers(frames).scene, cameras: [cameraAt("A", -0.5), cameraAt("B", 0.5), cameraAt("B", 0.52, true)] } },
  reconstruct: { summary: summaryOf("reconstruct", { clock }), result: reconstruct, scene: { ...simulatedMarkers(frames).scene, cameras: [cameraAt("A", -0.5), cameraAt("B", 0.5)] } },
  study: { summary: summaryOf("study"), result: study, scene: null },
  measures: { summary: summaryOf("measures"), result: measures, scene: null },
  gait: { summary: summaryOf("gait"), result: gait, scene: null },
});
