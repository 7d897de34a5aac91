// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el } from "../dom.ts";
import { number } from "../format.ts";

/** A name that chooses its row. A button, so that it can be reached from the keyboard; the click is the row's. */
export const nameCell = (name: string): HTMLElement => el("button", { type: "button", class: "name" }, name);

/** A number with a bar of its share of the largest. */
export function barCell(value: number | null, largest: number, decimals = 1): Node {
  if (value === null) return document.createTextNode("–");
  const bar = el("meter", { min: 0, max: largest, value, "aria-hidden": "true" });
  return el("span", { class: "bar-cell" }, bar, el("span", {}, number(value, decimals)));
}
