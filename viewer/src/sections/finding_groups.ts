// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Finding, FindingGroup, Gate } from "../page_types.ts";
import { el, section } from "../dom.ts";
import { plural, seconds } from "../format.ts";

/** A trial with thousands of warnings stays readable. */
const mostShown = 200;

/** What findings of a kind are about, one and several. */
const subjects: Record<string, readonly [one: string, many: string]> = {
  gate: ["quality check missed", "quality checks missed"],
  frames: ["remark about frames", "remarks about frames"],
  marker: ["remark about markers", "remarks about markers"],
  gap: ["remark about gaps", "remarks about gaps"],
  upsampling: ["remark about samples that the recorder made", "remarks about samples that the recorder made"],
  warning: ["remark", "remarks"],
};

/** One coordinate a finding, whose sentences all say the same of it. */
const coordinateKinds: readonly [pattern: RegExp, one: string, many: string][] = [
  [/never determined|in no frame|determined in 0 of/i, "coordinate never determined", "coordinates never determined"],
  [/determined/i, "coordinate partly not determined", "coordinates partly not determined"],
  [/limit/i, "coordinate at a limit", "coordinates at a limit"],
];

function kindOf(finding: Finding): readonly [one: string, many: string] {
  if (finding.about === "coordinate") {
    const kind = coordinateKinds.find(([pattern]) => pattern.test(finding.text));
    return kind === undefined ? ["remark about coordinates", "remarks about coordinates"] : [kind[1], kind[2]];
  }
  return subjects[finding.about] ?? subjects["warning"]!;
}

/** Findings folded by kind; the serious first, then in the order in which they came. */
export function groupFindings(findings: readonly Finding[]): FindingGroup[] {
  const groups = new Map<string, { level: Finding["level"]; words: readonly [string, string]; items: Finding[] }>();
  for (const finding of findings) {
    const words = kindOf(finding);
    const key = `${finding.level} ${words[1]}`;
    const group = groups.get(key);
    if (group === undefined) groups.set(key, { level: finding.level, words, items: [finding] });
    else group.items.push(finding);
  }
  const all = [...groups.values()].map(({ level, words, items }) => ({ level, title: plural(items.length, ...words), items }));
  return [...all.filter((g) => g.level === "attention"), ...all.filter((g) => g.level === "note")];
}

export interface FindingWords {
  title: string;
  /** Said where there is nothing to find. */
  nothing: string;
}

/** Findings, one folded line a kind. `jump` shows where a finding is. */
export function findingGroups(
  groups: readonly FindingGroup[],
  words: FindingWords,
  jump: ((finding: Finding, time: number) => void) | null,
  gates: readonly Gate[] = [],
): HTMLElement {
  const passed = gates.filter((g) => g.passed);
  return section(
    "attention",
    words.title,
    "",
    groups.length === 0 ? el("p", {}, words.nothing) : null,
    ...groups.map((g) => folded(g, jump)),
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

function folded(group: FindingGroup, jump: ((finding: Finding, time: number) => void) | null): HTMLElement {
  const { level, items } = group;
  const tag = el("span", { class: "level" }, level === "attention" ? "Problem" : "Note");
  const only = items.length === 1 ? items[0]! : null;
  // One sentence needs no fold around it.
  if (only !== null) return el("div", { class: `group single ${level}` }, tag, el("span", { class: "text" }, only.text), show(only, jump));
  const rest = items.length - mostShown;
  return el(
    "details",
    { class: `group ${level}` },
    el("summary", {}, tag, el("span", { class: "text" }, group.title)),
    el("ul", { class: "findings", tabindex: 0, "aria-label": group.title }, ...items.slice(0, mostShown).map((f) => el("li", {}, el("span", { class: "text" }, f.text), show(f, jump)))),
    rest > 0 ? el("p", { class: "lead" }, `${rest} more are in the JSON file beside the results.`) : null,
  );
}

const show = (f: Finding, jump: ((finding: Finding, time: number) => void) | null): HTMLElement | null =>
  f.time_s === null || jump === null ? null : el("button", { type: "button", class: "jump", click: () => jump(f, f.time_s!) }, `Show ${seconds(f.time_s)}`);
