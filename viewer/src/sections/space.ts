// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { el, section } from "../dom.ts";
import { number, seconds } from "../format.ts";
import { save, fileName } from "../save.ts";
import { fitted, orbited, panned, standardView, zoomed, type Camera, type StandardView } from "../scene/camera.ts";
import { facing } from "../scene/facing.ts";
import { canFilm, film } from "../scene/film.ts";
import { floorHeight } from "../scene/floor.ts";
import { glbOf } from "../scene/glb.ts";
import { planeOf, type Plane } from "../scene/plane.ts";
import { at, bounds, isEverThere, isThere, pointAt, type Scene } from "../scene/scene.ts";
import { statePaths } from "../scene/shapes.ts";
import { SpaceView, type Look } from "../scene/space_view.ts";
import { areConventional, sticks } from "../scene/sticks.ts";
import { boundsAt, goesFar, middleAt } from "../scene/journey.ts";
import { add, dot, scaled, sub, type Vec } from "../scene/vec.ts";
import { firstAbsent, stateWords } from "../states.ts";
import { svg } from "../svg.ts";
import { onThemeChange, palette } from "../theme.ts";
import type { View } from "../view.ts";

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
  live?: { seen: readonly boolean[] };
}

const speeds = [0.1, 0.25, 0.5, 1, 2, 4] as const;
const pickReach = 14;
const axisWords = (up: Vec): string => {
  const k = [0, 1, 2].find((i) => Math.abs(up[i]!) > 0.99);
  return k === undefined ? "a slanted axis" : `${up[k]! < 0 ? "−" : ""}${"xyz"[k]!}`;
};

