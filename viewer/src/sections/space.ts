// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el, section } from "../dom.ts";
import { number, seconds } from "../format.ts";
import { save, fileName } from "../save.ts";
import type { Eyes, PushHand } from "../live/push.ts";
import { fitted, metresPerPixel, poseOf, standardView, zoomed, type Camera, type StandardView } from "../scene/camera.ts";
import { facing } from "../scene/facing.ts";
import { floorHeight } from "../scene/floor.ts";
import { glbOf } from "../scene/glb.ts";
import { planeOf, type Plane } from "../scene/plane.ts";
import { bounds, pointAt, type Scene } from "../scene/scene.ts";
import { at, isEverThere, isThere } from "../scene/track.ts";
import type { Look } from "../scene/look.ts";
import { SpaceView } from "../scene/space_view.ts";
import { sticks } from "../scene/sticks.ts";
import { boundsAt, goesFar, middleAt } from "../scene/journey.ts";
import { add, dot, scaled, sub, type Vec } from "../scene/vec.ts";
import { firstAbsent, stateWords } from "../states.ts";
import { onThemeChange } from "../theme.ts";
import type { View } from "../view.ts";
import { SpaceLabels, type Labelled } from "./space_labels.ts";
import { choice, shapesLegend, spaceFacts, thinnedNote, toggle } from "./space_parts.ts";
import { SpacePlayer } from "./space_player.ts";
import { listenToPointer, pressed } from "./space_pointer.ts";

export interface SpaceOptions {
  /** For the file of a saved picture. */
  trial: string;
  /** Frames that play in a second where the file tells no rate. */
  playHz?: number;
  /** What else is drawn: words for the legend and the switch; null: nothing. */
  others: { legend: string; switch: string } | null;
  /** A sentence above the picture. */
  lead?: string;
  /** Where to look from, kept while what is drawn is drawn anew. */
  kept?: { camera: Camera | null };
  /** The last point is now, and the points before it change: nothing to play, nothing to save but the picture. Tells which markers were seen so far. */
  live?: { seen: readonly boolean[]; point?: () => number; push?: SpacePush };
}

/** What pushes a body of the scene. */
export interface SpacePush {
  /** A drag that begins on a body pushes it. */
  isOn: () => boolean;
  hand: Pick<PushHand, "grab" | "drag" | "drop">;
  /** Told once how the picture shows the world. */
  seenBy: (directions: () => { right: Vec; up: Vec }) => void;
  /** Below the picture. */
  node: HTMLElement;
}

const pickReach = 14;

