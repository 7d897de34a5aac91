// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { CircleGeometry, CylinderGeometry, DoubleSide, MeshBasicMaterial, MeshLambertMaterial, RingGeometry, type BufferGeometry, type Scene as Stage } from "three";
import { firstAbsent } from "../states.ts";
import type { Palette } from "../theme.ts";
import type { Pose } from "./camera.ts";
import type { Floor } from "./floor.ts";
import { colour, Kind } from "./kind.ts";
import type { Scene } from "./scene.ts";
import { at } from "./track.ts";
import { stateShapes } from "./shapes.ts";
import type { Look } from "./look.ts";
import type { Stick } from "./sticks.ts";
import { scaled, type Vec } from "./vec.ts";

/** Markers in the shapes of their states, what lies under them, beside them and between them. */
export class MarkerSolids {
  readonly #scene: Scene;
  readonly #floor: Floor;
  readonly #lines: readonly Stick[];
  readonly #states: Kind[];
  readonly #others: Kind;
  readonly #ties: Kind;
  readonly #sticks: Kind;
  readonly #shadows: Kind;
  readonly #stickShadows: Kind;
  readonly #ring: Kind;

  constructor(stage: Stage, scene: Scene, lines: readonly Stick[], floor: Floor) {
    this.#scene = scene;
    this.#floor = floor;
    this.#lines = lines;
    const M = scene.names.length;
    const lit = (): MeshLambertMaterial => new MeshLambertMaterial();
    const plain = (): MeshBasicMaterial => new MeshBasicMaterial({ side: DoubleSide });
    const rod = (sides = 10): BufferGeometry => new CylinderGeometry(1, 1, 1, sides, 1, true);
    this.#shadows = new Kind(stage, new CircleGeometry(1, 20), plain(), M);
    this.#stickShadows = new Kind(stage, rod(6), plain(), lines.length);
    this.#sticks = new Kind(stage, rod(), lit(), lines.length);
    this.#states = stateShapes.map(({ geometry, facesEye }) => new Kind(stage, geometry(), facesEye ? plain() : lit(), M));
    this.#others = new Kind(stage, new RingGeometry(0.72, 1, 24), plain(), M);
    this.#ties = new Kind(stage, rod(6), plain(), M);
    this.#ring = new Kind(stage, new RingGeometry(1.55, 1.95, 32), plain(), 1, { order: 5 });
  }

  paint(p: Palette): void {
    p.marks.forEach((value, state) => colour(this.#states[state]!, value));
    colour(this.#others, p.second);
    colour(this.#ties, p.second);
    colour(this.#sticks, p.stick);
    colour(this.#shadows, p.shadow);
    colour(this.#stickShadows, p.shadow);
    colour(this.#ring, p.second);
  }

  /** Which markers are shown. */
  put(look: Look, pose: Pose, radius: (x: Vec) => number): (marker: number) => boolean {
    const shown = this.#putMarkers(look, pose, radius);
    this.#putSticks(look, shown);
    return shown;
  }

  #putMarkers(look: Look, pose: Pose, radius: (x: Vec) => number): (marker: number) => boolean {
    const [scene, floor] = [this.#scene, this.#floor];
    const { points } = scene;
    const all = [...this.#states, this.#shadows, this.#ring, this.#others, this.#ties];
    for (const kind of all) kind.begin();
    const [first, second] = floor.axes;
    const shown = (m: number): boolean => !look.hidden(m);
    for (let m = 0; m < scene.names.length; ++m) {
      if (!shown(m)) continue;
      const state = scene.markers.states[m * points + look.point]!;
      const x = at(scene.markers.x, points, m, look.point);
      const r = radius(x);
      const { facesEye } = stateShapes[state]!;
      if (facesEye) this.#states[state]!.put(scaled(pose.right, r), scaled(pose.up, r), scaled(pose.forward, -r), x);
      else this.#states[state]!.put([r, 0, 0], [0, r, 0], [0, 0, r], x);
      if (m === look.picked) this.#ring.put(scaled(pose.right, r), scaled(pose.up, r), scaled(pose.forward, -r), x);
      if (state < firstAbsent) {
        this.#shadows.put(scaled(first, r), scaled(second, r), scaled(scene.up, r), floor.below(x, 0.0015));
      }
      const other = look.others ? this.#other(m, look.point) : null;
      if (other === null) continue;
      const reach = scaled(pose.right, 1.25 * r);
      this.#others.put(reach, scaled(pose.up, 1.25 * r), scaled(pose.forward, -r), other);
      if (state < firstAbsent) this.#ties.rod(x, other, 0.35 * r);
    }
    for (const kind of all) kind.end();
    return shown;
  }

  /** Where the model has a marker, or where it was before cleaning; null where nobody knows. */
  #other(marker: number, point: number): Vec | null {
    const scene = this.#scene;
    const x = scene.model ?? scene.before?.x;
    if (x === undefined) return null;
    if (scene.model === null && scene.before!.states[marker * scene.points + point]! >= firstAbsent) return null;
    if (scene.model !== null && scene.markers.states[marker * scene.points + point]! >= firstAbsent) return null;
    return at(x, scene.points, marker, point);
  }

  #putSticks(look: Look, shown: (marker: number) => boolean): void {
    const scene = this.#scene;
    const { points, markers } = scene;
    this.#sticks.begin();
    this.#stickShadows.begin();
    for (const [a, b] of look.lines ? this.#lines : []) {
      const absent = (m: number): boolean => !shown(m) || markers.states[m * points + look.point]! >= firstAbsent;
      if (absent(a) || absent(b)) continue;
      const from = at(markers.x, points, a, look.point);
      const to = at(markers.x, points, b, look.point);
      this.#sticks.rod(from, to, 0.0045);
      this.#stickShadows.rod(this.#floor.below(from, 0.001), this.#floor.below(to, 0.001), 0.004);
    }
    this.#sticks.end();
    this.#stickShadows.end();
  }
}
