// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanSummary, StateCounts } from "../page_types.ts";
import { el } from "../dom.ts";
import { number, percent, plural } from "../format.ts";
import { framesTile, medianOf, tile, titleRow } from "./header.ts";

export const total = (c: StateCounts): number => Object.values(c).reduce((sum, n) => sum + n, 0);
/** Samples that somebody made: by interpolation or from other markers. */
export const filledIn = (c: StateCounts): number => c.interpolated + c.model_filled;
export const absent = (c: StateCounts): number => c.missing + c.rejected;

/** Trial, methods, verdict, and the numbers that people look for first. */
export function cleanHeader(summary: CleanSummary): HTMLElement {
  const { markers, before, after } = summary;
  const samples = total(after);
  const share = (n: number): string => percent(samples === 0 ? null : n / samples);
  const open = markers.reduce((sum, m) => sum + m.gaps_open, 0);
  const filled = markers.reduce((sum, m) => sum + m.gaps_filled, 0);
  const noises = markers.map((m) => m.noise_sd_mm);
  const speed = summary.clean_s === null || summary.clean_s <= 0 ? null : summary.frames / summary.rate_hz / summary.clean_s;
  return el(
    "header",
    {},
    titleRow(
      "cleaned markers",
      summary.trial,
      el("p", { class: "model" }, "Gaps ", el("b", {}, summary.gap_method), ", filter ", el("b", {}, summary.filter_method)),
      summary,
    ),
    el(
      "dl",
      { class: "tiles" },
      framesTile(summary.frames, summary.rate_hz),
      tile(number(markers.length), markers.length === 1 ? "marker" : "markers", `${plural(markers.filter((m) => m.white === true).length, "white residual")}`),
      tile(share(before.measured), "measured", `${number(before.measured)} of ${plural(samples, "sample")}`),
      tile(share(filledIn(after)), "filled in", `${plural(filled, "gap")}, ${plural(filledIn(after), "sample")}`),
      tile(share(absent(after)), "left missing", `${plural(open, "gap")} left open`),
      tile(
        `${number(medianOf(noises), 2)} mm`,
        "median noise SD",
        speed === null ? "per axis" : `cleaned at ${number(speed, speed < 10 ? 1 : 0)} × real time`,
      ),
    ),
  );
}
