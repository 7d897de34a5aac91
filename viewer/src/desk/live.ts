// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskState } from "../page_types.ts";
import { el } from "../dom.ts";
import { number, plural } from "../format.ts";
import type { Act } from "./channel.ts";
import { detectors } from "./detectors.ts";
import { ledTable } from "./leds.ts";
import { button, heading, panel, tell, type Panel } from "./panel.ts";

/** Detectors and LEDs as they are now. */
export function livePanel(act: Act, state: DeskState): Panel {
  const { granted, wanted } = state;
  const parts = [detectors(state), ledTable(act, state, true)];
  const said = el("span", { id: "desk-guide", role: "status" });
  const guide = el("p", { class: "desk-guide", hidden: true }, said, " ", button("Align anew", () => void act({ do: "restart_guide" })));
  const frames = el("p", { class: "facts", id: "desk-frames" });
  const words = granted === null ? "Live" : `Live: ${plural(granted.leds.length, "LED")}, ${plural(granted.cameras.length, "camera")}, ${number(granted.rate_hz, Number.isInteger(granted.rate_hz) ? 0 : 1)} Hz`;
  const node = panel(
    "live",
    heading(words),
    frames,
    el("div", { class: "desk-actions" }, button(`Record ${wanted.trial}`, () => void act({ do: "record" }), true), button("Set-up", () => void act({ do: "set_up" }))),
    guide,
    ...parts.map((part) => part.node),
  );
  return {
    node,
    update: (now) => {
      tell(frames, plural(now.live?.frames ?? 0, "frame"));
      const aligned = now.live?.guide ?? "";
      guide.hidden = aligned === "";
      tell(said, aligned === "" ? "" : `Alignment: ${aligned}`);
      for (const part of parts) part.update(now);
    },
  };
}
