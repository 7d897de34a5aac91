// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { DeskState } from "../page_types.ts";
import { el } from "../dom.ts";

/** One step of an acquisition on the page. */
export interface Panel {
  node: HTMLElement;
  /** The state is a new one, of the same step. */
  update: (state: DeskState) => void;
}

export const button = (words: string, click: () => void, primary = false): HTMLButtonElement =>
  el("button", { type: "button", class: primary ? "primary" : false, click: () => click() }, words);

/** A section whose heading can be gone to. */
export const panel = (id: string, title: HTMLElement, ...children: (Node | null)[]): HTMLElement =>
  el("section", { id: `desk-${id}`, "aria-labelledby": "desk-title" }, title, ...children);

export const heading = (words: string): HTMLElement => el("h2", { id: "desk-title", tabindex: -1 }, words);

/** Change what an element says, where it says something else. */
export function tell(node: HTMLElement, words: string): void {
  if (node.textContent !== words) node.textContent = words;
}

/** Hundredths; a dash for what is not known. */
export const share = (value: number | null | undefined): string => (value === null || value === undefined ? "–" : `${Math.round(100 * value)} %`);
