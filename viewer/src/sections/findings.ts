// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el, section } from "../dom.ts";
import { seconds } from "../format.ts";
import type { Finding, Summary } from "../types.ts";
import type { View } from "../view.ts";

/** A trial with thousands of warnings stays readable. */
const mostShown = 100;

/** What needs attention, the serious things first. */
export function findings(summary: Summary, view: View): HTMLElement {
  const passed = summary.gates.filter((g) => g.passed);
  const nothing = summary.findings.length === 0;
  const rest = summary.findings.length - mostShown;
  return section(
    "attention",
    "What needs your attention",
    "",
    nothing ? el("p", {}, "Nothing. Every frame converged, every coordinate is determined in every frame, and there are no warnings.") : null,
    el("ul", { class: "findings" }, ...summary.findings.slice(0, mostShown).map((f) => line(f, summary, view))),
    rest > 0 ? el("p", { class: "lead" }, `${rest} more are in the JSON file beside the results.`) : null,
    passed.length === 0
      ? null
      : el(
          "details",
          {},
          el("summary", {}, `${passed.length} of ${summary.gates.length} quality checks passed`),
          el("ul", { class: "passed" }, ...passed.map((g) => el("li", {}, g.sentence))),
        ),
  );
}

function line(finding: Finding, summary: Summary, view: View): HTMLElement {
  const serious = finding.level === "attention";
  const time = finding.time_s;
  const jump = (at: number): void => {
    const coordinate = summary.coordinates.findIndex((c) => c.name === finding.subject);
    if (finding.about === "coordinate" && coordinate >= 0) view.set({ coordinate });
    view.jumpTo(at, "angles");
  };
  return el(
    "li",
    { class: finding.level },
    el("span", { class: "level" }, serious ? "Problem" : "Note"),
    el("span", { class: "text" }, finding.text),
    time === null
      ? null
      : el("button", { type: "button", class: "jump", click: () => jump(time) }, `Show ${seconds(time)}`),
  );
}
