// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el } from "../dom.ts";
import { number } from "../format.ts";
import { shifted, zoomed, type View } from "../view.ts";

/** Sticky bar: where to find what, and which part of the trial the plots show. */
export function timeBar(view: View, sections: readonly (readonly [id: string, title: string])[]): HTMLElement {
  const text = el("span", { class: "range", "aria-live": "polite" });
  const whole = el("button", { type: "button", click: () => view.set({ range: view.whole, focus: null }) }, "Whole trial");
  const button = (label: string, sign: string, change: () => void): HTMLButtonElement =>
    el("button", { type: "button", "aria-label": label, title: label, click: change }, sign);
  const show = (): void => {
    const [from, to] = view.range;
    const decimals = to - from < 1 ? 3 : 2;
    text.textContent = `${number(from, decimals)} to ${number(to, decimals)} s`;
    whole.disabled = from === view.whole[0] && to === view.whole[1];
  };
  view.onChange(show);
  show();
  const link = (id: string, title: string): HTMLElement => el("a", { href: `#${id}` }, title);
  return el(
    "nav",
    { class: "bar", "aria-label": "Sections and time" },
    el(
      "div",
      { class: "links" },
      ...sections.map(([id, title]) => link(id, title)),
    ),
    el(
      "div",
      { class: "time" },
      text,
      button("Earlier", "←", () => view.set({ range: shifted(view.range, -0.5) })),
      button("Later", "→", () => view.set({ range: shifted(view.range, 0.5) })),
      button("Zoom in", "+", () => view.set({ range: zoomed(view.range, 0.5) })),
      button("Zoom out", "−", () => view.set({ range: zoomed(view.range, 2) })),
      whole,
    ),
  );
}
