// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Camera } from "./camera.ts";
import type { Plane } from "./plane.ts";

/** What the picture shows besides the scene. */
export interface Look {
  camera: Camera;
  point: number;
  picked: number;
  /** Markers whose path is drawn. */
  trailOf: readonly number[];
  /** Points before and after the instant that a trail covers. */
  trail: [before: number, after: number];
  lines: boolean;
  /** The recording before it was cleaned, or the markers of the model. */
  others: boolean;
  hidden: (marker: number) => boolean;
  /** How many times as large as it is the region of a joint centre is drawn; 0: not at all. */
  regions: number;
  /** The bodies of a model. */
  bodies: boolean;
  /** Goals of a model that follows a source. */
  goals?: boolean;
  /** Lines of sight. */
  rays: boolean;
  /** Share of the depth of the scene that is cut away in front, 0 to 1. */
  cut: number;
  /** The plane that fits a path best; null: none. */
  plane: Plane | null;
}
