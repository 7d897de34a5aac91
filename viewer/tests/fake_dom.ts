// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// As much of a document as the sections and the canvases ask for, so that they can be tested without a browser.
// What a browser makes of it is tested in tests/browser.

export class FakeNode {
  parent: FakeElement | null = null;
  get textContent(): string {
    return "";
  }
}

export class FakeText extends FakeNode {
  constructor(readonly data: string) {
    super();
  }
  override get textContent(): string {
    return this.data;
  }
}

interface FakeEvent {
  type: string;
  offsetX?: number;
  offsetY?: number;
  stopped?: boolean;
  stopPropagation: () => void;
  preventDefault: () => void;
}

export class FakeElement extends FakeNode {
  readonly children: FakeNode[] = [];
  readonly attributes = new Map<string, string>();
  readonly style: Record<string, string> = {};
  readonly listeners: [string, (event: FakeEvent) => void][] = [];
  clientWidth = 620;
  width = 0;
  height = 0;
  value = "";
  disabled = false;
  #pen: Pen | null = null;

  constructor(readonly tag: string) {
    super();
  }
  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }
  getAttribute(name: string): string | null {
    return this.attributes.get(name) ?? null;
  }
  removeAttribute(name: string): void {
    this.attributes.delete(name);
  }
  get hidden(): boolean {
    return this.attributes.has("hidden");
  }
  set hidden(yes: boolean) {
    if (yes) this.attributes.set("hidden", "");
    else this.attributes.delete("hidden");
  }
  addEventListener(type: string, listener: (event: FakeEvent) => void): void {
    this.listeners.push([type, listener]);
  }
  append(...added: (FakeNode | string)[]): void {
    for (const a of added) {
      const node = typeof a === "string" ? new FakeText(a) : a;
      if (node.parent !== null) node.parent.children.splice(node.parent.children.indexOf(node), 1);
      node.parent = this;
      this.children.push(node);
    }
  }
  replaceChildren(...added: (FakeNode | string)[]): void {
    for (const c of this.children.splice(0)) c.parent = null;
    this.append(...added);
  }
  override get textContent(): string {
    return this.children.map((c) => c.textContent).join("");
  }
  override set textContent(text: string) {
    this.replaceChildren(text);
  }
  readonly classList = {
    toggle: (name: string, on: boolean): void => {
      const names = new Set((this.getAttribute("class") ?? "").split(" ").filter((n) => n !== ""));
      if (on) names.add(name);
      else names.delete(name);
      this.setAttribute("class", [...names].join(" "));
    },
  };
  get firstChild(): FakeNode | null {
    return this.children[0] ?? null;
  }
  /** The element that was gone to last. */
  static focused: FakeElement | null = null;
  focus(): void {
    FakeElement.focused = this;
  }
  getContext(): Pen {
    return (this.#pen ??= new Pen());
  }

  /** This element and all below it that `fits` likes, in the order of the page. */
  all(fits: (e: FakeElement) => boolean): FakeElement[] {
    const below = this.children.flatMap((c) => (c instanceof FakeElement ? c.all(fits) : []));
    return fits(this) ? [this, ...below] : below;
  }
  tagged(tag: string): FakeElement[] {
    return this.all((e) => e.tag === tag);
  }
  classed(name: string): FakeElement[] {
    return this.all((e) => (e.getAttribute("class") ?? "").split(" ").includes(name));
  }
  /** What an event does here and further up. */
  fire(type: string, at: { offsetX?: number; offsetY?: number; shiftKey?: boolean } = {}): void {
    const event: FakeEvent = { type, ...at, stopPropagation: () => (event.stopped = true), preventDefault: () => undefined };
    for (let e: FakeElement | null = this; e !== null && !event.stopped; e = e.parent) {
      for (const [listened, listener] of e.listeners) if (listened === type) listener(event);
    }
  }
}

export interface Drawn {
  what: "rect" | "text" | "fill" | "stroke";
  colour: unknown;
  alpha: number;
  numbers: number[];
  words: string;
}

/** Remembers what was drawn since the canvas was last cleared. */
export class Pen {
  fillStyle: unknown = "";
  strokeStyle: unknown = "";
  globalAlpha = 1;
  font = "";
  textAlign = "";
  textBaseline = "";
  lineWidth = 1;
  lineJoin = "";
  drawn: Drawn[] = [];
  #path: number[] = [];

  #note(what: Drawn["what"], colour: unknown, numbers: number[], words = ""): void {
    this.drawn.push({ what, colour, alpha: this.globalAlpha, numbers, words });
  }
  setTransform(): void {}
  clearRect(): void {
    this.drawn = [];
  }
  fillRect(...numbers: number[]): void {
    this.#note("rect", this.fillStyle, numbers);
  }
  fillText(words: string, ...numbers: number[]): void {
    this.#note("text", this.fillStyle, numbers, words);
  }
  measureText(words: string): { width: number } {
    return { width: 6 * words.length };
  }
  beginPath(): void {
    this.#path = [];
  }
  moveTo(x: number, y: number): void {
    this.#path.push(x, y);
  }
  lineTo(x: number, y: number): void {
    this.#path.push(x, y);
  }
  fill(): void {
    this.#note("fill", this.fillStyle, this.#path);
  }
  stroke(): void {
    this.#note("stroke", this.strokeStyle, this.#path);
  }
  createPattern(): string {
    return "pattern";
  }
}

let waiting: (() => void)[] = [];
let observers: (() => void)[] = [];

/** Run what was put off until the next frame. */
export function nextFrame(): void {
  for (const run of waiting.splice(0)) run();
}

/** All boxes take another width. */
export function resizeAll(): void {
  for (const o of observers) o();
}

/** Must run before the code under test is imported: it asks for the theme as soon as it is loaded. */
export function install(dark = false): void {
  waiting = [];
  observers = [];
  const listen = (): void => undefined;
  Object.assign(globalThis, {
    document: {
      createElement: (tag: string) => new FakeElement(tag),
      createElementNS: (_namespace: string, tag: string) => new FakeElement(tag),
      createTextNode: (text: string) => new FakeText(text),
    },
    window: { devicePixelRatio: 2, matchMedia: () => ({ matches: dark, addEventListener: listen }), addEventListener: listen },
    location: { hash: "" },
    requestAnimationFrame: (run: () => void) => waiting.push(run),
    ResizeObserver: class {
      constructor(run: () => void) {
        observers.push(run);
      }
      observe(): void {}
    },
  });
}

/** The code under test thinks that it made the browser's own elements. */
export const fake = (node: unknown): FakeElement => node as FakeElement;
