// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskDevice, DeskState, DeskWanted } from "../page_types.ts";
import { el } from "../dom.ts";
import { number, plural } from "../format.ts";
import type { Act } from "./channel.ts";
import { button, heading, panel, tell, type Panel } from "./panel.ts";

const lines = [
  ["leds", "LEDs", "How many, or their names with commas: shoulder, elbow, wrist"],
  ["rate_hz", "Rate, Hz", "Frames in a second; empty: as many as the LEDs leave room for"],
  ["duration_s", "Duration, s", "Of a trial; empty: until it is stopped"],
  ["subject", "Subject", "Who is measured; may be empty"],
  ["trial", "Trial", "Name of the next trial"],
] as const;

/** How many LEDs were typed, as a count or as names. */
export const countOf = (text: string): number => (/^\s*\d+\s*$/.test(text) ? Number(text) : text.split(",").length);

/** What so many LEDs allow; empty where there can be none. */
export function room(device: DeskDevice, count: number): string {
  const highest = device.highest_rates_hz[count - 1];
  if (highest === undefined) return "";
  return `${plural(count, "LED")}: ${number(highest, 1)} Hz at most, a slot of ${number(device.slot_us)} us for each`;
}

/** LEDs, rate, duration, subject and trial. */
export function setupPanel(act: Act, { device, wanted }: DeskState): Panel {
  const field = (id: string): HTMLInputElement => el("input", { id: `desk-${id}`, type: "text", autocomplete: "off", spellcheck: "false", "aria-describedby": `desk-${id}-hint` });
  const inputs = Object.fromEntries(lines.map(([name]) => [name, field(name)])) as Record<Exclude<keyof DeskWanted, "source">, HTMLInputElement>;
  for (const [name] of lines) inputs[name].value = wanted[name];
  const can = el("p", { class: "facts" }), leaves = el("p", { class: "facts", id: "desk-room" });
  const text = (name: keyof typeof inputs): string => inputs[name].value.trim();
  const start = (): void => void act({ do: "start", leds: text("leds"), rate_hz: text("rate_hz"), duration_s: text("duration_s"), subject: text("subject"), trial: text("trial") });
  const tellRoom = (): void => tell(leaves, device === null ? "" : room(device, countOf(inputs.leds.value)));
  inputs.leds.addEventListener("input", tellRoom);
  if (device !== null) {
    const leds = device.most_leds > 0 ? `up to ${plural(device.most_leds, "LED")}` : "lights no LEDs";
    tell(can, `${device.name}: ${leds}, ${plural(device.cameras, "camera")}, ${device.bits} bits`);
  }
  tellRoom();
  const form = el(
    "form",
    { class: "desk-form", submit: (event) => { event.preventDefault(); start(); } },
    ...lines.flatMap(([name, label, hint]) => [
      el("label", { for: `desk-${name}` }, label),
      el("div", {}, inputs[name], el("p", { class: "facts", id: `desk-${name}-hint` }, hint)),
    ]),
    el("div", { class: "desk-actions" }, el("button", { type: "submit", class: "primary" }, "Start"), button("Another source", () => void act({ do: "leave_source" }))),
  );
  return { node: panel("plan", heading(`Set-up of ${device?.name ?? "the device"}`), can, leaves, form), update: () => undefined };
}
