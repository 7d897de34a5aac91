// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { CleanGap, CleanMarker, CleanSummary } from "../page_types.ts";
import { el } from "../dom.ts";
import { number, plural } from "../format.ts";
import { autocorrelationChart, spectrumChart } from "../plots/small_charts.ts";
import { plain } from "./settings.ts";
import { sortableTable } from "./table.ts";

const noiseWords: Record<string, string> = {
  given: "as given",
  covariance: "from the covariances that came with the data",
  data: "as found in the data",
};

const times = (factors: readonly (number | null)[]): string => factors.map((f) => `${number(f, 2)}`).join(", ");

/** What was done to a marker and why, in sentences. */
export function why(m: CleanMarker): HTMLElement {
  const facts: string[] = [];
  if (m.noise_sd_mm !== null) facts.push(`Noise ${number(m.noise_sd_mm, 3)} mm per axis, ${noiseWords[m.noise_from] ?? m.noise_from}.`);
  if (m.residual_rms_mm !== null) facts.push(`The filter took away ${number(m.residual_rms_mm, 3)} mm (RMS per axis).`);
  facts.push(whiteness(m));
  if (m.upsampling_factor > 1) {
    facts.push(`The recorder made ${m.upsampling_factor - 1} of ${m.upsampling_factor} samples${m.upsampling_kernel === "" ? "" : ` (${m.upsampling_kernel})`}.`);
  }
  if (m.band !== "" && m.band !== "open") facts.push(`Top of the spectrum: ${m.band}.`);
  if (m.bad_variances > 0) facts.push(`${plural(m.bad_variances, "variance")} could not be used.`);
  if ([...m.bar_scale, ...m.gap_bar_scale].some((f) => f !== null && f !== 1)) {
    facts.push(
      `Error bars of position, velocity, acceleration and jerk are the model's times ${times(m.bar_scale)}; what gaps add, times ${times(m.gap_bar_scale)}.`,
    );
  }
  return el("p", { class: "facts", id: "marker-why" }, el("b", {}, m.words), " ", facts.join(" "));
}

/** What the test of the residual says, and no more. */
function whiteness(m: CleanMarker): string {
  if (m.white === null || m.white_p === null) return "Whether the residual is white could not be tested.";
  const verdict = `The residual is ${m.white ? "consistent with white noise" : "not white"} (${probability(m.white_p)}).`;
  if (m.white || m.white_departure === null) return verdict;
  const where = m.white_departure > 0 ? "low" : "high";
  return `${verdict} ${number(100 * Math.abs(m.white_departure), 0)} % of the noise power lies too ${where} in frequency.`;
}

export function probability(p: number | null): string {
  if (p === null) return "p unknown";
  return p < 0.001 ? "p < 0.001" : `p = ${number(p, 3)}`;
}

/** Spectrum, residual autocorrelation and the filters that were tried, side by side. */
export function charts(m: CleanMarker): HTMLElement {
  const spectrum = spectrumChart(m.spectrum, m.cutoff_hz, `Spectrum of ${m.name} and of what the filter took away`);
  const lags = autocorrelationChart(m.autocorrelation, m.autocorrelation_if_white, m.after.measured, `Autocorrelation of the residual of ${m.name}`);
  const tried = plain(
    `Filters tried, by ${m.criterion}`,
    ["Order", "Best cut-off (Hz)", m.criterion],
    m.tried.map((t) => [`${t.order}${t.order === m.order ? ", taken" : ""}`, number(t.cutoff_hz, 1), t.criterion === null ? "–" : t.criterion.toExponential(3)]),
  );
  const figure = (id: string, title: string, chart: SVGElement | null, none: string, ...keys: (HTMLElement | null)[]): HTMLElement =>
    el("figure", { id }, el("figcaption", {}, title, ...keys), chart === null ? el("p", { class: "lead" }, none) : (chart as Node));
  return el(
    "div",
    { class: "columns charts" },
    figure(
      "spectrum",
      "Spectrum (mm²/Hz, all axes together) ",
      spectrum,
      "No span without gaps is long enough for a spectrum.",
      el("span", { class: "key raw" }, "came in"),
      el("span", { class: "key one" }, "taken away"),
      m.cutoff_hz === null ? null : el("span", { class: "key cut" }, `cut-off ${number(m.cutoff_hz, 1)} Hz`),
    ),
    figure(
      "autocorrelation",
      "Autocorrelation of the residual ",
      lags,
      "Too few samples.",
      el("span", { class: "key cut" }, "95 % of white noise through this filter"),
    ),
    tried,
  );
}

/** The gaps of one marker: what happened to each and how certain it is. */
export function gapTable(m: CleanMarker, summary: CleanSummary, jump: (gap: CleanGap) => void): HTMLElement {
  const gaps = summary.gaps.filter((g) => g.marker === m.name);
  const all = m.gaps_filled + m.gaps_open;
  if (all === 0) return el("p", { class: "facts" }, "No gaps.");
  const { node } = sortableTable<CleanGap>(
    `Gaps of ${m.name}`,
    [
      { title: "Time", unit: "s", key: (g) => g.first_time_s, cell: (g) => el("button", { type: "button", class: "jump plain" }, number(g.first_time_s, 3)) },
      { title: "Length", unit: "s", numeric: true, key: (g) => g.length_s, cell: (g) => number(g.length_s, 3) },
      { title: "What was done", key: done, cell: (g) => el("span", { class: g.filled ? "wide" : "wide remark low" }, done(g)) },
      { title: "SD", unit: "mm", numeric: true, key: (g) => g.sd_mm, cell: (g) => number(g.sd_mm, 2) },
      { title: "Largest SD", unit: "mm", numeric: true, key: (g) => g.max_sd_mm, cell: (g) => number(g.max_sd_mm, 2) },
      { title: "Tested on", key: (g) => g.windows, cell: tested },
      { title: "From", key: (g) => g.predictors.join(", "), cell: (g) => el("span", { class: "wide" }, leaning(g)) },
    ],
    gaps,
    { column: 0, direction: "ascending" },
    jump,
  );
  const rest = all - gaps.length;
  return el(
    "div",
    { id: "marker-gaps" },
    gaps.length === 0 ? null : node,
    rest > 0 ? el("p", { class: "lead" }, `${plural(rest, "more gap")} of this marker, shorter than those listed on this page, ${rest === 1 ? "is" : "are"} in the JSON file beside the results.`) : null,
  );
}

const done = (g: CleanGap): string => {
  const edge = g.at_edge ? " (at the end of the recording)" : "";
  return g.filled ? `filled, ${g.how}${edge}` : `left open${edge}: ${g.why_open}`;
};

const tested = (g: CleanGap): string =>
  g.windows === 0 ? "–" : `${plural(g.windows, "artificial gap")} of ${number(g.window_s, 2)} s`;

const leaning = (g: CleanGap): string =>
  g.predictors.join(", ") + (g.dropped.length === 0 ? "" : `${g.predictors.length === 0 ? "" : "; "}not trusted: ${g.dropped.join(", ")}`);
