// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import type { Clock, PackedBodies, PackedJoints, PackedMarkers, PackedScene } from "../page_types.ts";
import { unpackMeshes, type BodyMesh } from "./meshes.ts";
import { isEverThere, isThere, type Track } from "./track.ts";
import { inflated, unpack } from "./unpack.ts";
import { upright } from "./upright.ts";
import type { Vec } from "./vec.ts";

export interface Force {
  name: string;
  /** 3 x P, N */
  force: Float32Array;
  /** 3 x P, m */
  point: Float32Array;
}

/** Joint centres on the points of the scene. */
export interface Joints {
  names: readonly string[];
  /** Pairs of joints of one segment. */
  links: readonly (readonly [number, number])[];
  /** J x 3 x P, m */
  centres: Float32Array;
  /** J x 6 x P, mm: lower triangular roots of the covariances, row by row. */
  roots: Float32Array;
  /** J x P: 0 not placed, 1 ambiguous, 2 bridged, 3 determined. */
  states: Uint8Array;
}

/** Bodies of a model, each a mesh, or about the line from its origin to its end. */
export interface Bodies {
  names: readonly string[];
  massKg: readonly number[];
  /** B x 3 x P, m */
  origin: Float32Array;
  end: Float32Array;
  meshes: readonly BodyMesh[];
  /** Which meshes are drawn and which are not; empty: nothing to say. */
  meshesNote: string;
}

export interface CameraPlace {
  name: string;
  centre: Vec;
  right: Vec;
  down: Vec;
  forward: Vec;
  /** Slopes of the edges of the view. */
  halfView: [number, number];
  /** Where it was meant to stand. */
  nominal: boolean;
}

/** Goals of a model that follows a source, of this instant. */
export interface Goals {
  /** T x 3, m; NaN where there is none. */
  x: Float32Array;
  /** T x 3, m: the markers of the model that follow them. */
  model: Float32Array;
  /** T: from 0. */
  level: readonly number[];
  /** A force at the model: from where it acts, as long as it is strong; null: none. */
  push: readonly [from: Vec, to: Vec] | null;
}

/** What there is to draw in space, on the points of its own clock. */
export interface Scene {
  points: number;
  frameStep: number;
  /** Number of the first point's frame, as the recording's file counts. */
  firstFrame: number;
  rateHz: number;
  /** P, s */
  time: Float64Array;
  names: readonly string[];
  /** M: what the picture is about: named, there at least once, not computed from the other markers. */
  isMain: readonly boolean[];
  up: Vec;
  upFrom: string;
  markers: Track;
  before: Track | null;
  /** M x 3 x P, m: where a model has the markers. */
  model: Float32Array | null;
  /** M x P: the worst state of the frames that a point stands for. */
  worst: Uint8Array;
  plates: Vec[][];
  forces: Force[];
  bodies: Bodies | null;
  skeleton: Joints | null;
  cameras: CameraPlace[];
  /** Smallest and largest coordinates where they are known beforehand, m. */
  extent?: [low: Vec, high: Vec];
  goals?: Goals;
  /** Its samples change while it is shown. */
  changes?: boolean;
}

async function unpackTrack(packed: PackedMarkers, markers: number, points: number): Promise<Track> {
  const [x, states] = await Promise.all([unpack(packed.positions_m), inflated(packed.states)]);
  if (x.length !== 3 * markers * points || states.length !== markers * points) {
    throw new Error(`the space view needs ${markers} markers on ${points} points`);
  }
  return { x, states };
}

async function unpackJoints(packed: PackedJoints, points: number): Promise<Joints> {
  const [centres, roots, states] = await Promise.all([unpack(packed.centres_m), unpack(packed.roots_mm), inflated(packed.states)]);
  const J = packed.names.length;
  if (centres.length !== 3 * J * points || roots.length !== 6 * J * points || states.length !== J * points) {
    throw new Error(`the space view needs ${J} joints on ${points} points`);
  }
  return { names: packed.names, links: packed.links, centres, roots, states };
}

async function unpackBodies(packed: PackedBodies, points: number): Promise<Bodies> {
  const [origin, end, meshes] = await Promise.all([unpack(packed.origin_m), unpack(packed.end_m), packed.meshes ? unpackMeshes(packed.meshes, points) : []]);
  return { names: packed.names, massKg: packed.mass_kg.map((m) => m ?? 0), origin, end, meshes, meshesNote: packed.meshes_note ?? "" };
}

/** Segments whose axes Plug-in Gait writes among the markers, four points each. */
const computedSegments = /^(PEL|HED|THX|TRX|[LR](FE|TI|FO|TO|CL|HU|RA|HN))([OALP])$/;

