// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Mouse, pen, fingers and keys on the picture of the space view.
import { orbited, panned, zoomed, type Camera, type StandardView } from "../scene/camera.ts";

export interface SpaceHands {
  camera: () => Camera;
  moveCamera: (to: Camera) => void;
  /** Marker at a place of the picture; -1: none. */
  nearest: (x: number, y: number) => number;
  hover: (marker: number) => void;
  pick: (marker: number) => void;
  /** A drag that holds something and does not turn the picture; null: there is none. */
  hold?: { grab: (x: number, y: number) => boolean; drag: (x: number, y: number) => void; drop: () => void };
}

/** Turn, move and come nearer with mouse, pen or fingers; a click picks. */
export function listenToPointer(canvas: HTMLCanvasElement, hands: SpaceHands): void {
  const down = new Map<number, [number, number]>();
  let moved = 0;
  let hovered = -1;
  let holding: number | null = null;
  canvas.addEventListener("pointerdown", (e) => {
    if (holding === null && down.size === 0 && e.button === 0 && !e.shiftKey && hands.hold?.grab(e.offsetX, e.offsetY) === true) {
      holding = e.pointerId;
      canvas.setPointerCapture(e.pointerId);
      return;
    }
    down.set(e.pointerId, [e.offsetX, e.offsetY]);
    canvas.setPointerCapture(e.pointerId);
    moved = 0;
  });
  canvas.addEventListener("pointermove", (e) => {
    if (e.pointerId === holding) return hands.hold?.drag(e.offsetX, e.offsetY);
    const before = down.get(e.pointerId);
    if (before === undefined) {
      const near = hands.nearest(e.offsetX, e.offsetY);
      if (near === hovered) return;
      hovered = near;
      canvas.style.cursor = near < 0 ? "grab" : "pointer";
      hands.hover(near);
      return;
    }
    const [dx, dy] = [e.offsetX - before[0], e.offsetY - before[1]];
    moved += Math.abs(dx) + Math.abs(dy);
    const other = [...down.entries()].find(([id]) => id !== e.pointerId)?.[1];
    down.set(e.pointerId, [e.offsetX, e.offsetY]);
    const camera = hands.camera();
    if (other !== undefined) {
      const [was, is] = [Math.hypot(before[0] - other[0], before[1] - other[1]), Math.hypot(e.offsetX - other[0], e.offsetY - other[1])];
      hands.moveCamera(panned(zoomed(camera, was / Math.max(1, is)), dx / 2, dy / 2, canvas.clientHeight));
    } else if (e.shiftKey || (e.buttons & 6) !== 0) hands.moveCamera(panned(camera, dx, dy, canvas.clientHeight));
    else if (moved > 3) hands.moveCamera(orbited(camera, -0.008 * dx, 0.008 * dy));
  });
  const up = (e: PointerEvent): void => {
    if (e.pointerId === holding) {
      holding = null;
      hands.hold?.drop();
      return;
    }
    if (!down.delete(e.pointerId) || moved > 4 || e.type === "pointercancel") return;
    hands.pick(hands.nearest(e.offsetX, e.offsetY));
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  canvas.addEventListener("wheel", (e) => {
    // The page scrolls until somebody has clicked into the picture.
    if (document.activeElement !== canvas && !e.ctrlKey) return;
    e.preventDefault();
    hands.moveCamera(zoomed(hands.camera(), Math.exp(0.0012 * e.deltaY)));
  }, { passive: false });
}

const views: Readonly<Record<string, StandardView>> = { "1": "front", "2": "side", "3": "top", "4": "corner" };

export interface SpaceKeys {
  seeFrom: (view: StandardView) => void;
  nearer: (factor: number) => void;
  startOver: () => void;
  /** null: nothing plays here. */
  time: { toggle: () => void; step: (points: number) => void; toEnd: (last: boolean) => void } | null;
}

/** Do what a key means; false where it means nothing. */
export function pressed(key: string, shift: boolean, keys: SpaceKeys): boolean {
  const view = views[key];
  if (view !== undefined) keys.seeFrom(view);
  else if (key === "+" || key === "-") keys.nearer(key === "+" ? 0.87 : 1.15);
  else if (key === "0") keys.startOver();
  else if (keys.time === null) return false;
  else if (key === " ") keys.time.toggle();
  else if (key === "ArrowLeft" || key === "ArrowRight") keys.time.step((key === "ArrowLeft" ? -1 : 1) * (shift ? 10 : 1));
  else if (key === "Home" || key === "End") keys.time.toEnd(key === "End");
  else return false;
  return true;
}
