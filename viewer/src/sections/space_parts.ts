// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Controls, legend and sentences of the space section: elements that know no canvas.
import { el } from "../dom.ts";
import { number } from "../format.ts";
import type { Scene } from "../scene/scene.ts";
import { statePaths } from "../scene/shapes.ts";
import { areConventional } from "../scene/sticks.ts";
import type { Vec } from "../scene/vec.ts";
import { stateWords } from "../states.ts";
import { svg } from "../svg.ts";

/** A list to choose from, with its label. */
export function choice<T extends string>(label: string, words: readonly (readonly [T, string])[], first: T, change: (value: T) => void): HTMLElement {
  const list = el("select", { "aria-label": label, change: () => change(list.value as T) });
  list.append(...words.map(([value, text]) => el("option", { value, ...(value === first ? { selected: true } : {}) }, text)));
  return el("label", { class: "pick" }, el("span", {}, label), list);
}

/** A button that stays pressed. */
export function toggle(words: string, on: boolean, change: (on: boolean) => void): HTMLButtonElement {
  const click = (): void => {
    const now = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(now));
    change(now);
  };
  const button = el("button", { type: "button", class: "choice", "aria-pressed": String(on), click }, words);
  return button;
}

/** Shapes of the states that occur, and of what else is drawn at markers. */
export function shapesLegend(seen: ReadonlySet<number>, others: string | null): HTMLElement {
  const mark = (kind: string, state: number): HTMLElement =>
    svg("svg", { viewBox: "0 0 20 20", class: `mark mark-${kind}`, "aria-hidden": "true" }, svg("path", { d: statePaths[state]!.d })) as unknown as HTMLElement;
  const missing = 4;
  return el(
    "ul",
    { class: "legend shapes" },
    ...stateWords.flatMap((words, state) =>
      seen.has(state) ? [el("li", {}, mark(`${state}${statePaths[state]!.hollow ? " hollow" : ""}`, state), state === missing ? "missing: where it was last" : words)] : [],
    ),
    others === null ? null : el("li", {}, mark("other hollow", missing), others),
  );
}

const axisWords = (up: Vec): string => {
  const k = [0, 1, 2].find((i) => Math.abs(up[i]!) > 0.99);
  return k === undefined ? "a slanted axis" : `${up[k]! < 0 ? "−" : ""}${"xyz"[k]!}`;
};

/** What the bodies of a model are drawn as. */
export function bodyFacts(bodies: Scene["bodies"]): string[] {
  if (bodies === null) return [];
  const plain = bodies.names.length - bodies.meshes.length;
  const ofMass = "at 1,000 kg/m³, not its shape";
  const words = plain === 1 ? `1 body is an ellipsoid of the model's mass ${ofMass}` : `${bodies.meshes.length === 0 ? "" : `${number(plain)} `}bodies are ellipsoids of the model's masses ${ofMass}`;
  return [
    bodies.meshesNote,
    plain === 0 ? "" : words,
  ];
}

/** Sentences under the picture, joined. */
export function spaceFacts(scene: Scene, further: number, hasLines: boolean): string {
  return [
    `${axisWords(scene.up)} is up${scene.upFrom === "" ? " (assumed)" : ` (from ${scene.upFrom})`}`,
    further > 0 && scene.isMain.includes(true) ? "further points: not named, or computed by the recorder's model" : "",
    ...bodyFacts(scene.bodies),
    scene.forces.length > 0 ? "force arrows: 1 m for 1,000 N" : "",
    hasLines ? (areConventional(scene.names) ? "lines follow the conventional gait marker set" : "lines join markers whose distance stays the same") : "",
  ]
    .filter((f) => f !== "")
    .join("; ");
}

/** What a scene says that does not hold every frame. */
export function thinnedNote(scene: Scene): HTMLElement | null {
  if (scene.frameStep === 1) return null;
  const ending = scene.frameStep === 2 ? "nd" : scene.frameStep === 3 ? "rd" : "th";
  return el("p", { class: "thinned" }, `Long recording: space and curves show every ${number(scene.frameStep)}${ending} frame as it is (${number(scene.rateHz / scene.frameStep, 2)} Hz). The map of gaps and all numbers come from all frames.`);
}
