// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el } from "../dom.ts";

/** An upright line above a plot, at an instant. It is moved, so that the plot need not be drawn again while time goes on. */
export class TimeLine {
  readonly node: HTMLElement;
  #left: number | null = null;

  constructor(kind: "asked" | "pointed") {
    this.node = el("i", { class: `time-line ${kind}`, "aria-hidden": "true", hidden: true });
  }

  /** So many pixels from the left edge of the box; null: not in sight. */
  put(left: number | null): void {
    if (left === this.#left) return;
    this.#left = left;
    this.node.hidden = left === null;
    if (left !== null) this.node.style.transform = `translateX(${left.toFixed(1)}px)`;
  }
}
