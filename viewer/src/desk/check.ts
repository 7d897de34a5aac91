// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskState } from "../page_types.ts";
import { el } from "../dom.ts";
import type { Act } from "./channel.ts";
import { button, heading, panel, type Panel } from "./panel.ts";

/** What to know of a trial before it is kept, or discarded, which is asked twice. */
export function checkPanel(act: Act, { check, wanted }: DeskState): Panel {
  const lines = check.map(({ good, text }) => el("li", { class: good ? "fine" : "attention" }, el("span", { class: "level" }, good ? "Good" : "Look"), el("span", { class: "text" }, text)));
  const discard = button("Discard", () => sure(true));
  const back = button("Back", () => sure(false));
  const choice = el("div", { class: "desk-actions" }, button("Keep", () => void act({ do: "keep" }), true), discard);
  const question = el("div", { class: "desk-actions", role: "group", "aria-labelledby": "desk-sure", hidden: true }, el("p", { id: "desk-sure" }, `Discard ${wanted.trial}? Its frames are gone then.`), button("Discard it", () => void act({ do: "discard" })), back);
  function sure(asks: boolean): void {
    choice.hidden = asks;
    question.hidden = !asks;
    (asks ? back : discard).focus();
  }
  return { node: panel("check", heading(`Check of ${wanted.trial}`), el("ul", { class: "findings" }, ...lines), choice, question), update: () => undefined };
}
