// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { BufferGeometry, Color, CylinderGeometry, DoubleSide, Float32BufferAttribute, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, type Scene as Stage } from "three";
import type { Palette } from "../theme.ts";
import { floorLines, type Floor } from "./floor.ts";
import { Kind } from "./kind.ts";
import type { Scene } from "./scene.ts";
import { add, type Vec } from "./vec.ts";

/** Length of a drawn axis of the laboratory, m. */
const axis = 0.25;

/** What stands still: the floor, the axes of the laboratory, force plates. */
export class Ground {
  readonly #floor: Floor;
  readonly #grid = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true }));
  readonly #plates = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  readonly #plateFill = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.22, depthWrite: false }));
  readonly #axes: Kind;

  constructor(stage: Stage, scene: Scene, floor: Floor) {
    this.#floor = floor;
    stage.add(this.#grid, this.#plateFill, this.#plates);
    this.#axes = new Kind(stage, new CylinderGeometry(1, 1, 1, 8, 1, true), new MeshBasicMaterial({ side: DoubleSide }), 3, { coloured: true });
    this.#layPlates(scene);
  }

  paint(p: Palette): void {
    this.#plates.material.color.set(p.muted);
    this.#plateFill.material.color.set(p.muted);
    const { positions, strong } = floorLines(this.#floor);
    const [weak, firm] = [new Color(p.floor), new Color(p.floorStrong)];
    this.#grid.geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
    this.#grid.geometry.setAttribute("color", new Float32BufferAttribute(strong.flatMap((s) => (s ? firm : weak).toArray()), 3));
    this.#axes.begin();
    const origin = this.#floor.origin;
    p.axes.forEach((value, k) => {
      const way: Vec = [k === 0 ? axis : 0, k === 1 ? axis : 0, k === 2 ? axis : 0];
      this.#axes.rod(origin, add(origin, way), 0.006, new Color(value));
    });
    this.#axes.end();
  }

  #layPlates(scene: Scene): void {
    const edges: number[] = [];
    const faces: number[] = [];
    for (const corners of scene.plates) {
      const [a, b, c, d] = corners.map((x) => add(x, scene.up, 0.002)) as [Vec, Vec, Vec, Vec];
      edges.push(...a, ...b, ...b, ...c, ...c, ...d, ...d, ...a);
      faces.push(...a, ...b, ...c, ...a, ...c, ...d);
    }
    this.#plates.geometry.setAttribute("position", new Float32BufferAttribute(edges, 3));
    this.#plateFill.geometry.setAttribute("position", new Float32BufferAttribute(faces, 3));
    this.#plates.visible = this.#plateFill.visible = edges.length > 0;
  }
}
