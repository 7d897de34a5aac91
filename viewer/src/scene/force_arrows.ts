// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { CylinderGeometry, MeshLambertMaterial, type Scene as Stage } from "three";
import type { Palette } from "../theme.ts";
import { colour, Kind } from "./kind.ts";
import type { Scene } from "./scene.ts";
import { at } from "./track.ts";
import { arrowHead } from "./shapes.ts";
import type { Look } from "./look.ts";
import { add, cross, length, scaled, unit, type Vec } from "./vec.ts";

/** Metres of an arrow for a newton. */
export const metresPerNewton = 1 / 1000;

/** Forces as arrows from where they act. */
export class ForceArrows {
  readonly #scene: Scene;
  readonly #shafts: Kind;
  readonly #heads: Kind;

  constructor(stage: Stage, scene: Scene) {
    this.#scene = scene;
    this.#shafts = new Kind(stage, new CylinderGeometry(1, 1, 1, 14, 1, true), new MeshLambertMaterial(), scene.forces.length);
    this.#heads = new Kind(stage, arrowHead(), new MeshLambertMaterial(), scene.forces.length);
  }

  paint(p: Palette): void {
    colour(this.#shafts, p.force);
    colour(this.#heads, p.force);
  }

  put(look: Look, radius: (x: Vec) => number): void {
    const scene = this.#scene;
    this.#shafts.begin();
    this.#heads.begin();
    for (const { force, point } of scene.forces) {
      const f = scaled(at(force, scene.points, 0, look.point), metresPerNewton);
      const x = at(point, scene.points, 0, look.point);
      if (length(f) < 0.02) continue;
      const r = 0.9 * radius(x);
      const tip = add(x, f);
      const head = Math.min(5 * r, 0.5 * length(f));
      const along = unit(f);
      const aside = unit(cross(along, Math.abs(along[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
      this.#shafts.rod(x, add(tip, along, -head), r);
      this.#heads.put(scaled(aside, 2.4 * r), scaled(along, head), scaled(cross(aside, along), 2.4 * r), tip);
    }
    this.#shafts.end();
    this.#heads.end();
  }
}
