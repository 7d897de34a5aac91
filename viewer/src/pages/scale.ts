// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Adapted, ScalePage, ScaleResult } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { number, plural } from "../format.ts";
import { forest } from "../plots/forest.ts";
import { svgFigure } from "../plots/svg_figure.ts";
import { linkBar, numeric, resultFindings, resultHeader, resultRun, table, text, type Tile } from "../sections/result_parts.ts";
import type { Content } from "./content.ts";
import { around } from "./joints.ts";

type Parameter = Adapted["parameters"][number];
type Length = Adapted["lengths"][number];

/** A scaled model: each size with its interval, what the data do not determine, and how the markers fit. */
export function scalePage({ summary, result }: ScalePage): Content {
  const fit = result.motion ?? result.static ?? null;
  const tissue = fit?.soft_tissue_sd_m ?? null;
  const sizes = fit?.parameters.filter((p) => p.kind === "size") ?? [];
  const others = fit?.parameters.filter((p) => p.kind !== "size") ?? [];
  const tiles: Tile[] = [
    [`${number(result.mass_kg, 1)} kg`, "mass", result.model],
    fit === null
      ? [`${number(result.placed === undefined ? null : 1e3 * result.placed.rms_m, 1)} mm`, "RMS marker error", "static trial"]
      : [`${number(1e3 * fit.rms_after_m, 1)} mm`, "RMS marker error", `${number(1e3 * fit.rms_before_m, 1)} mm before`],
    [`${number(sizes.filter((p) => p.determined).length)} of ${number(sizes.length)}`, "sizes determined", "by the data, not by what was assumed"],
    [`${number(fit?.lengths.filter((l) => l.determined).length ?? 0)} of ${number(fit?.lengths.length ?? 0)}`, "lengths determined", "between joints of a segment"],
    [`${number(fit === null ? null : 1e3 * fit.noise_sd_m, 1)} mm`, "marker noise", "SD per axis"],
    [tissue === null || tissue === 0 ? "–" : `${number(1e3 * tissue, 1)} mm`, "soft tissue", tissue === null ? "one posture cannot tell" : tissue === 0 ? "none found" : "SD per axis that follows the posture"],
  ];
  const factors = Object.entries(result.factors);
  return {
    skip: ["sizes", "Skip to the sizes"],
    header: resultHeader("scaled model", `From ${result.model}`, summary, tiles),
    bar: linkBar([["attention", "Attention"], ["sizes", "Sizes"], ["lengths", "Lengths"], ["places", "Markers"], ["factors", "Factors"], ["settings", "Run"]]),
    sections: [
      resultFindings(summary, "Nothing. The markers fit, and the data determine every size."),
      section(
        "sizes",
        "Sizes",
        fit === null
          ? "No sizes were fitted; they were measured or set."
          : "Each segment's size against the model before; the interval is ±1.96 SD. Hollow: the data do not determine it, the interval is what was assumed before.",
        sizes.length === 0
          ? null
          : svgFigure("Sizes of segments", forest(sizes.map((p) => ({ ...around(p.name, ratio(p), p.sd === null ? null : p.sd / (p.initial || 1)), open: !p.determined })), { label: "Size of each segment with its interval", axis: "size, as a share of the model before", reference: 1 })),
        table<Parameter>("Sizes of segments", parameterColumns("", 3, 1), sizes),
        measured(result),
      ),
      section(
        "lengths",
        "Lengths",
        "Distances between joints of one segment. The upright stroke is the model before.",
        fit === null || fit.lengths.length === 0
          ? el("p", {}, "No lengths were fitted.")
          : svgFigure("Lengths of segments", forest(fit.lengths.map((l) => ({ ...around(l.name, 1e3 * l.length_m, l.sd_m === null ? null : 1e3 * l.sd_m), before: 1e3 * l.initial_m, open: !l.determined })), { label: "Length of each segment with its interval", axis: "length (mm)", fromZero: true })),
        table<Length>(
          "Lengths of segments",
          [text("Length", (l) => l.name), numeric("Before", "mm", 1, (l) => 1e3 * l.initial_m), numeric("Length", "mm", 1, (l) => 1e3 * l.length_m), numeric("SD", "mm", 1, (l) => (l.sd_m === null ? null : 1e3 * l.sd_m)), text("Determined", (l) => (l.determined ? "yes" : "no"))],
          fit?.lengths ?? [],
        ),
      ),
      section(
        "places",
        "Markers",
        "Where markers sit on the model, and how far they were moved.",
        placed(result),
        table<Parameter>("Places fitted to the motion", parameterColumns("mm", 1, 1e3), others),
      ),
      section(
        "factors",
        "Factors",
        "What every body was stretched by, all steps together.",
        table<(typeof factors)[number]>("Factors of bodies", [text("Body", (f) => f[0]), ...[0, 1, 2].map((k) => numeric<(typeof factors)[number]>("xyz"[k]!, "", 3, (f) => f[1][k]))], factors),
        table<ScaleResult["muscles"][number]>(
          "Muscles and ligaments at rest",
          [text("Muscle", (m) => m.name), numeric("Before", "mm", 1, (m) => 1e3 * m.before_m), numeric("After", "mm", 1, (m) => 1e3 * m.after_m), numeric("Ratio", "", 3, (m) => m.ratio)],
          result.muscles,
        ),
      ),
      resultRun(summary, fit === null ? [] : [["Frames used", plural(fit.frames, "frame")], ["Steps", `${fit.iterations}, ${fit.converged ? "converged" : "not converged"}`]]),
    ],
    start: () => undefined,
  };
}

