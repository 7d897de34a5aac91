// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  ConeGeometry,
  OctahedronGeometry,
  RingGeometry,
  SphereGeometry,
  TetrahedronGeometry,
} from "three";

/** A cross that faces +z: two strokes, arms of length 1. */
function crossShape(): BufferGeometry {
  const positions: number[] = [];
  for (const turn of [Math.PI / 4, (3 * Math.PI) / 4]) {
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    const corner = (x: number, y: number): number[] => [c * x - s * y, s * x + c * y, 0];
    const [a, b, d, e] = [corner(-1.3, -0.3), corner(1.3, -0.3), corner(1.3, 0.3), corner(-1.3, 0.3)] as [number[], number[], number[], number[]];
    positions.push(...a, ...b, ...d, ...a, ...d, ...e);
  }
  const shape = new BufferGeometry();
  shape.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  return shape;
}

/** How a sample of each state looks, in the order of states.ts: another shape besides another colour. */
export const stateShapes: readonly { geometry: () => BufferGeometry; facesEye: boolean }[] = [
  { geometry: () => new SphereGeometry(1, 16, 11), facesEye: false },
  { geometry: () => new TetrahedronGeometry(1.7), facesEye: false },
  { geometry: () => new OctahedronGeometry(1.45), facesEye: false },
  { geometry: () => new BoxGeometry(1.8, 1.8, 1.8), facesEye: false },
  { geometry: () => new RingGeometry(0.85, 1.2, 28), facesEye: true },
  { geometry: crossShape, facesEye: true },
];

/** The same shapes as small pictures for the legend: paths in a box of 20 by 20. */
export const statePaths: readonly { d: string; hollow: boolean }[] = [
  { d: "M10 3.5a6.5 6.5 0 1 0 .01 0z", hollow: false },
  { d: "M10 2.5L17.5 16.5H2.5z", hollow: false },
  { d: "M10 2L17 10L10 18L3 10z", hollow: false },
  { d: "M4 4H16V16H4z", hollow: false },
  { d: "M10 4a6 6 0 1 0 .01 0z", hollow: true },
  { d: "M4 4L16 16M16 4L4 16", hollow: true },
];

/** From the origin along +y, length 1: what an arrow ends in. */
export const arrowHead = (): BufferGeometry => new ConeGeometry(1, 1, 16).translate(0, -0.5, 0);
