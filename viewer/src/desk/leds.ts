// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskSeen, DeskState } from "../page_types.ts";
import { el } from "../dom.ts";
import { number } from "../format.ts";
import type { Act } from "./channel.ts";
import { share, tell, type Panel } from "./panel.ts";

/** What is wrong with an LED in a camera; empty: nothing. */
export function trouble(seen: DeskSeen): string {
  if (seen.occluded_share >= 1) return "dark";
  if (seen.saturated_share > 0) return "clips";
  return seen.occluded_share > 0 ? share(seen.occluded_share) : "";
}

/** Level, noise and what is wrong, of one LED in one camera. */
function cell(led: string, camera: string): { node: HTMLElement; show: (seen: DeskSeen | undefined) => void } {
  const level = el("meter", { min: 0, max: 1, "aria-label": `Level of ${led} in camera ${camera}` });
  const noise = el("span", {}), word = el("b", { class: "missed" });
  return {
    node: el("td", {}, el("span", { class: "desk-seen" }, level, noise, word)),
    show: (seen) => {
      level.setAttribute("value", String(seen?.highest_share ?? 0));
      tell(noise, number(seen?.noise_counts, 1));
      tell(word, seen === undefined ? "" : trouble(seen));
    },
  };
}

/** Light of an LED: a slider where the device can set it. */
function light(led: string, index: number, sets: boolean, act: Act): { node: HTMLElement; show: (intensity: number) => void } {
  const words = el("span", {});
  if (!sets) return { node: el("td", {}, el("span", { class: "desk-seen" }, words)), show: (intensity) => tell(words, share(intensity)) };
  const slider = el("input", { type: "range", min: 0.1, max: 1, step: 0.05, "aria-label": `Light of ${led}` });
  let held = false; // by who moves it, until the device has it
  const say = (): void => {
    tell(words, share(Number(slider.value)));
    slider.setAttribute("aria-valuetext", share(Number(slider.value)));
  };
  slider.addEventListener("input", () => {
    held = true;
    say();
  });
  slider.addEventListener("change", () => void act({ do: "intensity", led: index, value: Number(slider.value) }).then(() => (held = false)));
  return {
    node: el("td", {}, el("span", { class: "desk-seen" }, slider, words)),
    show: (intensity) => {
      if (held) return;
      slider.value = String(intensity);
      say();
    },
  };
}

/** A row for each LED: its light, and how each camera sees it. */
export function ledTable(act: Act, { device, granted }: DeskState, sets: boolean): Panel {
  const { leds, cameras } = granted ?? { leds: [], cameras: [] };
  const rows = leds.map((led, l) => ({ light: light(led, l, sets && device?.sets_intensity === true, act), cells: cameras.map((camera) => cell(led, camera)), led, colour: `mark-${l % 6}` }));
  const table = el(
    "table",
    {},
    el("caption", {}, "LEDs"),
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "LED"), el("th", { scope: "col" }, "light"), ...cameras.map((camera) => el("th", { scope: "col" }, `${camera}: level, noise, hidden`)))),
    el("tbody", {}, ...rows.map((row) => el("tr", {}, el("th", { scope: "row" }, el("span", { class: `desk-dot ${row.colour}`, "aria-hidden": "true" }), row.led), row.light.node, ...row.cells.map((one) => one.node)))),
  );
  return {
    node: el("div", { class: "table", role: "region", "aria-label": "LEDs as the cameras see them", tabindex: 0 }, table),
    update: ({ live, granted: now }) =>
      rows.forEach((row, l) => {
        row.light.show(now?.intensity[l] ?? 1);
        row.cells.forEach((one, c) => one.show(live?.seen[l]?.[c]));
      }),
  };
}
