// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { LiveSummary } from "../page_types.ts";
import type { Bodies, Goals } from "../scene/scene.ts";
import { add, cross, distance, scaled, sub, type Vec } from "../scene/vec.ts";
import type { AnglesMessage } from "./message.ts";

/** Bodies shorter than this end beyond their mass centre. */
const shortest = 0.01;

/** v turned by the unit quaternion w x y z. */
export function turned([w, x, y, z]: readonly [number, number, number, number], v: Vec): Vec {
  const t = scaled(cross([x, y, z], v), 2);
  return add(add(v, t, w), cross([x, y, z], t));
}

/** The model that follows a source: where its bodies, its markers and their goals were in the newest frame that it has. */
export class LiveBody {
  readonly bodies: Bodies;
  readonly goals: Goals;
  frame = -1;
  /** How far a push has moved a marker at most, mm; null: nobody pushes. */
  pushed_mm: number | null = null;
  readonly #points: number;
  readonly #children: number[][];
  #poses: Float32Array = new Float32Array(0);

  constructor(
    readonly summary: LiveSummary,
    points: number,
  ) {
    const { bodies, targets } = summary;
    const nowhere = (): Float32Array => new Float32Array(3 * bodies.length * points).fill(NaN);
    this.#points = points;
    this.#children = bodies.map((_, b) => bodies.flatMap((other, i) => (other.parent === b ? [i] : [])));
    this.bodies = { names: bodies.map((b) => b.name), massKg: bodies.map((b) => b.mass_kg), origin: nowhere(), end: nowhere(), meshes: [], meshesNote: "" };
    const none = (): Float32Array => new Float32Array(3 * targets.length).fill(NaN);
    this.goals = { x: none(), model: none(), level: targets.map((t) => t.level), push: null };
  }

  /** A newer frame. */
  push(message: AnglesMessage): void {
    if (message.frame < this.frame || message.poses.length !== 7 * this.summary.bodies.length) return;
    this.frame = message.frame;
    this.#poses = message.poses;
    this.pushed_mm = message.pushed_mm;
    this.summary.targets.forEach((target, t) => {
      this.goals.model.set(this.world(target.body, target.point_m), 3 * t);
      for (let k = 0; k < 3; ++k) this.goals.x[3 * t + k] = message.goals[3 * target.marker + k] ?? NaN;
    });
  }

  /** Put the bodies at a point of the scene. */
  putAt(point: number): void {
    this.summary.bodies.forEach((body, b) => {
      const origin = this.origin(b);
      const carried = this.#children[b]!.map((child) => this.origin(child));
      const middle = scaled(carried.reduce((sum, x) => add(sum, x), [0, 0, 0] as Vec), 1 / Math.max(1, carried.length));
      const end = carried.length > 0 && distance(middle, origin) >= shortest ? middle : this.world(b, scaled(body.com_m, 2));
      for (const [list, x] of [[this.bodies.origin, origin], [this.bodies.end, end]] as const) {
        for (const k of [0, 1, 2] as const) list[(3 * b + k) * this.#points + point] = x[k];
      }
    });
  }

  /** Where a body begins; NaN where nothing is known. */
  origin(body: number): Vec {
    const at = (k: number): number => this.#poses[7 * body + k] ?? NaN;
    return [at(0), at(1), at(2)];
  }

  /** A point of a body in the world. */
  world(body: number, point: Vec): Vec {
    return add(this.origin(body), turned(this.#turn(body), point));
  }

  /** A point of the world in a body. */
  inBody(body: number, x: Vec): Vec {
    const [w, i, j, k] = this.#turn(body);
    return turned([w, -i, -j, -k], sub(x, this.origin(body)));
  }

  #turn(body: number): readonly [number, number, number, number] {
    const at = (k: number): number => this.#poses[7 * body + k] ?? NaN;
    return [at(3), at(4), at(5), at(6)];
  }

  /** RMS distance of the body that is shown to the goals of each level, mm; NaN where it has none. */
  levelDistances(): number[] {
    const squares = this.summary.levels.map(() => 0);
    const counts = this.summary.levels.map(() => 0);
    const { x, model, level } = this.goals;
    level.forEach((l, t) => {
      const off = distance([x[3 * t]!, x[3 * t + 1]!, x[3 * t + 2]!], [model[3 * t]!, model[3 * t + 1]!, model[3 * t + 2]!]);
      if (Number.isNaN(off)) return;
      squares[l]! += off * off;
      counts[l]! += 1;
    });
    return squares.map((s, l) => (counts[l] === 0 ? NaN : 1000 * Math.sqrt(s / counts[l]!)));
  }
}