const ratio = (p: Parameter): number => (p.initial === 0 ? p.value : p.value / p.initial);

const parameterColumns = (unit: string, decimals: number, scale: number): Parameters<typeof table<Parameter>>[1] => [
  text("Parameter", (p) => p.name),
  ...(unit === "" ? [] : [text<Parameter>("Kind", (p) => p.kind)]),
  numeric("Before", unit, decimals, (p) => scale * p.initial),
  numeric("Value", unit, decimals, (p) => scale * p.value),
  numeric("SD", unit, decimals, (p) => (p.sd === null ? null : scale * p.sd)),
  numeric("SD assumed before", unit, decimals, (p) => scale * p.prior_sd),
  text("Determined", (p) => (p.determined ? "yes" : "no")),
];

function measured({ measurements }: ScaleResult): HTMLElement | null {
  const rows = (measurements ?? []).flatMap((m) => m.pairs.map((pair) => ({ ...pair, name: m.name, factor: m.factor })));
  return table<(typeof rows)[number]>(
    "Sizes measured between markers",
    [text("Measurement", (r) => r.name), text("Markers", (r) => r.markers.join(" to ")), numeric("Measured", "mm", 1, (r) => 1e3 * r.measured_m), numeric("SD", "mm", 2, (r) => (r.measured_sd_m === null ? null : 1e3 * r.measured_sd_m)), numeric("Model", "mm", 1, (r) => 1e3 * r.model_m), numeric("Factor", "", 3, (r) => r.factor)],
    rows,
  );
}

function placed({ placed: result }: ScaleResult): HTMLElement {
  if (result === undefined) return el("p", {}, "No static trial placed the markers.");
  type Placed = typeof result.markers[number];
  const moved = (m: Placed): number => 1e3 * Math.hypot(...m.after_in_body_m.map((v, k) => v - m.before_in_body_m[k]!));
  const rows = result.markers.filter((m) => m.error_m !== null);
  const figure = svgFigure(
    "Marker errors in the static pose",
    forest([...rows].sort((a, b) => b.error_m! - a.error_m!).map((m) => ({ name: m.name, value: 1e3 * m.error_m!, low: 0, high: 1e3 * m.error_m!, open: m.fixed })), { label: "Distance of measured and model marker in the static pose", axis: "distance of measured and model marker before it was moved (mm); hollow: kept in place", fromZero: true }),
  );
  const list = table<Placed>(
    "Markers placed by the static trial",
    [text("Marker", (m) => m.name), text("Body", (m) => m.body), numeric("Error", "mm", 1, (m) => (m.error_m === null ? null : 1e3 * m.error_m)), numeric("Moved", "mm", 1, moved), text("Kept in place", (m) => (m.fixed ? "yes" : "no"))],
    result.markers,
  );
  const unseen = result.not_in_static_trial.length === 0 ? null : el("p", { class: "facts" }, `Not in the static trial: ${result.not_in_static_trial.join(", ")}.`);
  return el("div", {}, rows.length === 0 ? null : figure, list, unseen);
}
