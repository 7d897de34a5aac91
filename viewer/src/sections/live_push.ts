// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Below the picture of a live source: the levels of the goals, and controls that push the body.
import { el } from "../dom.ts";
import { number } from "../format.ts";
import type { LiveBody } from "../live/body.ts";
import { mostN, type PushHand } from "../live/push.ts";
import type { LiveSummary } from "../page_types.ts";
import { goalCorners, kindOfLevel } from "../scene/goal_marks.ts";
import { length, scaled, type Vec } from "../scene/vec.ts";
import { svg } from "../svg.ts";
import { toggle } from "./space_parts.ts";

export interface LivePushOptions {
  hand: PushHand;
  /** Directions of the picture in the world, length 1. */
  picture: () => { right: Vec; up: Vec };
  /** A drag on a body pushes it. */
  dragging: (on: boolean) => void;
  changed: () => void;
}

/** A polygon of so many corners, first corner as RingGeometry has it. */
function ringPath(corners: number): string {
  const at = (i: number): string => {
    const angle = (2 * Math.PI * i) / corners;
    return `${(10 + 7 * Math.cos(angle)).toFixed(1)},${(10 - 7 * Math.sin(angle)).toFixed(1)}`;
  };
  return `M${Array.from({ length: corners }, (_, i) => at(i)).join("L")}Z`;
}

const arrows: Readonly<Record<string, readonly [number, number]>> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** How far the markers of a level are from their goals; a level of tasks alone has none. */
const distanceWords = (mm: number, hasMarkers: boolean): string => (!hasMarkers ? "no markers" : Number.isNaN(mm) ? "no goal now" : `${number(mm, 1)} mm RMS`);

export function livePush(summary: LiveSummary, body: LiveBody, options: LivePushOptions): { node: HTMLElement; tell: () => void } {
  const { hand } = options;
  const now = summary.levels.map(() => el("span", { class: "now" }, "–"));
  const legend = el(
    "ul",
    { class: "legend shapes", id: "live-levels" },
    ...summary.levels.map((words, level) => {
      const kind = kindOfLevel(level);
      const mark = svg("svg", { viewBox: "0 0 20 20", class: `mark hollow mark-level-${kind}`, "aria-hidden": "true" }, svg("path", { d: ringPath(goalCorners[kind]!) })) as unknown as HTMLElement;
      const title = summary.levels.length === 1 ? "Goals of " : `Level ${level + 1}${summary.strict ? ", strict" : ""}: `;
      return el("li", {}, mark, el("span", {}, `${title}${words}, `, now[level]!));
    }),
  );
  const status = el("p", { class: "facts", id: "push-status", role: "status" }, "Nobody pushes the body.");
  const chosen = el("select", { "aria-label": "Body to push", id: "push-body" }, ...summary.bodies.map((b, i) => el("option", { value: i }, b.name)));
  const force = el("input", { type: "number", min: 10, max: mostN, step: 10, value: 200, id: "push-force", "aria-label": `Force, N, at most ${mostN}` });
  const held = new Set<string>();
  const pushOn = (): void => {
    const { right, up } = options.picture();
    const way: Vec = [0, 0, 0];
    for (const key of held) for (const k of [0, 1, 2] as const) way[k] += arrows[key]![0] * right[k] + arrows[key]![1] * up[k];
    if (length(way) < 1e-9) hand.drop();
    else hand.push(Number(chosen.value), scaled(way, (Number(force.value) || 0) / length(way)));
    options.changed();
  };
  const release = (): void => {
    if (held.size === 0) return;
    held.clear();
    pushOn();
  };
  const keys = el(
    "button",
    {
      type: "button",
      id: "push-keys",
      title: "The force acts as long as the key is held, in the directions of the picture",
      keydown: (e) => {
        const { key } = e as KeyboardEvent;
        if (arrows[key] === undefined) return;
        e.preventDefault();
        if (held.has(key)) return;
        held.add(key);
        pushOn();
      },
      keyup: (e) => {
        if (held.delete((e as KeyboardEvent).key)) pushOn();
      },
      blur: release,
    },
    "Hold an arrow key here to push",
  );
  const node = el(
    "div",
    { class: "live-push", id: "live-push" },
    legend,
    el("div", { class: "controls" }, toggle("Drag pushes", false, (on) => options.dragging(on)), el("label", { class: "pick" }, el("span", {}, "Body"), chosen), el("label", { class: "pick" }, el("span", {}, "N"), force), keys),
    status,
  );

  /** What is so now, in words. */
  function words(): string {
    const away = body.pushed_mm;
    const where = away === null ? "" : `${number(away, 1)} mm from where its goals hold it`;
    if (hand.force !== null && length(hand.force) > 0)
      return `Pushed: ${number(length(hand.force))} N at ${hand.name}${hand.isCapped ? `, the most that is applied` : ""}${where === "" ? "" : `; the body is up to ${where}`}. It is a simulation here and no measurement; angles, their bands and a recording stay those of the source.`;
    if (away === null) return "Nobody pushes the body.";
    return `Pushed, by another page or until just now: the body is up to ${where}, and comes back when it is let go. It is a simulation here and no measurement; angles, their bands and a recording stay those of the source.`;
  }

  function tell(): void {
    body.levelDistances().forEach((mm, level) => (now[level]!.textContent = distanceWords(mm, summary.targets.some((t) => t.level === level))));
    const text = words();
    if (status.textContent !== text) status.textContent = text;
    status.classList.toggle("pushed", body.pushed_mm !== null);
    node.setAttribute("data-pushed-mm", body.pushed_mm === null ? "" : String(body.pushed_mm));
  }
  return { node, tell };
}
