// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskState } from "../page_types.ts";
import { el } from "../dom.ts";
import { number } from "../format.ts";
import type { Act } from "./channel.ts";
import { detectors } from "./detectors.ts";
import { ledTable } from "./leds.ts";
import { button, heading, panel, tell, type Panel } from "./panel.ts";

/** A trial as it is recorded: how long, what is kept, who lost what. */
export function recordingPanel(act: Act, state: DeskState): Panel {
  const tile = (id: string, label: string): { node: HTMLElement; value: HTMLElement } => {
    const value = el("dd", { id: `desk-${id}` }, "–");
    return { node: el("div", { class: "tile" }, value, el("dt", {}, label)), value };
  };
  const of = state.duration_s > 0 ? `s of ${number(state.duration_s, Number.isInteger(state.duration_s) ? 0 : 1)}` : "s";
  const tiles = {
    time: tile("recorded", of),
    frames: tile("came", "frames"),
    kept: tile("acknowledged", "frames kept"),
    device: tile("dropped-by-device", "lost by the device"),
    here: tile("dropped-here", "lost here"),
  };
  const parts = [detectors(state), ledTable(act, state, false)];
  const node = panel(
    "recording",
    heading(`Recording ${state.wanted.trial}`),
    el("div", { class: "desk-actions" }, button("Stop", () => void act({ do: "stop" }), true)),
    el("dl", { class: "tiles desk-tiles" }, ...Object.values(tiles).map((one) => one.node)),
    ...parts.map((part) => part.node),
  );
  return {
    node,
    update: (now) => {
      const { live } = now;
      tell(tiles.time.value, number(live?.recorded_s, 1));
      tell(tiles.frames.value, number(live?.frames));
      tell(tiles.kept.value, number(live?.acknowledged));
      tell(tiles.device.value, number(live?.dropped_by_device));
      tell(tiles.here.value, number(live?.dropped_here));
      for (const part of parts) part.update(now);
    },
  };
}
