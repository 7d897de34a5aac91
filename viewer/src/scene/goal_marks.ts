// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { ConeGeometry, CylinderGeometry, DoubleSide, MeshBasicMaterial, MeshLambertMaterial, RingGeometry, SphereGeometry, type Scene as Stage } from "three";
import type { Palette } from "../theme.ts";
import type { Pose } from "./camera.ts";
import { colour, Kind } from "./kind.ts";
import type { Look } from "./look.ts";
import type { Scene } from "./scene.ts";
import { add, cross, length, scaled, sub, unit, type Vec } from "./vec.ts";

/** Corners of the ring that stands for a goal of each level; many make a circle. */
export const goalCorners = [28, 4, 3, 6, 5, 8] as const;

/** The colour and the shape of a level: after the last the first comes again. */
export const kindOfLevel = (level: number): number => level % goalCorners.length;

const placeOf = (x: Float32Array, i: number): Vec => [x[3 * i]!, x[3 * i + 1]!, x[3 * i + 2]!];

/** Goals in the shape and the colour of their level, the markers of the model that follow them, and a force. */
export class GoalMarks {
  readonly #scene: Scene;
  readonly #rings: Kind[];
  readonly #ties: Kind[];
  readonly #markers: Kind;
  readonly #push: Kind;
  readonly #head: Kind;

  constructor(stage: Stage, scene: Scene) {
    this.#scene = scene;
    const count = scene.goals?.level.length ?? 0;
    const plain = (): MeshBasicMaterial => new MeshBasicMaterial({ side: DoubleSide });
    this.#rings = goalCorners.map((corners) => new Kind(stage, new RingGeometry(0.7, 1, corners), plain(), count, { order: 4 }));
    this.#ties = goalCorners.map(() => new Kind(stage, new CylinderGeometry(1, 1, 1, 6, 1, true), plain(), count));
    this.#markers = new Kind(stage, new SphereGeometry(1, 10, 7), new MeshLambertMaterial(), count);
    // Seen through the body.
    const before = (): MeshBasicMaterial => new MeshBasicMaterial({ depthTest: false });
    this.#push = new Kind(stage, new CylinderGeometry(1, 1, 1, 10, 1, true), before(), 1, { order: 6 });
    this.#head = new Kind(stage, new ConeGeometry(1, 1, 14), before(), 1, { order: 6 });
  }

  paint(p: Palette): void {
    p.levels.forEach((value, i) => {
      colour(this.#rings[i]!, value);
      colour(this.#ties[i]!, value);
    });
    (this.#markers.mesh.material as MeshLambertMaterial).color.set(p.joint);
    colour(this.#push, p.ink);
    colour(this.#head, p.ink);
  }

  put(look: Look, pose: Pose, radius: (x: Vec) => number): void {
    const { goals } = this.#scene;
    const all = [...this.#rings, ...this.#ties, this.#markers, this.#push, this.#head];
    for (const kind of all) kind.begin();
    goals?.level.forEach((level, i) => {
      const [goal, own] = [placeOf(goals.x, i), placeOf(goals.model, i)];
      if (look.goals !== true || Number.isNaN(own[0])) return;
      const r = 0.6 * radius(own);
      this.#markers.put([r, 0, 0], [0, r, 0], [0, 0, r], own);
      if (Number.isNaN(goal[0])) return;
      const reach = 1.5 * radius(goal);
      const kind = kindOfLevel(level);
      this.#rings[kind]!.put(scaled(pose.right, reach), scaled(pose.up, reach), scaled(pose.forward, -reach), goal);
      this.#ties[kind]!.rod(own, goal, 0.3 * r);
    });
    if (goals?.push) this.#putPush(goals.push, radius);
    for (const kind of all) kind.end();
  }

  #putPush([from, to]: readonly [Vec, Vec], radius: (x: Vec) => number): void {
    const way = sub(to, from);
    if (length(way) < 1e-4) return;
    const r = 0.5 * radius(from);
    const along = unit(way);
    const head = Math.min(5 * r, length(way));
    this.#push.rod(from, add(to, along, -0.5 * head), r);
    const aside = unit(cross(along, Math.abs(along[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
    const across = cross(aside, along);
    this.#head.put(scaled(aside, 2.2 * r), scaled(along, head), scaled(across, 2.2 * r), add(to, along, -0.5 * head));
  }
}
