// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { MapKind } from "./plots/gap_map.ts";
import { palette } from "./theme.ts";

/** Where a sample comes from; the codes of a page, the worse the larger. */
export const stateNames = ["measured", "upsampled", "interpolated", "model_filled", "missing", "rejected"] as const;
export type StateName = (typeof stateNames)[number];

/** The same for people. */
export const stateWords = [
  "measured",
  "made by the recorder",
  "interpolated from its own path",
  "filled from other markers",
  "missing",
  "rejected",
] as const;

/** From this code on there are no coordinates. */
export const firstAbsent = 4;

export const stateKind: MapKind = { group: "state", words: stateWords, colours: () => palette().states };
