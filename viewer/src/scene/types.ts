// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0

/** Packed series; src/kinemark/stages/report/README.md describes them. */
export interface PackedSeries {
  kind: "int16" | "float32";
  series: number;
  points: number;
  offset?: number[];
  step?: number[];
  data: string;
}

export interface PackedMarkers {
  positions_m: PackedSeries;
  states: string;
}

export interface PackedJoints {
  names: string[];
  links: [number, number][];
  centres_m: PackedSeries;
  roots_mm: PackedSeries;
  states: string;
}

/** Meshes of bodies; src/kinemark/stages/report/README.md describes them. */
export interface PackedMeshes {
  body: number[];
  points: number[];
  triangles: number[];
  positions_m: PackedSeries;
  corners: string;
  turn: PackedSeries;
}

export interface PackedBodies {
  names: string[];
  mass_kg: (number | null)[];
  origin_m: PackedSeries;
  end_m: PackedSeries;
  meshes?: PackedMeshes;
  meshes_note?: string;
}

export interface PackedCamera {
  name: string;
  centre_m: [number, number, number];
  right: [number, number, number];
  down: [number, number, number];
  forward: [number, number, number];
  half_view: [number, number];
  nominal: boolean;
}

/** What the space view of a page draws, as it stands in the page. */
export interface PackedScene {
  frame_step: number;
  points: number;
  /** null: nobody says. */
  up: [number, number, number] | null;
  up_from: string;
  names: string[];
  markers: PackedMarkers;
  model_m: PackedSeries | null;
  before: PackedMarkers | null;
  worst: string | null;
  plates: { type: number; corners_m: (number | null)[][] }[];
  forces: { name: string; force_n: PackedSeries; point_m: PackedSeries }[];
  bodies?: PackedBodies;
  skeleton?: PackedJoints;
  cameras?: PackedCamera[];
}
