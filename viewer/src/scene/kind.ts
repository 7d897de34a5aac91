// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { DynamicDrawUsage, InstancedMesh, Matrix4, type BufferGeometry, type Color, type Material, type Scene as Stage } from "three";
import { add, cross, length, scaled, sub, unit, type Vec } from "./vec.ts";

/** Solids of one kind: one draw call, as many as there are on this instant. */
export class Kind {
  readonly mesh: InstancedMesh;
  #count = 0;
  readonly #matrix = new Matrix4();

  constructor(stage: Stage, geometry: BufferGeometry, material: Material, capacity: number, order = 0) {
    this.mesh = new InstancedMesh(geometry, material, Math.max(1, capacity));
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = order;
    stage.add(this.mesh);
  }
  begin(): void {
    this.#count = 0;
  }
  /** A solid with its own axes a, b, c (their lengths are its sizes) at x. */
  put(a: Vec, b: Vec, c: Vec, x: Vec, colour?: Color): void {
    if (this.#count >= this.mesh.instanceMatrix.count) return;
    this.#matrix.set(a[0], b[0], c[0], x[0], a[1], b[1], c[1], x[1], a[2], b[2], c[2], x[2], 0, 0, 0, 1);
    this.mesh.setMatrixAt(this.#count, this.#matrix);
    if (colour !== undefined) this.mesh.setColorAt(this.#count, colour);
    ++this.#count;
  }
  /** A rod of this radius between two places; its own y lies along it. */
  rod(from: Vec, to: Vec, radius: number, colour?: Color): void {
    const way = sub(to, from);
    if (length(way) < 1e-9) return;
    const along = unit(way);
    const aside = unit(cross(along, Math.abs(along[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
    this.put(scaled(aside, radius), way, scaled(cross(aside, along), radius), scaled(add(from, to), 0.5), colour);
  }
  end(): void {
    this.mesh.count = this.#count;
    this.mesh.visible = this.#count > 0;
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.mesh.instanceColor !== null) this.mesh.instanceColor.needsUpdate = true;
  }
}
