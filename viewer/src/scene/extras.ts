// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import {
  BufferGeometry,
  Color,
  CylinderGeometry,
  DoubleSide,
  Float32BufferAttribute,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  SphereGeometry,
  type Scene as Stage,
} from "three";
import { firstAbsent } from "../states.ts";
import type { Palette } from "../theme.ts";
import { Kind } from "./kind.ts";
import { cornersOf, type Plane } from "./plane.ts";
import type { CameraPlace, Scene } from "./scene.ts";
import { at } from "./track.ts";
import { Skins } from "./skins.ts";
import type { Look } from "./look.ts";
import { add, cross, length, scaled, sub, unit, type Vec } from "./vec.ts";

/** Of a normal distribution in space: 95 % lie within so many standard deviations. */
export const within95 = 2.7955;
/** Length of a drawn camera, m. */
const cameraLength = 0.12;
const boxEdges = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7] as const;

/** What a scene holds besides markers: joint centres with their regions, cameras with their rays, a plane. */
export class Extras {
  readonly #scene: Scene;
  readonly #centres: Kind;
  readonly #links: Kind;
  readonly #bodies: Kind;
  readonly #skins: Skins;
  readonly #hasMesh: ReadonlySet<number>;
  readonly #regions: Kind;
  readonly #cameras: LineSegments;
  readonly #nominal: LineSegments;
  readonly #rays: LineSegments;
  readonly #box: LineSegments;
  readonly #sheet: Mesh;
  readonly #axes: Kind;