/** The recording in space, on the instant that all plots share. */
export function space(scene: Scene, view: View, options: SpaceOptions): { node: HTMLElement; start: () => void; stop: () => void } {
  const M = scene.names.length;
  const everThere = options.live?.seen ?? scene.names.map((_, m) => isEverThere(scene.markers, scene.points, m));
  const lines = sticks(scene);
  const ahead = facing(scene);
  const canvas = el("canvas", { class: "space-canvas", tabindex: 0, role: "img", "aria-label": "Markers in space. Drag to turn, shift and drag to move, wheel to come nearer." });
  const labels = el("div", { class: "space-labels", "aria-hidden": "true" });
  const frame = el("div", { class: "space-frame" }, canvas, labels);
  const readout = el("p", { class: "readout", id: "space-readout" });
  const slider = el("input", { type: "range", min: 0, max: Math.max(0, scene.points - 1), step: 1, value: 0, "aria-label": "Instant" });
  const clock = el("span", { class: "clock" });
  const play = el("button", { type: "button", class: "play", "aria-label": "Play", "aria-pressed": "false", click: () => setPlaying(!playing) }, "▶");
  const choice = <T extends string>(label: string, words: readonly (readonly [T, string])[], first: T, change: (value: T) => void): HTMLElement => {
    const list = el("select", { "aria-label": label, change: () => change(list.value as T) });
    list.append(...words.map(([value, text]) => el("option", { value, ...(value === first ? { selected: true } : {}) }, text)));
    return el("label", { class: "pick" }, el("span", {}, label), list);
  };
  const toggle = (words: string, on: boolean, change: (on: boolean) => void): HTMLButtonElement => {
    const button = el("button", { type: "button", class: "choice", "aria-pressed": String(on), click: () => {
      const now = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(now));
      change(now);
    } }, words);
    return button;
  };

  let camera: Camera;
  let point = 0;
  let playing = false;
  let speed = 1;
  let loop = true;
  let trails: "none" | "picked" | "all" = "picked";
  let labelled: "none" | "picked" | "all" = M <= 16 && scene.skeleton === null ? "all" : "picked";
  const travels = goesFar(scene);
  let follow = travels;
  let followed: Vec | null = null;
  let showLines = true;
  let showOthers = true;
  let showFurther = !scene.isMain.includes(true);
  let regions = 1;
  let rays = true;
  let bodies = true;
  let cut = 0;
  let plane: Plane | null = null;
  let filming: { finish: () => Promise<Blob> } | null = null;
  let hover = -1;
  let picture: SpaceView | null = null;
  let pending = false;
  camera = firstCamera();

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

  function look(): Look {
    const perSecond = scene.rateHz / scene.frameStep;
    const all = trails === "all" ? scene.names.map((_, m) => m).filter((m) => !hidden(m)) : trails === "picked" && view.marker >= 0 && view.marker < M ? [view.marker] : [];
    const before = Math.max(2, Math.round((trails === "all" ? 0.5 : 1.5) * perSecond));
    return {
      camera,
      point,
      picked: view.marker,
      trailOf: all,
      trail: [before, trails === "picked" ? before : 0],
      lines: showLines,
      others: showOthers && options.others !== null,
      hidden,
      regions,
      rays,
      bodies,
      cut,
      plane,
    };
  }

  function redraw(): void {
    if (pending || picture === null) return;
    pending = true;
    requestAnimationFrame(() => {
      pending = false;
      draw();
    });
  }

  function draw(): void {
    if (picture === null) return;
    if (follow) {
      const one = view.marker >= 0 && view.marker < M && isThere(scene.markers, scene.points, view.marker, point) && !travels;
      const place = one ? at(scene.markers.x, scene.points, view.marker, point) : middleAt(scene, point);
      if (place !== null) {
        // What people chose to look at stays where it is in the picture.
        if (followed !== null) camera = { ...camera, target: add(camera.target, sub(place, followed)) };
        else if (one) camera = { ...camera, target: place };
        followed = place;
      }
    } else followed = null;
    picture.draw(look());
    frame.dataset["camera"] = JSON.stringify(camera);
    frame.dataset["point"] = String(point);
    frame.dataset["calls"] = String(picture.calls);
    putLabels(picture);
  }

  const tags: HTMLElement[] = [];
  /** Names beside their markers, as text; and x, y, z at the ends of the axes. */
  function putLabels(drawn: SpaceView): void {
    const wanted: [words: string, x: Vec, kind: string][] = [];
    for (let m = 0; m < M; ++m) {
      if (hidden(m)) continue;
      const asked = labelled === "all" || (labelled === "picked" && m === view.marker) || m === hover;
      if (asked) wanted.push([scene.names[m]!, at(scene.markers.x, scene.points, m, point), m === view.marker ? "tag picked" : "tag"]);
    }
    scene.skeleton?.names.forEach((name, j) => {
      if (labelled !== "none" && scene.skeleton!.states[j * scene.points + point]! > 0) wanted.push([name, at(scene.skeleton!.centres, scene.points, j, point), "tag joint"]);
    });
    for (const lens of scene.cameras) if (!lens.nominal) wanted.push([lens.name, lens.centre, "tag picked"]);
    const { origin } = drawn.floor;
    (["x", "y", "z"] as const).forEach((name, k) => {
      wanted.push([name, add(origin, [k === 0 ? 0.31 : 0, k === 1 ? 0.31 : 0, k === 2 ? 0.31 : 0]), `axis axis-${name}`]);
    });
    while (tags.length < wanted.length) {
      const tag = el("span");
      tags.push(tag);
      labels.append(tag);
    }
    tags.forEach((tag, i) => {
      const want = wanted[i];
      tag.hidden = want === undefined;
      if (want === undefined) return;
      const [left, top, depth] = drawn.place(camera, want[1]);
      tag.className = want[2];
      if (tag.textContent !== want[0]) tag.textContent = want[0];
      tag.hidden = camera.perspective && depth <= 0;
      tag.style.transform = `translate(${left.toFixed(2)}px, ${top.toFixed(2)}px)`;
    });
  }

  function tell(): void {
    slider.value = String(point);
    const time = scene.time[point] ?? 0;
    clock.textContent = `${seconds(time)}  frame ${number(scene.firstFrame + point * scene.frameStep)}`;
    slider.setAttribute("aria-valuetext", seconds(time));
    const m = view.marker;
    if (m < 0 || m >= M) {
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

  let began = 0;
  let from = 0;
  function setPlaying(on: boolean): void {
    playing = on && scene.points > 1;
    play.textContent = playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
    play.setAttribute("aria-pressed", String(playing));
    if (!playing) return;
    began = performance.now();
    from = point >= scene.points - 1 ? 0 : point;
    requestAnimationFrame(tick);
  }
  function tick(now: number): void {
    if (!playing) return;
    const gone = Math.floor(from + (((now - began) / 1000) * speed * (options.playHz ?? scene.rateHz)) / scene.frameStep);
    if (gone >= scene.points && filming !== null) {
      void endFilm();
      return;
    }
    if (gone >= scene.points && !loop) {
      goTo(scene.points - 1);
      setPlaying(false);
      return;
    }
    const next = Math.max(0, gone) % scene.points;
    if (next !== point) goTo(next);
    requestAnimationFrame(tick);
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

  /** Turn, move and come nearer with mouse, pen or fingers. */
  function listen(): void {
    const down = new Map<number, [number, number]>();
    let moved = 0;
    canvas.addEventListener("pointerdown", (e) => {
      down.set(e.pointerId, [e.offsetX, e.offsetY]);
      canvas.setPointerCapture(e.pointerId);
      moved = 0;
    });
    canvas.addEventListener("pointermove", (e) => {
      const before = down.get(e.pointerId);
      if (before === undefined) {
        const near = nearestMarker(e.offsetX, e.offsetY);
        if (near !== hover) {
          hover = near;
          canvas.style.cursor = near < 0 ? "grab" : "pointer";
          redraw();
        }
        return;
      }
      const [dx, dy] = [e.offsetX - before[0], e.offsetY - before[1]];
      moved += Math.abs(dx) + Math.abs(dy);
      const other = [...down.entries()].find(([id]) => id !== e.pointerId)?.[1];
      down.set(e.pointerId, [e.offsetX, e.offsetY]);
      if (other !== undefined) {
        const [was, is] = [Math.hypot(before[0] - other[0], before[1] - other[1]), Math.hypot(e.offsetX - other[0], e.offsetY - other[1])];
        camera = panned(zoomed(camera, was / Math.max(1, is)), dx / 2, dy / 2, canvas.clientHeight);
      } else if (e.shiftKey || (e.buttons & 6) !== 0) camera = panned(camera, dx, dy, canvas.clientHeight);
      else if (moved > 3) camera = orbited(camera, -0.008 * dx, 0.008 * dy);
      redraw();
    });
    const up = (e: PointerEvent): void => {
      if (!down.delete(e.pointerId) || moved > 4 || e.type === "pointercancel") return;
      view.set({ marker: nearestMarker(e.offsetX, e.offsetY) });
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("wheel", (e) => {
      // The page scrolls until somebody has clicked into the picture.
      if (document.activeElement !== canvas && !e.ctrlKey) return;
      e.preventDefault();
      camera = zoomed(camera, Math.exp(0.0012 * e.deltaY));
      redraw();
    }, { passive: false });
    canvas.addEventListener("keydown", (e) => {
      if (!press(e.key, e.shiftKey)) return;
      e.preventDefault();
    });
  }

  function press(key: string, shift: boolean): boolean {
    const views: Record<string, StandardView> = { "1": "front", "2": "side", "3": "top", "4": "corner" };
    const wanted = views[key];
    if (wanted !== undefined) seeFrom(wanted);
    else if (options.live !== undefined && [" ", "ArrowLeft", "ArrowRight", "Home", "End"].includes(key)) return false;
    else if (key === " ") setPlaying(!playing);
    else if (key === "ArrowLeft" || key === "ArrowRight") goTo(point + (key === "ArrowLeft" ? -1 : 1) * (shift ? 10 : 1));
    else if (key === "Home" || key === "End") goTo(key === "Home" ? 0 : scene.points - 1);
    else if (key === "+" || key === "-") camera = zoomed(camera, key === "+" ? 0.87 : 1.15);
    else if (key === "0") camera = firstCamera();
    else return false;
    redraw();
    return true;
  }

  function seeFrom(wanted: StandardView): void {
    camera = follow ? standardView(camera, wanted, ahead) : framed(standardView(camera, wanted, ahead));
    redraw();
  }

  function start(): void {
    try {
      picture = new SpaceView(canvas, scene, lines);
    } catch {
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
      const time = (playing ? null : view.pointer) ?? view.focus;
      if (options.live !== undefined) point = scene.points - 1;
      else if (time !== null) point = pointAt(scene, time);
      tell();
      redraw();
    });
    slider.addEventListener("input", () => {
      setPlaying(false);
      goTo(Number(slider.value));
    });
    camera = options.kept?.camera ?? firstCamera();
    fit();
    tell();
  }

  function stop(): void {
    setPlaying(false);
    if (options.kept !== undefined) options.kept.camera = camera;
    picture?.dispose();
    picture = null;
  }

  async function savePicture(): Promise<void> {
    picture?.drawSmooth(look());
    const ratio = canvas.width / Math.max(1, canvas.clientWidth);
    const copy = el("canvas", { width: canvas.width, height: canvas.height });
    const pen = copy.getContext("2d")!;
    pen.drawImage(canvas, 0, 0);
    pen.scale(ratio, ratio);
    pen.font = "12px system-ui, sans-serif";
    pen.textBaseline = "middle";
    for (const tag of tags) {
      if (tag.hidden) continue;
      const [left, top] = /translate\(([-\d.]+)px, ([-\d.]+)px\)/.exec(tag.style.transform)!.slice(1).map(Number) as [number, number];
      pen.fillStyle = palette().ink;
      pen.fillText(tag.textContent ?? "", left + 8, top - 8);
    }
    const blob = await new Promise<Blob | null>((done) => copy.toBlob(done, "image/png"));
    if (blob !== null) save(fileName(`${options.trial}_${(scene.time[point] ?? 0).toFixed(3)}s`, "png"), blob);
  }

  function saveGlb(): void {
    const bytes = glbOf(scene, lines, options.trial);
    save(fileName(options.trial, "glb"), new Blob([bytes as BlobPart], { type: "model/gltf-binary" }));
  }

  /** The whole recording once, from its beginning, at the chosen speed. */
  function beginFilm(): void {
    if (filming !== null) return void endFilm();
    setPlaying(false);
    if (picture === null) return;
    picture.keepsSize = true;
    picture.draw(look());
    filming = film(canvas, 30);
    filmButton.textContent = "End film";
    point = 0;
    goTo(0);
    setPlaying(true);
    from = 0;
  }
  async function endFilm(): Promise<void> {
    const done = filming;
    filming = null;
    setPlaying(false);
    filmButton.textContent = "Save film";
    if (picture !== null) picture.keepsSize = false;
    draw();
    if (done !== null) save(fileName(options.trial, "webm"), await done.finish());
  }

  /** The plane of the chosen marker's path over the time that the plots show. */
  function fitPlane(on: boolean): void {
    plane = null;
    if (on && view.marker >= 0 && view.marker < M) plane = planeOf(scene, view.marker, pointAt(scene, view.range[0]), pointAt(scene, view.range[1]));
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
  const filmButton = el("button", { type: "button", title: "Play the recording once and save it as WebM", click: () => beginFilm() }, "Save film");
  const cutSlider = el("input", { type: "range", min: 0, max: 100, step: 1, value: 0, "aria-label": "Cut away what is nearest, per cent", input: () => { cut = Number(cutSlider.value) / 100; redraw(); } });

  const viewButton = (words: string, wanted: StandardView, key: string): HTMLElement =>
    el("button", { type: "button", title: `${words} (${key})`, click: () => seeFrom(wanted) }, words);
  const further = scene.names.filter((_, m) => everThere[m] && !scene.isMain[m]).length;
  const seen = new Set(scene.names.flatMap((_, m) => (hidden(m) ? [] : [...new Set(scene.markers.states.subarray(m * scene.points, (m + 1) * scene.points))])));
  const facts = [
    `${axisWords(scene.up)} is up${scene.upFrom === "" ? " (assumed)" : ` (from ${scene.upFrom})`}`,
    further > 0 && scene.isMain.includes(true) ? "further points: not named, or computed by the recorder's model" : "",
    scene.bodies !== null ? "bodies are ellipsoids of the model's masses at 1,000 kg/m³, not its shape" : "",
    scene.forces.length > 0 ? "force arrows: 1 m for 1,000 N" : "",
    lines.length > 0 ? (areConventional(scene.names) ? "lines follow the conventional gait marker set" : "lines join markers whose distance stays the same") : "",
  ].filter((f) => f !== "");
  const node = section(
    "space",
    "Space",
    options.lead ?? "",
    scene.frameStep === 1 || options.live !== undefined
      ? null
      : el("p", { class: "thinned" }, `Long recording: space and curves show every ${number(scene.frameStep)}${scene.frameStep === 2 ? "nd" : scene.frameStep === 3 ? "rd" : "th"} frame as it is (${number(scene.rateHz / scene.frameStep, 2)} Hz). The map of gaps and all numbers come from all frames.`),
    el(
      "div",
      { class: "controls" },
      viewButton("Front", "front", "1"),
      viewButton("Side", "side", "2"),
      viewButton("Top", "top", "3"),
      viewButton("Corner", "corner", "4"),
      toggle("Perspective", true, (on) => { camera = { ...camera, perspective: on }; redraw(); }),
      toggle("Follow", follow, (on) => { follow = on; followed = null; redraw(); }),
      lines.length === 0 ? null : toggle("Lines", true, (on) => { showLines = on; redraw(); }),
      options.others === null ? null : toggle(options.others.switch, true, (on) => { showOthers = on; redraw(); }),
      further === 0 || showFurther ? null : toggle(`${number(further)} further`, false, (on) => { showFurther = on; redraw(); }),
      choice("Names", [["none", "none"], ["picked", "picked"], ["all", "all"]], labelled, (v) => { labelled = v; redraw(); }),
      choice("Paths", [["none", "none"], ["picked", "picked"], ["all", "all"]], trails, (v) => { trails = v; redraw(); }),
      scene.skeleton === null ? null : choice("95 % regions", [["0", "none"], ["1", "true size"], ["3", "3 ×"], ["10", "10 ×"]], "1", (v) => { regions = Number(v); redraw(); }),
      scene.bodies === null ? null : toggle("Bodies", true, (on) => { bodies = on; redraw(); }),
      scene.cameras.length === 0 ? null : toggle("Rays", true, (on) => { rays = on; redraw(); }),
      options.live !== undefined ? null : planeButton,
      el("label", { class: "pick" }, el("span", {}, "Cut"), cutSlider),
      el("button", { type: "button", click: () => void savePicture() }, "Save picture"),
      options.live !== undefined ? null : el("button", { type: "button", title: "Save the animation for Blender and others", click: () => saveGlb() }, "Save GLB"),
      canFilm() && options.live === undefined ? filmButton : null,
    ),
    frame,
    options.live !== undefined ? null : el(
      "div",
      { class: "transport" },
      play,
      el("button", { type: "button", "aria-label": "Frame before", click: () => goTo(point - 1) }, "‹"),
      el("button", { type: "button", "aria-label": "Next frame", click: () => goTo(point + 1) }, "›"),
      slider,
      clock,
      choice("Speed", speeds.map((s) => [String(s), `${s} ×`] as const), "1", (v) => { speed = Number(v); if (playing) setPlaying(true); }),
      toggle("Loop", true, (on) => { loop = on; }),
    ),
    readout,
    planeFacts,
    el(
      "ul",
      { class: "legend shapes" },
      ...stateWords.flatMap((words, state) =>
        seen.has(state) ? [el("li", {}, svg("svg", { viewBox: "0 0 20 20", class: `mark mark-${state}${statePaths[state]!.hollow ? " hollow" : ""}`, "aria-hidden": "true" }, svg("path", { d: statePaths[state]!.d })) as unknown as HTMLElement, state === 4 ? "missing: where it was last" : words)] : [],
      ),
      options.others === null ? null : el("li", {}, svg("svg", { viewBox: "0 0 20 20", class: "mark mark-other hollow", "aria-hidden": "true" }, svg("path", { d: statePaths[4]!.d })) as unknown as HTMLElement, options.others.legend),
    ),
    el("p", { class: "facts" }, `${facts.join("; ")}. Click into the picture: ${options.live !== undefined ? "" : "space plays, arrows step, "}1 to 4 are views, + and − come nearer, 0 starts over.`),
  );
  return { node, start, stop };
}
