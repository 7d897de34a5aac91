// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, MeshLambertMaterial, type Scene as Stage } from "three";
import { turn } from "./kind.ts";
import { axesOf, type BodyMesh } from "./meshes.ts";
import type { Scene } from "./scene.ts";
import { at } from "./track.ts";

/** The meshes of a model's bodies: one draw call. Their points are put where they belong here, as those of other solids. */
export class Skins {
  readonly mesh: Mesh<BufferGeometry, MeshLambertMaterial>;
  readonly #scene: Scene;
  readonly #meshes: readonly BodyMesh[];
  #drawn = -1;

  constructor(stage: Stage, scene: Scene) {
    this.#scene = scene;
    this.#meshes = scene.bodies?.meshes ?? [];
    const points = this.#meshes.reduce((n, m) => n + m.places.length / 3, 0);
    const geometry = new BufferGeometry();
    for (const name of ["position", "normal"]) {
      geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * points), 3).setUsage(DynamicDrawUsage));
    }
    const corners = new Uint32Array(this.#meshes.reduce((n, m) => n + m.corners.length, 0));
    let [first, next] = [0, 0];
    for (const one of this.#meshes) {
      for (const corner of one.corners) corners[next++] = first + corner;
      first += one.places.length / 3;
    }
    geometry.setIndex(new BufferAttribute(corners, 1));
    // Files in the field do not agree on which side of a triangle is its outer one.
    this.mesh = new Mesh(geometry, new MeshLambertMaterial({ side: DoubleSide }));
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
    stage.add(this.mesh);
  }

  put(point: number, shown: boolean): void {
    this.mesh.visible = shown && this.#meshes.length > 0;
    if (!this.mesh.visible || point === this.#drawn) return;
    this.#drawn = point;
    const { points, bodies } = this.#scene;
    const { position, normal } = this.mesh.geometry.attributes as { position: BufferAttribute; normal: BufferAttribute };
    let first = 0;
    for (const one of this.#meshes) {
      const [a, b, c] = axesOf(one, points, point);
      turn(one.places, position.array as Float32Array, first, a, b, c, at(bodies!.origin, points, one.body, point));
      turn(one.normals, normal.array as Float32Array, first, a, b, c, [0, 0, 0]);
      first += one.places.length;
    }
    position.needsUpdate = normal.needsUpdate = true;
  }
}
