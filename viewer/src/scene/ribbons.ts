// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, MeshBasicMaterial, type Color, type Scene as Stage } from "three";
import { cross, length, scaled, sub, type Vec } from "./vec.ts";

/**
 * Paths as bands that face the eye, all in one draw call. Two corners a point: a tenth of what rods need, which is
 * what counts where the processor draws.
 */
export class Ribbons {
  readonly mesh: Mesh;
  readonly #corners: BufferAttribute;
  readonly #colours: BufferAttribute;
  readonly #faces: BufferAttribute;
  #points = 0;
  #pieces = 0;

  constructor(
    stage: Stage,
    readonly capacity: number,
  ) {
    const geometry = new BufferGeometry();
    const dynamic = (attribute: BufferAttribute): BufferAttribute => attribute.setUsage(DynamicDrawUsage);
    this.#corners = dynamic(new BufferAttribute(new Float32Array(6 * capacity), 3));
    this.#colours = dynamic(new BufferAttribute(new Float32Array(6 * capacity), 3));
    this.#faces = dynamic(new BufferAttribute(new Uint16Array(6 * capacity), 1));
    geometry.setAttribute("position", this.#corners);
    geometry.setAttribute("color", this.#colours);
    geometry.setIndex(this.#faces);
    this.mesh = new Mesh(geometry, new MeshBasicMaterial({ side: DoubleSide, vertexColors: true }));
    this.mesh.frustumCulled = false;
    stage.add(this.mesh);
  }

  begin(): void {
    this.#points = this.#pieces = 0;
  }

  /**
   * A path through these places.
   * @param sight   from the eye to a place
   * @param radius  half the width there, m
   */
  path(places: readonly Vec[], sight: (x: Vec) => Vec, radius: (x: Vec) => number, colour: (place: number) => Color): void {
    if (places.length < 2) return;
    let side: Vec = [0, 0, 0];
    const first = this.#points;
    for (const [i, x] of places.entries()) {
      if (this.#points >= this.capacity) return;
      const along = sub(places[Math.min(places.length - 1, i + 1)]!, places[Math.max(0, i - 1)]!);
      const across = cross(along, sight(x));
      const size = length(across);
      // What stands still or moves along the line of sight has no side of its own.
      if (size > 1e-12) side = scaled(across, 1 / size);
      const r = radius(x);
      const corner = 2 * this.#points;
      this.#corners.setXYZ(corner, x[0] - r * side[0], x[1] - r * side[1], x[2] - r * side[2]);
      this.#corners.setXYZ(corner + 1, x[0] + r * side[0], x[1] + r * side[1], x[2] + r * side[2]);
      const { r: red, g: green, b: blue } = colour(i);
      this.#colours.setXYZ(corner, red, green, blue);
      this.#colours.setXYZ(corner + 1, red, green, blue);
      if (this.#points > first) {
        const face = [corner - 2, corner - 1, corner, corner, corner - 1, corner + 1];
        this.#faces.array.set(face, 6 * this.#pieces);
        ++this.#pieces;
      }
      ++this.#points;
    }
  }

  end(): void {
    this.mesh.visible = this.#pieces > 0;
    this.mesh.geometry.setDrawRange(0, 6 * this.#pieces);
    for (const [attribute, used] of [[this.#corners, 6 * this.#points], [this.#colours, 6 * this.#points], [this.#faces, 6 * this.#pieces]] as const) {
      attribute.clearUpdateRanges();
      if (used === 0) continue;
      attribute.addUpdateRange(0, used);
      attribute.needsUpdate = true;
    }
  }
}
