// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskState } from "../page_types.ts";
import { el } from "../dom.ts";
import { plural } from "../format.ts";
import { svg } from "../svg.ts";
import type { Panel } from "./panel.ts";

const colours = 6;
const heights = [-0.07, 0.13, -0.16]; // of names, beside their spots

/** Spots of an LED as dots of one path. */
const dots = (spots: readonly (readonly [number, number])[]): string => spots.map(([x, y]) => `M${x} ${y}h0`).join("");

/** A detector as the device sees it: x right, y down, from -1 to 1. */
function detector(camera: string, leds: readonly string[]): { node: HTMLElement; draw: (spots: readonly (readonly [number, number][])[]) => void } {
  const parts = leds.map((led, l) => ({
    trail: svg("path", { class: "trail", d: "" }),
    newest: svg("circle", { r: 0.035, cx: 0, cy: 0 }),
    name: svg("text", { x: 0, y: 0, "text-anchor": "middle" }, led.length > 12 ? `${led.slice(0, 11)}…` : led),
    colour: `mark-${l % colours}`,
  }));
  const drawing = svg(
    "svg",
    { viewBox: "-1.005 -1.005 2.01 2.01", role: "img", "aria-label": `Detector of camera ${camera}, ${plural(leds.length, "LED")}` },
    svg("rect", { class: "frame", x: -1, y: -1, width: 2, height: 2 }),
    svg("path", { class: "axes", d: "M-1 0H1M0 -1V1" }),
    ...parts.map(({ trail, newest, name, colour }) => svg("g", { class: colour }, trail, newest, name)),
  );
  return {
    node: el("figure", { class: "detector" }, el("figcaption", {}, `Camera ${camera}`), drawing),
    draw: (spots) => {
      // Names of neighbours stand at different heights, and inside the frame.
      const order = leds.map((_, l) => l).sort((a, b) => (spots[a]?.[0]?.[0] ?? 0) - (spots[b]?.[0]?.[0] ?? 0));
      parts.forEach(({ trail, newest, name }, l) => {
        const seen = spots[l] ?? [];
        const [x, y] = seen[0] ?? [0, 0];
        trail.setAttribute("d", dots(seen));
        place(newest, seen.length > 0, { cx: x, cy: y });
        place(name, seen.length > 0, { x: Math.max(-0.78, Math.min(0.78, x)), y: y + heights[order.indexOf(l) % heights.length]! });
      });
    },
  };
}

function place(node: SVGElement, isSeen: boolean, at: Record<string, number>): void {
  for (const [key, value] of Object.entries(at)) node.setAttribute(key, String(value));
  if (isSeen) node.removeAttribute("visibility");
  else node.setAttribute("visibility", "hidden");
}

/** All detectors side by side. */
export function detectors({ granted }: DeskState): Panel {
  const all = (granted?.cameras ?? []).map((camera) => detector(camera, granted!.leds));
  return {
    node: el("div", { class: "detectors" }, ...all.map((one) => one.node)),
    update: ({ live }) => all.forEach((one, c) => one.draw(live?.seen.map((led) => led[c]?.spots ?? []) ?? [])),
  };
}
