// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { BoxGeometry, Color, MeshBasicMaterial, MeshLambertMaterial, Scene as Stage, SphereGeometry, TetrahedronGeometry } from "three";
import { describe, expect, it } from "vitest";
import { namesProgram } from "../../src/scene/drawn_by.ts";
import { Kind } from "../../src/scene/kind.ts";
import { Ribbons } from "../../src/scene/ribbons.ts";
import { cross, dot, length, sub, unit, type Vec } from "../../src/scene/vec.ts";

const corner = (mesh: Kind["mesh"] | Ribbons["mesh"], name: string, i: number): Vec => {
  const a = mesh.geometry.getAttribute(name);
  return [a.getX(i), a.getY(i), a.getZ(i)];
};
const near = (a: Vec, b: Vec): void => a.forEach((v, k) => expect(v).toBeCloseTo(b[k as 0], 5));

describe("Kind", () => {
  it("puts every corner of every solid where its axes say, in one mesh", () => {
    const stage = new Stage();
    const box = new BoxGeometry(2, 2, 2);
    const kind = new Kind(stage, box, new MeshBasicMaterial(), 2);
    kind.begin();
    kind.put([1, 0, 0], [0, 2, 0], [0, 0, 3], [10, 20, 30]);
    kind.put([0, 1, 0], [-1, 0, 0], [0, 0, 1], [0, 0, 0]);
    kind.end();
    expect(stage.children.length).toBe(1);
    const corners = box.getAttribute("position");
    for (let i = 0; i < corners.count; ++i) {
      const [u, v, w] = [corners.getX(i), corners.getY(i), corners.getZ(i)];
      near(corner(kind.mesh, "position", i), [10 + u, 20 + 2 * v, 30 + 3 * w]);
      near(corner(kind.mesh, "position", corners.count + i), [-v, u, w]);
    }
    expect(kind.mesh.geometry.drawRange.count).toBe(2 * box.index!.count);
  });
  it("keeps normals upright on solids of unequal and slanted axes", () => {
    const ball = new SphereGeometry(1, 12, 8);
    const kind = new Kind(new Stage(), ball, new MeshLambertMaterial(), 1);
    const [a, b, c] = [[3, 0, 0], [1, 2, 0], [0.5, -0.2, 0.7]] as [Vec, Vec, Vec];
    kind.begin();
    kind.put(a, b, c, [5, 6, 7]);
    kind.end();
    // On a sphere a side is tangential where it is at right angles to the radius; so must the turned one be.
    const at = ball.getAttribute("position");
    for (let i = 0; i < at.count; ++i) {
      const n: Vec = [at.getX(i), at.getY(i), at.getZ(i)];
      const side = unit(cross(n, Math.abs(n[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
      const turned: Vec = [0, 1, 2].map((k) => side[0] * a[k as 0] + side[1] * b[k as 0] + side[2] * c[k as 0]) as Vec;
      const normal = corner(kind.mesh, "normal", i);
      expect(dot(unit(normal), unit(turned))).toBeCloseTo(0, 4);
      expect(dot(normal, sub(corner(kind.mesh, "position", i), [5, 6, 7]))).toBeGreaterThan(0);
    }
  });
  it("has room for as many as it was told, and no more, and keeps what was put when room is made", () => {
    const kind = new Kind(new Stage(), new TetrahedronGeometry(1), new MeshBasicMaterial(), 21);
    kind.begin();
    for (let i = 0; i < 30; ++i) kind.put([1, 0, 0], [0, 1, 0], [0, 0, 1], [i, 0, 0]);
    kind.end();
    const faces = kind.mesh.geometry.index!;
    expect(kind.mesh.geometry.drawRange.count).toBe(21 * 12);
    expect(faces.count).toBe(21 * 12);
    expect(Math.max(...faces.array)).toBe(21 * 12 - 1);
    const first = corner(kind.mesh, "position", 0);
    near(corner(kind.mesh, "position", 12 * 20), [first[0] + 20, first[1], first[2]]);
  });
  it("counts corners beyond 65,535", () => {
    const kind = new Kind(new Stage(), new SphereGeometry(1, 16, 11), new MeshBasicMaterial(), 400);
    kind.begin();
    for (let i = 0; i < 400; ++i) kind.put([1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]);
    kind.end();
    expect(kind.mesh.geometry.index!.array[kind.mesh.geometry.index!.count - 1]).toBeGreaterThan(65_535);
  });
  it("shows nothing where nothing was put, and a rod along its way in its colour", () => {
    const kind = new Kind(new Stage(), new BoxGeometry(1, 1, 1), new MeshBasicMaterial(), 3, { coloured: true });
    kind.begin();
    kind.rod([1, 1, 1], [1, 1, 1], 0.1);
    kind.end();
    expect(kind.mesh.visible).toBe(false);
    kind.begin();
    kind.rod([0, 0, 0], [0, 0, 4], 0.5, new Color(0.25, 0.5, 0.75));
    kind.end();
    expect(kind.mesh.visible).toBe(true);
    near(corner(kind.mesh, "color", 23), [0.25, 0.5, 0.75]);
    const all = Array.from({ length: 24 }, (_, i) => corner(kind.mesh, "position", i));
    expect([Math.min(...all.map((x) => x[2])), Math.max(...all.map((x) => x[2]))]).toEqual([0, 4]);
    for (const x of all) expect(Math.hypot(x[0], x[1])).toBeCloseTo(Math.SQRT2 * 0.25, 5);
  });
});

describe("Ribbons", () => {
  const colour = new Color(1, 0.5, 0);
  const sight = (): Vec => [0, 0, -1];
  const put = (ribbons: Ribbons, places: Vec[]): void => ribbons.path(places, sight, () => 0.1, () => colour);

  it("are as wide as they shall be, across the path and the line of sight", () => {
    const ribbons = new Ribbons(new Stage(), 10);
    ribbons.begin();
    put(ribbons, [[0, 0, 0], [1, 0, 0], [2, 0, 0]]);
    ribbons.end();
    for (let i = 0; i < 3; ++i) {
      const [a, b] = [corner(ribbons.mesh, "position", 2 * i), corner(ribbons.mesh, "position", 2 * i + 1)];
      near(sub(b, a).map(Math.abs) as Vec, [0, 0.2, 0]);
      near([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2], [i, 0, 0]);
      near(corner(ribbons.mesh, "color", 2 * i), [1, 0.5, 0]);
    }
    expect(ribbons.mesh.geometry.drawRange.count).toBe(12);
    expect([...ribbons.mesh.geometry.index!.array.slice(0, 12)]).toEqual([0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5]);
  });
  it("do not join one path to the next, and leave out a single place", () => {
    const ribbons = new Ribbons(new Stage(), 10);
    ribbons.begin();
    put(ribbons, [[0, 0, 0], [1, 0, 0]]);
    put(ribbons, [[5, 5, 5]]);
    put(ribbons, [[0, 1, 0], [1, 1, 0]]);
    ribbons.end();
    expect([...ribbons.mesh.geometry.index!.array.slice(0, 12)]).toEqual([0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7]);
  });
  it("have no more places than there is room for", () => {
    const ribbons = new Ribbons(new Stage(), 4);
    ribbons.begin();
    put(ribbons, [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0], [5, 0, 0]]);
    ribbons.end();
    expect(ribbons.mesh.geometry.drawRange.count).toBe(18);
  });
  it("draw what stands still and what goes along the line of sight without a broken number", () => {
    const ribbons = new Ribbons(new Stage(), 10);
    ribbons.begin();
    put(ribbons, [[0, 0, 0], [0, 0, 0], [0, 0, -1], [1, 0, -1]]);
    ribbons.end();
    for (let i = 0; i < 8; ++i) expect(length(corner(ribbons.mesh, "position", i))).toBeLessThan(2);
  });
  it("show nothing without a path", () => {
    const ribbons = new Ribbons(new Stage(), 10);
    ribbons.begin();
    ribbons.end();
    expect(ribbons.mesh.visible).toBe(false);
  });
});

describe("namesProgram", () => {
  it("knows renderers without a graphics card from cards", () => {
    for (const name of ["ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)", "llvmpipe (LLVM 15.0.6, 256 bits)", "Microsoft Basic Render Driver", "Apple Software Renderer"]) {
      expect(namesProgram(name)).toBe(true);
    }
    for (const name of ["ANGLE (Intel, Mesa Intel(R) UHD Graphics 620 (KBL GT2), OpenGL 4.6)", "ANGLE (NVIDIA, NVIDIA GeForce RTX 3060 Direct3D11)", "Apple M2", "Mali-G78"]) {
      expect(namesProgram(name)).toBe(false);
    }
  });
});
