// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Names over the picture of the space view: as text, not as pixels.
import { el } from "../dom.ts";
import type { Camera } from "../scene/camera.ts";
import type { Scene } from "../scene/scene.ts";
import { at } from "../scene/track.ts";
import type { SpaceView } from "../scene/space_view.ts";
import { add, type Vec } from "../scene/vec.ts";
import { palette } from "../theme.ts";

export type Labelled = "none" | "picked" | "all";

export interface LabelLook {
  camera: Camera;
  point: number;
  labelled: Labelled;
  picked: number;
  hover: number;
  hidden: (marker: number) => boolean;
}

type Wanted = readonly [words: string, x: Vec, kind: string];

/** Names of markers, joints and cameras, and x, y, z at the ends of the axes of the laboratory. */
export function labelsOf(scene: Scene, origin: Vec, look: LabelLook): Wanted[] {
  const { labelled, picked, hover, point, hidden } = look;
  const wanted: Wanted[] = [];
  scene.names.forEach((name, m) => {
    if (hidden(m)) return;
    const asked = labelled === "all" || (labelled === "picked" && m === picked) || m === hover;
    if (asked) wanted.push([name, at(scene.markers.x, scene.points, m, point), m === picked ? "tag picked" : "tag"]);
  });
  scene.skeleton?.names.forEach((name, j) => {
    if (labelled !== "none" && scene.skeleton!.states[j * scene.points + point]! > 0) wanted.push([name, at(scene.skeleton!.centres, scene.points, j, point), "tag joint"]);
  });
  for (const lens of scene.cameras) if (!lens.nominal) wanted.push([lens.name, lens.centre, "tag picked"]);
  (["x", "y", "z"] as const).forEach((name, k) => {
    wanted.push([name, add(origin, [k === 0 ? 0.31 : 0, k === 1 ? 0.31 : 0, k === 2 ? 0.31 : 0]), `axis axis-${name}`]);
  });
  return wanted;
}

/** Elements beside what they name, kept from picture to picture. */
export class SpaceLabels {
  readonly node = el("div", { class: "space-labels", "aria-hidden": "true" });
  readonly #tags: HTMLElement[] = [];

  put(drawn: SpaceView, look: LabelLook): void {
    const wanted = labelsOf(drawn.scene, drawn.floor.origin, look);
    while (this.#tags.length < wanted.length) {
      const tag = el("span");
      this.#tags.push(tag);
      this.node.append(tag);
    }
    this.#tags.forEach((tag, i) => {
      const want = wanted[i];
      tag.hidden = want === undefined;
      if (want === undefined) return;
      const [left, top, depth] = drawn.place(look.camera, want[1]);
      tag.className = want[2];
      if (tag.textContent !== want[0]) tag.textContent = want[0];
      tag.hidden = look.camera.perspective && depth <= 0;
      tag.style.transform = `translate(${left.toFixed(2)}px, ${top.toFixed(2)}px)`;
    });
  }

  /** The picture with its names in it, as PNG; null where the browser cannot. */
  async pictureWithNames(canvas: HTMLCanvasElement): Promise<Blob | null> {
    const ratio = canvas.width / Math.max(1, canvas.clientWidth);
    const copy = el("canvas", { width: canvas.width, height: canvas.height });
    const pen = copy.getContext("2d")!;
    pen.drawImage(canvas, 0, 0);
    pen.scale(ratio, ratio);
    pen.font = "12px system-ui, sans-serif";
    pen.textBaseline = "middle";
    for (const tag of this.#tags) {
      if (tag.hidden) continue;
      const [left, top] = /translate\(([-\d.]+)px, ([-\d.]+)px\)/.exec(tag.style.transform)!.slice(1).map(Number) as [number, number];
      pen.fillStyle = palette().ink;
      pen.fillText(tag.textContent ?? "", left + 8, top - 8);
    }
    return new Promise((done) => copy.toBlob(done, "image/png"));
  }
}
