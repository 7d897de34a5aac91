// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, MeshLambertMaterial, type Color, type Material, type MeshBasicMaterial, type Scene as Stage } from "three";
import { add, cross, length, scaled, sub, unit, type Vec } from "./vec.ts";

const white = { r: 1, g: 1, b: 1 };

/**
 * Solids of one kind: one draw call, as many as there are on this instant. Their corners are put where they belong
 * here and not by instancing: where the processor draws, each instance costs as much as a draw call of its own.
 */
export class Kind {
  readonly mesh: Mesh;
  readonly #capacity: number;
  readonly #shape: { corners: Float32Array; normals: Float32Array | null; faces: readonly number[] };
  readonly #coloured: boolean;
  #room = 0;
  #count = 0;

  /** @param capacity  what is put beyond it is left out */
  constructor(stage: Stage, shape: BufferGeometry, material: Material, capacity: number, { order = 0, coloured = false } = {}) {
    const floats = (name: string): Float32Array => Float32Array.from(shape.getAttribute(name).array);
    const corners = floats("position");
    this.#shape = {
      corners,
      normals: material instanceof MeshLambertMaterial ? floats("normal") : null,
      faces: Array.from(shape.index?.array ?? Array.from({ length: corners.length / 3 }, (_, i) => i)),
    };
    this.#capacity = Math.max(1, capacity);
    this.#coloured = coloured;
    material.vertexColors = coloured;
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = order;
    this.#grow();
    stage.add(this.mesh);
  }
  begin(): void {
    this.#count = 0;
  }
  /** A solid with its own axes a, b, c (their lengths are its sizes) at x. */
  put(a: Vec, b: Vec, c: Vec, x: Vec, colour?: Color): void {
    if (this.#count >= this.#capacity) return;
    if (this.#count >= this.#room) this.#grow();
    const { corners, normals } = this.#shape;
    const first = corners.length * this.#count;
    turn(corners, this.#array("position"), first, a, b, c, x);
    // A surface is turned by what keeps its normals upright on it, whatever the sizes are.
    if (normals !== null) turn(normals, this.#array("normal"), first, cross(b, c), cross(c, a), cross(a, b), [0, 0, 0]);
    if (this.#coloured) {
      const { r, g, b: blue } = colour ?? white;
      const out = this.#array("color");
      for (let i = first; i < first + corners.length; i += 3) out.set([r, g, blue], i);
    }
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
    this.mesh.visible = this.#count > 0;
    this.mesh.geometry.setDrawRange(0, this.#count * this.#shape.faces.length);
    for (const attribute of Object.values(this.mesh.geometry.attributes) as BufferAttribute[]) {
      attribute.clearUpdateRanges();
      if (this.#count === 0) continue;
      attribute.addUpdateRange(0, this.#count * this.#shape.corners.length);
      attribute.needsUpdate = true;
    }
  }

  #array(name: string): Float32Array {
    return this.mesh.geometry.getAttribute(name).array as Float32Array;
  }

  /** Room for twice as many. */
  #grow(): void {
    const { corners, normals, faces } = this.#shape;
    const before = this.mesh.geometry;
    this.#room = Math.min(this.#capacity, Math.max(8, 2 * this.#room));
    const made = new BufferGeometry();
    for (const name of ["position", ...(normals === null ? [] : ["normal"]), ...(this.#coloured ? ["color"] : [])]) {
      const values = new Float32Array(corners.length * this.#room);
      const known = before.attributes[name];
      if (known !== undefined) values.set(known.array);
      made.setAttribute(name, new BufferAttribute(values, 3).setUsage(DynamicDrawUsage));
    }
    const cornersOfOne = corners.length / 3;
    const all = new (cornersOfOne * this.#room > 65_535 ? Uint32Array : Uint16Array)(faces.length * this.#room);
    for (let i = 0; i < all.length; ++i) all[i] = faces[i % faces.length]! + cornersOfOne * Math.floor(i / faces.length);
    made.setIndex(new BufferAttribute(all, 1));
    this.mesh.geometry = made;
    before.dispose();
  }
}

/** One colour for all solids of a kind. */
export const colour = (kind: Kind, value: string): void => void (kind.mesh.material as MeshBasicMaterial).color.set(value);

/** Each v of `from` becomes v0 a + v1 b + v2 c + x, from the first on in `to`. */
export function turn(from: Float32Array, to: Float32Array, first: number, a: Vec, b: Vec, c: Vec, x: Vec): void {
  for (let i = 0; i < from.length; i += 3) {
    const [u, v, w] = [from[i]!, from[i + 1]!, from[i + 2]!];
    to[first + i] = u * a[0] + v * b[0] + w * c[0] + x[0];
    to[first + i + 1] = u * a[1] + v * b[1] + w * c[1] + x[1];
    to[first + i + 2] = u * a[2] + v * b[2] + w * c[2] + x[2];
  }
}