/** The recording in space, on the instant that all plots share. */
export function space(scene: Scene, view: View, options: SpaceOptions): { node: HTMLElement; start: () => void; stop: () => void } {
  const M = scene.names.length;
  const isLive = options.live !== undefined;
  const everThere = options.live?.seen ?? scene.names.map((_, m) => isEverThere(scene.markers, scene.points, m));
  const lines = sticks(scene);
  const ahead = facing(scene);
  const canvas = el("canvas", { class: "space-canvas", tabindex: 0, role: "img", "aria-label": "Markers in space. Drag to turn, shift and drag to move, wheel to come nearer." });
  const labels = new SpaceLabels();
  const frame = el("div", { class: "space-frame" }, canvas, labels.node);
  const readout = el("p", { class: "readout", id: "space-readout" });
  const travels = goesFar(scene);
  let camera: Camera;
  let point = 0;
  let trails: Labelled = "picked";
  let labelled: Labelled = M <= 16 && scene.skeleton === null ? "all" : "picked";
  let follow = travels;
  let followed: Vec | null = null;
  let showFurther = !scene.isMain.includes(true);
  let plane: Plane | null = null;
  let hover = -1;
  let picture: SpaceView | null = null;
  let pending = false;
  /** What people switch on and off. */
  const shown = { lines: true, goals: true, others: options.others !== null, regions: 1, rays: true, bodies: true, cut: 0 };
  const change = <K extends keyof typeof shown>(what: K) => (to: (typeof shown)[K]): void => {
    shown[what] = to;
    redraw();
  };
  camera = firstCamera();
  const player = new SpacePlayer(scene, {
    playHz: options.playHz ?? scene.rateHz,
    canvas,
    point: () => point,
    goTo,
    filming: (on) => {
      if (picture !== null) picture.keepsSize = on;
      draw();
    },
    filmed: (blob) => save(fileName(options.trial, "webm"), blob),
  });

  function firstCamera(): Camera {
    const bare: Camera = { target: [0, 0, 0], up: scene.up, azimuth: 0, elevation: 0, distance: 3, perspective: true };
    return framed(standardView(bare, "corner", ahead));
  }

  /** The same direction, with all that moves in the picture. */
  function framed(towards: Camera): Camera {
    const [low, high] = travels ? boundsAt(scene, point) : bounds(scene);
    const middle = scaled(add(low, high), 0.5);
    const height = floorHeight(scene);
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i): Vec => [(i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]]);
    const onFloor = corners.map((x) => add(x, scene.up, height - dot(x, scene.up)));
    const near = dot(middle, scene.up) - height < 2 ? onFloor : [];
    return fitted({ ...towards, target: middle }, [...corners, ...near], Math.max(1, frame.clientWidth || 1080), Math.max(1, frame.clientHeight || 560));
  }

  const hidden = (m: number): boolean => !everThere[m] || (!showFurther && !scene.isMain[m] && m !== view.marker);
  const isMarker = (m: number): boolean => m >= 0 && m < M;

  function look(): Look {
    const perSecond = scene.rateHz / scene.frameStep;
    const trailOf = trails === "all" ? scene.names.map((_, m) => m).filter((m) => !hidden(m)) : trails === "picked" && isMarker(view.marker) ? [view.marker] : [];
    const before = Math.max(2, Math.round((trails === "all" ? 0.5 : 1.5) * perSecond));
    return { ...shown, camera, point, picked: view.marker, trailOf, trail: [before, trails === "picked" ? before : 0], hidden, plane };
  }

  function redraw(): void {
    if (pending || picture === null) return;
    pending = true;
    requestAnimationFrame(() => {
      pending = false;
      draw();
    });
  }

  /** What people chose to look at stays where it is in the picture. */
  function followOn(): void {
    if (!follow) {
      followed = null;
      return;
    }
    const one = isMarker(view.marker) && isThere(scene.markers, scene.points, view.marker, point) && !travels;
    const place = one ? at(scene.markers.x, scene.points, view.marker, point) : middleAt(scene, point);
    if (place === null) return;
    if (followed !== null) camera = { ...camera, target: add(camera.target, sub(place, followed)) };
    else if (one) camera = { ...camera, target: place };
    followed = place;
  }

  function draw(): void {
    if (picture === null) return;
    followOn();
    picture.draw(look());
    frame.dataset["camera"] = JSON.stringify(camera);
    frame.dataset["point"] = String(point);
    frame.dataset["calls"] = String(picture.calls);
    labels.put(picture, { camera, point, labelled, picked: view.marker, hover, hidden });
  }

  function tell(): void {
    player.tell();
    const m = view.marker;
    if (!isMarker(m)) {
      readout.textContent = "Click a marker to see its path and its curve.";
      return;
    }
    const state = scene.markers.states[m * scene.points + point]!;
    const x = at(scene.markers.x, scene.points, m, point);
    const where = state >= firstAbsent ? "no value" : `x ${number(1e3 * x[0], 1)}, y ${number(1e3 * x[1], 1)}, z ${number(1e3 * x[2], 1)} mm`;
    readout.replaceChildren(el("b", {}, scene.names[m]!), `, ${stateWords[state as 0]}: ${where}`);
  }

  function goTo(next: number): void {
    const time = scene.time[Math.min(scene.points - 1, Math.max(0, next))];
    if (time !== undefined) view.set({ focus: time, pointer: null });
  }

  function nearestMarker(x: number, y: number): number {
    let best = -1;
    let least = pickReach;
    for (let m = 0; m < M && picture !== null; ++m) {
      if (hidden(m)) continue;
      const [left, top, depth] = picture.place(camera, at(scene.markers.x, scene.points, m, point));
      const off = Math.hypot(left - x, top - y) + (scene.markers.states[m * scene.points + point]! >= firstAbsent ? 3 : 0);
      if (off < least && (depth > 0 || !camera.perspective)) {
        least = off;
        best = m;
      }
    }
    return best;
  }

  function moveCamera(to: Camera): void {
    camera = to;
    redraw();
  }

  function seeFrom(wanted: StandardView): void {
    moveCamera(follow ? standardView(camera, wanted, ahead) : framed(standardView(camera, wanted, ahead)));
  }

  const eyes: Eyes = {
    place: (x) => picture!.place(camera, x),
    pixel: (x) => {
      const pose = poseOf(camera);
      const k = metresPerPixel(camera, dot(sub(x, pose.eye), pose.forward), canvas.clientHeight);
      return { right: scaled(pose.right, k), up: scaled(pose.up, k) };
    },
  };

  function listen(): void {
    const push = options.live?.push;
    listenToPointer(canvas, {
      ...(push === undefined ? {} : { hold: { grab: (x, y) => push.isOn() && push.hand.grab(x, y, eyes), drag: (x, y) => push.hand.drag(x, y, eyes), drop: () => push.hand.drop() } }),
      camera: () => camera,
      moveCamera,
      nearest: nearestMarker,
      hover: (marker) => {
        hover = marker;
        redraw();
      },
      pick: (marker) => view.set({ marker }),
    });
    canvas.addEventListener("keydown", (e) => {
      const isKnown = pressed(e.key, e.shiftKey, {
        seeFrom,
        nearer: (factor) => moveCamera(zoomed(camera, factor)),
        startOver: () => moveCamera(firstCamera()),
        time: isLive ? null : { toggle: () => player.set(!player.playing), step: (by) => goTo(point + by), toEnd: (last) => goTo(last ? scene.points - 1 : 0) },
      });
      if (isKnown) e.preventDefault();
    });
  }

  function start(): void {
    try {
      picture = new SpaceView(canvas, scene, lines);
    } catch {
      player.filmButton?.remove();
      frame.replaceChildren(
        el("p", { class: "broken" }, "The space view needs WebGL2, which this browser does not offer or has switched off; curves, gaps and tables below do not need it."),
      );
      return;
    }
    const fit = (): void => {
      if (frame.clientWidth === 0) return;
      picture?.resize(frame.clientWidth, frame.clientHeight);
      draw();
    };
    new ResizeObserver(fit).observe(frame);
    // Paper does not wait for a smooth picture.
    onThemeChange(() => picture?.drawSmooth(look()));
    listen();
    let [planeOfMarker, planeRange] = [view.marker, view.range];
    view.onChange(() => {
      if (planeButton.getAttribute("aria-pressed") === "true" && (planeOfMarker !== view.marker || planeRange !== view.range)) fitPlane(true);
      [planeOfMarker, planeRange] = [view.marker, view.range];
      const time = (player.playing ? null : view.pointer) ?? view.focus;
      if (isLive) point = options.live?.point?.() ?? scene.points - 1;
      else if (time !== null) point = pointAt(scene, time);
      tell();
      redraw();
    });
    camera = options.kept?.camera ?? firstCamera();
    fit();
    tell();
  }

  function stop(): void {
    player.set(false);
    if (options.kept !== undefined) options.kept.camera = camera;
    picture?.dispose();
    picture = null;
  }

  async function savePicture(): Promise<void> {
    picture?.drawSmooth(look());
    const blob = await labels.pictureWithNames(canvas);
    if (blob !== null) save(fileName(`${options.trial}_${(scene.time[point] ?? 0).toFixed(3)}s`, "png"), blob);
  }

  function saveGlb(): void {
    const bytes = glbOf(scene, lines, options.trial);
    save(fileName(options.trial, "glb"), new Blob([bytes as BlobPart], { type: "model/gltf-binary" }));
  }

  /** The plane of the chosen marker's path over the time that the plots show. */
  function fitPlane(on: boolean): void {
    plane = null;
    if (on && isMarker(view.marker)) plane = planeOf(scene, view.marker, pointAt(scene, view.range[0]), pointAt(scene, view.range[1]));
    planeFacts.hidden = !on;
    if (plane === null) planeFacts.textContent = on ? "Click a marker first: the plane is that of its path over the time shown." : "";
    else {
      const size = plane.axes.map((_, k) => number(1e3 * (plane!.high[k as 0] - plane!.low[k as 0]), 1)).join(" × ");
      planeFacts.replaceChildren(el("b", {}, scene.names[view.marker]!), `: plane of ${number(plane.samples)} samples from ${seconds(view.range[0])} to ${seconds(view.range[1])}; ${number(1e3 * plane.rms, 2)} mm RMS off it, box ${size} mm along its axes, normal (${plane.axes[2].map((v) => number(v, 3)).join(", ")}).`);
    }
    redraw();
  }
  const planeFacts = el("p", { class: "facts", id: "plane-facts", hidden: true });
  const planeButton = toggle("Plane", false, (on) => fitPlane(on));
  const cutSlider = el("input", { type: "range", min: 0, max: 100, step: 1, value: 0, "aria-label": "Cut away what is nearest, per cent", input: () => change("cut")(Number(cutSlider.value) / 100) });

  const viewButton = (words: string, wanted: StandardView, key: string): HTMLElement =>
    el("button", { type: "button", title: `${words} (${key})`, click: () => seeFrom(wanted) }, words);
  const further = scene.names.filter((_, m) => everThere[m] && !scene.isMain[m]).length;
  const seen = new Set(scene.names.flatMap((_, m) => (hidden(m) ? [] : [...new Set(scene.markers.states.subarray(m * scene.points, (m + 1) * scene.points))])));
  const some: readonly (readonly [Labelled, string])[] = [["none", "none"], ["picked", "picked"], ["all", "all"]];
  const node = section(
    "space",
    "Space",
    options.lead ?? "",
    isLive ? null : thinnedNote(scene),
    el(
      "div",
      { class: "controls" },
      viewButton("Front", "front", "1"),
      viewButton("Side", "side", "2"),
      viewButton("Top", "top", "3"),
      viewButton("Corner", "corner", "4"),
      toggle("Perspective", true, (on) => moveCamera({ ...camera, perspective: on })),
      toggle("Follow", follow, (on) => { follow = on; followed = null; redraw(); }),
      lines.length === 0 ? null : toggle("Lines", true, change("lines")),
      options.others === null ? null : toggle(options.others.switch, true, change("others")),
      further === 0 || showFurther ? null : toggle(`${number(further)} further`, false, (on) => { showFurther = on; redraw(); }),
      choice("Names", some, labelled, (v) => { labelled = v; redraw(); }),
      choice("Paths", some, trails, (v) => { trails = v; redraw(); }),
      scene.skeleton === null ? null : choice("95 % regions", [["0", "none"], ["1", "true size"], ["3", "3 ×"], ["10", "10 ×"]], "1", (v) => change("regions")(Number(v))),
      scene.bodies === null ? null : toggle("Bodies", true, change("bodies")),
      scene.goals === undefined ? null : toggle("Goals", true, change("goals")),
      scene.cameras.length === 0 ? null : toggle("Rays", true, change("rays")),
      isLive ? null : planeButton,
      el("label", { class: "pick" }, el("span", {}, "Cut"), cutSlider),
      el("button", { type: "button", click: () => void savePicture() }, "Save picture"),
      isLive ? null : el("button", { type: "button", title: "Save the animation for Blender and others", click: () => saveGlb() }, "Save GLB"),
      isLive ? null : player.filmButton,
    ),
    frame,
    options.live?.push?.node ?? null,
    isLive ? null : player.node,
    readout,
    planeFacts,
    shapesLegend(seen, options.others?.legend ?? null),
    el("p", { class: "facts" }, `${spaceFacts(scene, further, lines.length > 0)}. Click into the picture: ${isLive ? "" : "space plays, arrows step, "}1 to 4 are views, + and − come nearer, 0 starts over.`),
  );
  options.live?.push?.seenBy(() => poseOf(camera));
  return { node, start, stop };
}
