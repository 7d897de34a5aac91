// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { Color, type Scene as Stage } from "three";
import { firstAbsent } from "../states.ts";
import { palette } from "../theme.ts";
import type { Pose } from "./camera.ts";
import { Ribbons } from "./ribbons.ts";
import type { Scene } from "./scene.ts";
import { at } from "./track.ts";
import type { Look } from "./look.ts";
import { sub, type Vec } from "./vec.ts";

const mostTrail = 3000;

/** Paths of markers around the instant, coloured by time. */
export class Trails {
  readonly #scene: Scene;
  readonly #trails: Ribbons;

  constructor(stage: Stage, scene: Scene) {
    this.#scene = scene;
    this.#trails = new Ribbons(stage, mostTrail);
  }

  put(look: Look, pose: Pose, radius: (x: Vec) => number): void {
    const { points, markers } = this.#scene;
    const [from, to] = [Math.max(0, look.point - look.trail[0]), Math.min(points - 1, look.point + look.trail[1])];
    const [old, middle, recent] = palette().trail.map((c) => new Color(c)) as [Color, Color, Color];
    const colour = new Color();
    const sight = (x: Vec): Vec => (look.camera.perspective ? sub(x, pose.eye) : pose.forward);
    const stride = Math.max(1, Math.ceil(((to - from + 1) * look.trailOf.length) / mostTrail));
    this.#trails.begin();
    for (const m of look.trailOf) {
      const places: Vec[] = [];
      const shares: number[] = [];
      const end = (): void => {
        this.#trails.path(places, sight, (x) => 0.28 * radius(x), (i) => {
          const share = shares[i]!;
          return share < 0.5 ? colour.lerpColors(old, middle, 2 * share) : colour.lerpColors(middle, recent, 2 * share - 1);
        });
        places.length = shares.length = 0;
      };
      for (let p = from; p <= to; p += stride) {
        if (markers.states[m * points + p]! >= firstAbsent) {
          end();
          continue;
        }
        places.push(at(markers.x, points, m, p));
        shares.push((p - from) / Math.max(1, to - from));
      }
      end();
    }
    this.#trails.end();
  }
}