  constructor(stage: Stage, scene: Scene) {
    this.#scene = scene;
    const joints = scene.skeleton?.names.length ?? 0;
    this.#links = new Kind(stage, new CylinderGeometry(1, 1, 1, 12, 1, true), new MeshLambertMaterial(), scene.skeleton?.links.length ?? 0);
    this.#bodies = new Kind(stage, new SphereGeometry(1, 20, 14), new MeshLambertMaterial({ transparent: true, opacity: 0.5, depthWrite: false }), scene.bodies?.names.length ?? 0, { order: 1 });
    this.#skins = new Skins(stage, scene);
    this.#hasMesh = new Set((scene.bodies?.meshes ?? []).map((mesh) => mesh.body));
    this.#centres = new Kind(stage, new SphereGeometry(1, 16, 11), new MeshLambertMaterial(), joints);
    this.#regions = new Kind(stage, new SphereGeometry(1, 24, 16), new MeshLambertMaterial({ transparent: true, opacity: 0.38, depthWrite: false }), joints, { order: 3 });
    const lines = (dashed = false): LineSegments => {
      const made = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: dashed, opacity: dashed ? 0.45 : 1 }));
      made.frustumCulled = false;
      stage.add(made);
      return made;
    };
    this.#cameras = lines();
    this.#nominal = lines(true);
    this.#rays = lines(true);
    this.#box = lines();
    this.#sheet = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.16, depthWrite: false }));
    this.#sheet.frustumCulled = false;
    stage.add(this.#sheet);
    this.#axes = new Kind(stage, new CylinderGeometry(1, 1, 1, 8, 1, true), new MeshBasicMaterial(), 3, { coloured: true });
    set(this.#cameras, scene.cameras.filter((c) => !c.nominal).flatMap(frustum));
    set(this.#nominal, scene.cameras.filter((c) => c.nominal).flatMap(frustum));
  }

  paint(p: Palette): void {
    (this.#centres.mesh.material as MeshLambertMaterial).color.set(p.joint);
    (this.#bodies.mesh.material as MeshLambertMaterial).color.set(p.body);
    this.#skins.mesh.material.color.set(p.mesh);
    (this.#links.mesh.material as MeshLambertMaterial).color.set(p.bone);
    (this.#regions.mesh.material as MeshLambertMaterial).color.set(p.second);
    (this.#cameras.material as LineBasicMaterial).color.set(p.ink);
    (this.#nominal.material as LineBasicMaterial).color.set(p.second);
    (this.#rays.material as LineBasicMaterial).color.set(p.second);
    (this.#box.material as LineBasicMaterial).color.set(p.muted);
    (this.#sheet.material as MeshBasicMaterial).color.set(p.line);
    this.#axisColours = p.axes.map((value) => new Color(value));
  }
  #axisColours: Color[] = [];

  put(look: Look, radius: (x: Vec) => number, shown: (marker: number) => boolean): void {
    this.#putBodies(look);
    this.#putSkeleton(look, radius);
    this.#putRays(look, shown);
    this.#putPlane(look.plane, radius);
  }

  #putBodies(look: Look): void {
    const { bodies, points } = this.#scene;
    this.#bodies.begin();
    this.#skins.put(look.point, look.bodies);
    bodies?.names.forEach((_, b) => {
      if (!look.bodies || this.#hasMesh.has(b)) return;
      const [from, to] = [at(bodies.origin, points, b, look.point), at(bodies.end, points, b, look.point)];
      const way = sub(to, from);
      if (Number.isNaN(way[0])) return;
      const along = unit(way);
      const aside = unit(cross(along, Math.abs(along[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
      const r = girth(bodies.massKg[b]!, length(way));
      this.#bodies.put(scaled(aside, r), scaled(way, 0.5), scaled(cross(aside, along), r), scaled(add(from, to), 0.5));
    });
    this.#bodies.end();
  }

  #putSkeleton(look: Look, radius: (x: Vec) => number): void {
    const { skeleton, points } = this.#scene;
    for (const kind of [this.#centres, this.#links, this.#regions]) kind.begin();
    const placed = (joint: number): boolean => skeleton !== null && skeleton.states[joint * points + look.point]! > 0;
    const place = (joint: number): Vec => at(skeleton!.centres, points, joint, look.point);
    for (const [a, b] of skeleton?.links ?? []) {
      if (look.lines && placed(a) && placed(b)) this.#links.rod(place(a), place(b), 0.6 * radius(place(a)));
    }
    skeleton?.names.forEach((_, j) => {
      if (!placed(j)) return;
      const x = place(j);
      const r = 0.75 * radius(x);
      this.#centres.put([r, 0, 0], [0, r, 0], [0, 0, r], x);
      if (look.regions === 0) return;
      const k = (within95 * look.regions) / 1000;
      const [a, b, c] = rootOf(skeleton, points, j, look.point);
      this.#regions.put(scaled(a, k), scaled(b, k), scaled(c, k), x);
    });
    for (const kind of [this.#centres, this.#links, this.#regions]) kind.end();
  }

  #putRays(look: Look, shown: (marker: number) => boolean): void {
    const { cameras, names, points, markers } = this.#scene;
    const ends: number[] = [];
    for (let m = 0; look.rays && cameras.length > 0 && m < names.length; ++m) {
      if (!shown(m) || markers.states[m * points + look.point]! >= firstAbsent) continue;
      for (const camera of cameras) if (!camera.nominal) ends.push(...camera.centre, ...at(markers.x, points, m, look.point));
    }
    set(this.#rays, ends);
  }

  #putPlane(plane: Plane | null, radius: (x: Vec) => number): void {
    this.#axes.begin();
    if (plane === null) {
      set(this.#box, []);
      set(this.#sheet, []);
    } else {
      const corners = cornersOf(plane);
      set(this.#box, boxEdges.flatMap((i) => corners[i]!));
      const sheet = [0, 1, 3, 0, 3, 2].map((i) => add(corners[i]!, plane.axes[2], -plane.low[2]));
      set(this.#sheet, sheet.flat());
      plane.axes.forEach((axis, k) => {
        const reach = Math.max(0.04, plane.high[k as 0]);
        this.#axes.rod(plane.centre, add(plane.centre, axis, reach), 0.3 * radius(plane.centre), this.#axisColours[k]);
      });
    }
    this.#axes.end();
  }
}

/** Half axis across an ellipsoid of this length that holds the mass at 1,000 kg/m^3; not wider than long. */
export const girth = (massKg: number, lengthM: number): number =>
  Math.min(0.6 * lengthM, Math.sqrt(massKg / 1000 / ((4 / 3) * Math.PI * 0.5 * Math.max(1e-3, lengthM))));

/** Columns of the root of a covariance, mm: a sphere of them is an ellipsoid of one standard deviation. */
export function rootOf(skeleton: NonNullable<Scene["skeleton"]>, points: number, joint: number, point: number): [Vec, Vec, Vec] {
  const l = (k: number): number => skeleton.roots[(6 * joint + k) * points + point]!;
  return [[l(0), l(1), l(3)], [0, l(2), l(4)], [0, 0, l(5)]];
}

/** Lines of a camera: the pyramid of its view, and a tick on its upper side. */
export function frustum(camera: CameraPlace): number[] {
  const corner = (i: number, j: number): Vec =>
    add(
      add(add(camera.centre, camera.forward, cameraLength), camera.right, i * cameraLength * camera.halfView[0]),
      camera.down,
      j * cameraLength * camera.halfView[1],
    );
  const [a, b, c, d] = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
  const top = corner(0, -1.35);
  const out: number[] = [];
  for (const [from, to] of [[a, b], [b, c], [c, d], [d, a], [a, top], [top, b]] as [Vec, Vec][]) out.push(...from, ...to);
  for (const x of [a, b, c, d]) out.push(...camera.centre, ...x);
  return out;
}

function set(lines: LineSegments | Mesh, positions: number[]): void {
  lines.visible = positions.length > 0;
  if (lines.visible) lines.geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
}
