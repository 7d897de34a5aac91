// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskState } from "../page_types.ts";
import { el } from "../dom.ts";
import type { Act } from "./channel.ts";
import { button, heading, panel, type Panel } from "./panel.ts";

/** The sources that were found, and an address that is typed. */
export function sourcesPanel(act: Act): Panel {
  const list = el("ul", { class: "desk-sources" });
  const none = el("p", { class: "facts", hidden: true }, "No device was found: plug one in and look again, or type an address.");
  const address = el("input", { id: "desk-address", type: "text", autocomplete: "off", spellcheck: "false", "aria-describedby": "desk-address-hint" });
  const open = (uri: string): void => void act({ do: "open", uri });
  const typed = el(
    "form",
    { class: "desk-form", submit: (event) => { event.preventDefault(); open(address.value.trim()); } },
    el("label", { for: "desk-address" }, "Address"),
    el("div", {}, address, el("p", { class: "facts", id: "desk-address-hint" }, "sim:rig, serial:/dev/ttyACM0, comedi:/dev/comedi0")),
    el("button", { type: "submit" }, "Open the address"),
  );
  let shown = "";

  function update({ sources }: DeskState): void {
    const now = JSON.stringify(sources);
    if (now === shown) return;
    shown = now;
    none.hidden = sources.length > 0;
    list.replaceChildren(
      ...sources.map(({ uri, name, state }) =>
        el("li", {}, el("button", { type: "button", class: "primary", click: () => open(uri), "aria-label": `Open ${uri}` }, "Open"), el("b", {}, uri), el("span", { class: state === "" ? "facts" : "missed" }, state === "" ? name : `${name}: ${state}`)),
      ),
    );
  }
  return { node: panel("source", heading("Source"), list, none, el("div", { class: "desk-actions" }, button("Look again", () => void act({ do: "look" }))), typed), update };
}
