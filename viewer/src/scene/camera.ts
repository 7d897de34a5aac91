// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { add, cross, dot, floorAxes, scaled, sub, type Vec } from "./vec.ts";

/** Where people look from. Angles in rad, lengths in m, in the laboratory's frame. */
export interface Camera {
  target: Vec;
  up: Vec;
  /** About `up`, from the first floor axis towards the second. */
  azimuth: number;
  /** Above the floor, -pi/2 to pi/2. */
  elevation: number;
  distance: number;
  perspective: boolean;
}

/** Vertical angle of view, rad. In an orthographic view what is as far as the target is as large. */
export const fieldOfView = (35 * Math.PI) / 180;

export interface Pose {
  eye: Vec;
  right: Vec;
  up: Vec;
  /** From the eye into the picture. */
  forward: Vec;
}

export function poseOf(camera: Camera): Pose {
  const [first, second] = floorAxes(camera.up);
  const { azimuth: a, elevation: e } = camera;
  const around = add(scaled(first, Math.cos(a)), second, Math.sin(a));
  const outward = add(scaled(around, Math.cos(e)), camera.up, Math.sin(e));
  const up = add(scaled(camera.up, Math.cos(e)), around, -Math.sin(e));
  const forward = scaled(outward, -1);
  return { eye: add(camera.target, outward, camera.distance), right: cross(forward, up), up, forward };
}

/** Metres to a pixel at a depth, in a picture of `height` pixels. */
export function metresPerPixel(camera: Camera, depth: number, height: number): number {
  const reach = camera.perspective ? Math.max(depth, 1e-3) : camera.distance;
  return (2 * reach * Math.tan(fieldOfView / 2)) / height;
}

/** Pixels from the top left corner, and the depth in m; behind the eye the depth is negative. */
export function project(camera: Camera, pose: Pose, width: number, height: number, x: Vec): [x: number, y: number, depth: number] {
  const seen = sub(x, pose.eye);
  const depth = dot(seen, pose.forward);
  const scale = 1 / metresPerPixel(camera, depth, height);
  return [width / 2 + scale * dot(seen, pose.right), height / 2 - scale * dot(seen, pose.up), depth];
}

export function orbited(camera: Camera, azimuth: number, elevation: number): Camera {
  const most = Math.PI / 2;
  return {
    ...camera,
    azimuth: camera.azimuth + azimuth,
    elevation: Math.min(most, Math.max(-most, camera.elevation + elevation)),
  };
}

/** Move by so many pixels; what is as far as the target follows the pointer. */
export function panned(camera: Camera, dx: number, dy: number, height: number): Camera {
  const pose = poseOf(camera);
  const k = metresPerPixel(camera, camera.distance, height);
  return { ...camera, target: add(add(camera.target, pose.right, -k * dx), pose.up, k * dy) };
}

/** Come nearer (below 1) or go away. */
export const zoomed = (camera: Camera, factor: number): Camera => ({
  ...camera,
  distance: Math.min(200, Math.max(0.05, factor * camera.distance)),
});

export type StandardView = "front" | "side" | "top" | "corner";

/** A standard view of somebody who faces the azimuth `facing`. */
export function standardView(camera: Camera, view: StandardView, facing: number): Camera {
  const [azimuth, elevation] = {
    front: [facing, 0],
    side: [facing - Math.PI / 2, 0],
    top: [facing + Math.PI, Math.PI / 2],
    corner: [facing - 0.9, 0.3],
  }[view] as [number, number];
  return { ...camera, azimuth, elevation };
}

/** Come near and move until all of these places fill the picture, `margin` of it left free on each side. */
export function fitted(camera: Camera, places: readonly Vec[], width: number, height: number, margin = 0.06): Camera {
  if (places.length === 0) return camera;
  let now = camera;
  for (let i = 0; i < 12; ++i) {
    const pose = poseOf(now);
    const seen = places.map((x) => project(now, pose, width, height, x));
    if (seen.some(([, , depth]) => now.perspective && depth < 0.05 * now.distance)) {
      now = zoomed(now, 1.5);
      continue;
    }
    const [left, right] = [Math.min(...seen.map((s) => s[0])), Math.max(...seen.map((s) => s[0]))];
    const [top, bottom] = [Math.min(...seen.map((s) => s[1])), Math.max(...seen.map((s) => s[1]))];
    now = panned(now, width / 2 - (left + right) / 2, height / 2 - (top + bottom) / 2, height);
    const share = Math.max((right - left) / width, (bottom - top) / height) / (1 - 2 * margin);
    now = zoomed(now, Math.max(0.5, Math.min(2, share)));
  }
  return now;
}
