// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding, MarkersSummary } from "../page_types.ts";
import { el } from "../dom.ts";
import { number, percent, plural } from "../format.ts";
import { absent, filledIn, total } from "./clean_header.ts";
import { framesTile, tile, titleRow } from "./header.ts";

/** What a recording holds, in six numbers. */
export function markersHeader(summary: MarkersSummary): HTMLElement {
  const sum = (count: (m: MarkersSummary["markers"][number]) => number): number => summary.markers.reduce((n, m) => n + count(m), 0);
  const samples = sum((m) => total(m.states));
  const share = (n: number): string => percent(samples === 0 ? null : n / samples);
  const made = sum((m) => filledIn(m.states) + m.states.upsampled);
  const missing = sum((m) => absent(m.states));
  const named = summary.markers.filter((m) => m.labelled).length;
  const never = summary.markers.filter((m) => absent(m.states) === total(m.states)).length;
  const below = [summary.format, summary.software].filter((t) => t !== "").join(", written by ");
  return el(
    "header",
    {},
    titleRow("recording", summary.trial, el("p", { class: "model" }, below), {
      verdict: summary.verdict,
      findings: summary.groups.map((g): Finding => ({ level: g.level, about: "", subject: "", text: g.title, time_s: null })),
    }),
    el(
      "dl",
      { class: "tiles" },
      tile(number(summary.markers.length), summary.markers.length === 1 ? "marker" : "markers", named === summary.markers.length ? "all named" : `${number(named)} named`),
      summary.rate_known ? framesTile(summary.frames, summary.rate_hz) : tile(number(summary.frames), "frames", "rate not known"),
      tile(share(sum((m) => m.states.measured)), "measured", `of ${plural(samples, "sample")}`),
      tile(share(made), "filled", `${plural(made, "sample")}`),
      tile(share(missing), "missing", never === 0 ? `${plural(sum((m) => m.gaps), "gap")}` : `${plural(never, "marker")} never seen`),
      tile(number(summary.channel_count), summary.channel_count === 1 ? "channel" : "channels", `${plural(summary.event_count, "event")}`),
    ),
  );
}
