// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el, section } from "../dom.ts";
import { seconds } from "../format.ts";
import type { Finding, Gate } from "../types.ts";

/** A trial with thousands of warnings stays readable. */
const mostShown = 100;

/** What needs attention, the serious things first. `jump` shows where a finding is. */
export function findings(
  found: readonly Finding[],
  gates: readonly Gate[],
  nothing: string,
  jump: (finding: Finding, time: number) => void,
): HTMLElement {
  const passed = gates.filter((g) => g.passed);
  const rest = found.length - mostShown;
  return section(
    "attention",
    "What needs your attention",
    "",
    found.length === 0 ? el("p", {}, nothing) : null,
    el("ul", { class: "findings" }, ...found.slice(0, mostShown).map((f) => line(f, jump))),
    rest > 0 ? el("p", { class: "lead" }, `${rest} more are in the JSON file beside the results.`) : null,
    passed.length === 0
      ? null
      : el(
          "details",
          {},
          el("summary", {}, `${passed.length} of ${gates.length} quality checks passed`),
          el("ul", { class: "passed" }, ...passed.map((g) => el("li", {}, g.sentence))),
        ),
  );
}

function line(finding: Finding, jump: (finding: Finding, time: number) => void): HTMLElement {
  const time = finding.time_s;
  return el(
    "li",
    { class: finding.level },
    el("span", { class: "level" }, finding.level === "attention" ? "Problem" : "Note"),
    el("span", { class: "text" }, finding.text),
    time === null
      ? null
      : el("button", { type: "button", class: "jump", click: () => jump(finding, time) }, `Show ${seconds(time)}`),
  );
}