/** Points that Plug-in Gait computed: where a segment has all four of them. */
export function areComputed(names: readonly string[]): boolean[] {
  const parts = names.map((n) => /^(.*:)?([^:]*)$/.exec(n)!);
  const segment = parts.map(([, subject = "", own = ""]) => {
    const found = computedSegments.exec(own);
    return found === null ? "" : subject + found[1]!;
  });
  const count = new Map<string, number>();
  for (const s of segment) count.set(s, (count.get(s) ?? 0) + 1);
  return segment.map((s) => s !== "" && count.get(s) === 4);
}

export async function unpackScene(packed: PackedScene, clock: Clock, isNamed: (marker: number) => boolean = () => true): Promise<Scene> {
  const { points, frame_step } = packed;
  const M = packed.names.length;
  const [markers, before, model, worst, forces, skeleton, bodies] = await Promise.all([
    unpackTrack(packed.markers, M, points),
    packed.before === null ? null : unpackTrack(packed.before, M, points),
    packed.model_m === null ? null : unpack(packed.model_m),
    packed.worst === null ? null : inflated(packed.worst),
    Promise.all(
      packed.forces.map(async (f) => ({ name: f.name, force: await unpack(f.force_n), point: await unpack(f.point_m) })),
    ),
    packed.skeleton ? unpackJoints(packed.skeleton, points) : null,
    packed.bodies ? unpackBodies(packed.bodies, points) : null,
  ]);
  const computed = areComputed(packed.names);
  const found = packed.up === null ? upright(markers, M, points) : null;
  return {
    points,
    frameStep: frame_step,
    firstFrame: clock.first_frame,
    rateHz: clock.rate_hz,
    time: Float64Array.from({ length: points }, (_, i) => clock.first_time_s + (i * frame_step) / clock.rate_hz),
    names: packed.names,
    isMain: packed.names.map((_, m) => isNamed(m) && !computed[m] && isEverThere(markers, points, m)),
    up: packed.up ?? found ?? [0, 0, 1],
    upFrom: packed.up_from !== "" || found === null ? packed.up_from : "the shape of what the markers outline",
    markers,
    before,
    model,
    worst: worst ?? markers.states,
    plates: packed.plates
      .map((p) => p.corners_m.filter((c): c is [number, number, number] => c.length === 3 && c.every((v) => v !== null)))
      .filter((corners) => corners.length === 4),
    forces,
    bodies,
    skeleton,
    cameras: (packed.cameras ?? []).map((c) => ({ name: c.name, centre: c.centre_m, right: c.right, down: c.down, forward: c.forward, halfView: c.half_view, nominal: c.nominal })),
  };
}

/** Point nearest to a time; 0 without any. */
export function pointAt(scene: Pick<Scene, "points" | "frameStep" | "rateHz" | "time">, time: number): number {
  const first = scene.time[0] ?? 0;
  const point = Math.round(((time - first) * scene.rateHz) / scene.frameStep);
  return Math.min(Math.max(0, scene.points - 1), Math.max(0, point));
}

const known = new WeakMap<Scene, Map<number, [low: Vec, high: Vec]>>();

/** Smallest and largest coordinates of what is there; about `share` of the samples on each side are left out. Reckoned once, where samples do not change. */
export function bounds(scene: Scene, share = 0.005): [low: Vec, high: Vec] {
  if (scene.extent !== undefined) return scene.extent;
  if (scene.changes === true) return reckonBounds(scene, share);
  const shares = known.get(scene) ?? new Map<number, [Vec, Vec]>();
  known.set(scene, shares);
  const found = shares.get(share) ?? reckonBounds(scene, share);
  shares.set(share, found);
  return found;
}

function reckonBounds(scene: Scene, share: number): [low: Vec, high: Vec] {
  const { points, markers, names } = scene;
  const stride = Math.max(1, Math.floor((points * names.length) / 20_000));
  const low: Vec = [0, 0, 0];
  const high: Vec = [0, 0, 0];
  const all = !scene.isMain.includes(true);
  const values = new Float32Array(names.length * Math.ceil(points / stride));
  for (const axis of [0, 1, 2] as const) {
    let count = 0;
    for (let m = 0; m < names.length; ++m) {
      if (!all && !scene.isMain[m]) continue;
      for (let p = 0; p < points; p += stride) {
        if (isThere(markers, points, m, p)) values[count++] = markers.x[(3 * m + axis) * points + p]!;
      }
    }
    const there = values.subarray(0, count).sort();
    const cut = Math.floor(share * count);
    const lenses = scene.cameras.map((c) => c.centre[axis]);
    const ends = [...(count > 0 ? [there[cut]!, there[count - 1 - cut]!] : []), ...lenses];
    low[axis] = ends.length > 0 ? Math.min(...ends) : -0.5;
    high[axis] = ends.length > 0 ? Math.max(...ends) : 0.5;
  }
  return [low, high];
}
