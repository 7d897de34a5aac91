// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A force on the body of a live page: where it is held, how far it is drawn, and what the server hears.
import { add, distance, length, scaled, sub, unit, type Vec } from "../scene/vec.ts";
import type { LiveBody } from "./body.ts";

/** N for a metre that the pointer moves in the picture. */
export const dragNPerM = 1000;
/** N, as the server has it. */
export const mostN = 500;
/** A force that lasts is said again so often, ms: the server lets go of what is not said for a second. */
const again_ms = 200;
/** Pixels from a body within which it is held. */
const reach = 24;

/** How the picture shows the world. */
export interface Eyes {
  place: (x: Vec) => [left: number, top: number, depth: number];
  /** Metres to the right and upwards of a pixel, at the depth of a place. */
  pixel: (x: Vec) => { right: Vec; up: Vec };
}

interface Held {
  body: number;
  /** In the body, m. */
  point: Vec;
  /** Where the pointer took hold, pixels. */
  from: readonly [number, number];
}

export class PushHand {
  /** In the world, N; null: nothing is held. */
  force: Vec | null = null;
  /** More was asked for than is applied. */
  isCapped = false;
  #held: Held | null = null;
  #said: Vec | null = null;
  #saidAt = -Infinity;

  constructor(
    readonly body: LiveBody,
    readonly send: (body: number, point: Vec, force: Vec) => void,
  ) {}

  /** Name of the body that is held; empty: none. */
  get name(): string {
    return this.#held === null ? "" : this.body.bodies.names[this.#held.body]!;
  }

  /** Take hold of what is nearest to a place of the picture; false: nothing is near. */
  grab(x: number, y: number, eyes: Eyes): boolean {
    let [best, least]: [Held | null, number] = [null, reach];
    for (const [body, { com_m }] of this.body.summary.bodies.entries()) {
      const from = this.body.origin(body);
      const to = this.body.world(body, scaled(com_m, 2));
      const found = nearestOnLine(x, y, from, to, eyes);
      if (found === null || found.off >= least) continue;
      [best, least] = [{ body, point: this.body.inBody(body, found.x), from: [x, y] }, found.off];
    }
    this.#held = best;
    this.force = best === null ? null : [0, 0, 0];
    return best !== null;
  }

  /** The pointer is here now. */
  drag(x: number, y: number, eyes: Eyes): void {
    if (this.#held === null) return;
    const { right, up } = eyes.pixel(this.body.world(this.#held.body, this.#held.point));
    const way = add(scaled(right, x - this.#held.from[0]), up, this.#held.from[1] - y);
    this.#set(scaled(way, dragNPerM));
  }

  /** Push the mass centre of a body without a pointer. */
  push(body: number, force: Vec): void {
    this.#held = { body, point: this.body.summary.bodies[body]!.com_m, from: [0, 0] };
    this.#set(force);
  }

  drop(): void {
    if (this.#held !== null && this.#said !== null) this.send(this.#held.body, this.#held.point, [0, 0, 0]);
    this.#held = this.#said = this.force = null;
    this.isCapped = false;
    this.body.goals.push = null;
  }

  #set(force: Vec): void {
    this.isCapped = length(force) > mostN;
    // A little less, so that rounding does not exceed it.
    this.force = this.isCapped ? scaled(unit(force), 0.9999 * mostN) : force;
  }

  /** Once a picture: the line from where the force acts, and what the server has not heard. */
  tick(now_ms: number): void {
    if (this.#held === null || this.force === null) return;
    const from = this.body.world(this.#held.body, this.#held.point);
    this.body.goals.push = Number.isNaN(from[0]) ? null : [from, add(from, this.force, 1 / dragNPerM)];
    if (length(this.force) === 0 && this.#said === null) return;
    const isNew = this.#said === null || distance(this.#said, this.force) > 0;
    if (!isNew && now_ms - this.#saidAt < again_ms) return;
    this.#said = this.force;
    this.#saidAt = now_ms;
    this.send(this.#held.body, this.#held.point, this.force);
  }
}

/** The point of a line nearest to a place of the picture, and its distance in pixels; null where it is not in sight. */
function nearestOnLine(x: number, y: number, from: Vec, to: Vec, eyes: Eyes): { x: Vec; off: number } | null {
  const [a, b] = [eyes.place(from), eyes.place(to)];
  if (!(a[2] > 0 && b[2] > 0)) return null;
  const way = [b[0] - a[0], b[1] - a[1]] as const;
  const squared = way[0] ** 2 + way[1] ** 2;
  const t = squared === 0 ? 0 : Math.min(1, Math.max(0, ((x - a[0]) * way[0] + (y - a[1]) * way[1]) / squared));
  return { x: add(from, sub(to, from), t), off: Math.hypot(a[0] + t * way[0] - x, a[1] + t * way[1] - y) };
}
