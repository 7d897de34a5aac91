// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import {
  BufferGeometry,
  CircleGeometry,
  Color,
  CylinderGeometry,
  DirectionalLight,
  DoubleSide,
  Float32BufferAttribute,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  OrthographicCamera,
  PerspectiveCamera,
  Plane as ClipPlane,
  RingGeometry,
  Scene as Stage,
  Vector3,
  WebGLRenderer,
} from "three";
import { palette } from "../theme.ts";
import { metresPerPixel, poseOf, project, fieldOfView, type Camera, type Pose } from "./camera.ts";
import { floorLines, floorOf, type Floor } from "./floor.ts";
import type { Plane } from "./plane.ts";
import { at, bounds, type Scene } from "./scene.ts";
import { isDrawnByProcessor } from "./drawn_by.ts";
import { Extras } from "./extras.ts";
import { Kind } from "./kind.ts";
import { Ribbons } from "./ribbons.ts";
import { arrowHead, stateShapes } from "./shapes.ts";
import type { Stick } from "./sticks.ts";
import { firstAbsent } from "../states.ts";
import { add, cross, dot, length, scaled, sub, unit, type Vec } from "./vec.ts";

/** Metres of an arrow for a newton. */
export const metresPerNewton = 1 / 1000;
const mostTrail = 3000;
/** What stood still for so long, ms, is drawn with so many pixels a side of a pixel of the page where the processor draws. */
const stillAfter = 160;
const smoothRatio = 2;

/** What the picture shows besides the scene. */
export interface Look {
  camera: Camera;
  point: number;
  picked: number;
  /** Markers whose path is drawn. */
  trailOf: readonly number[];
  /** Points before and after the instant that a trail covers. */
  trail: [before: number, after: number];
  lines: boolean;
  /** The recording before it was cleaned, or the markers of the model. */
  others: boolean;
  hidden: (marker: number) => boolean;
  /** How many times as large as it is the region of a joint centre is drawn; 0: not at all. */
  regions: number;
  /** The bodies of a model. */
  bodies: boolean;
  /** Lines of sight. */
  rays: boolean;
  /** Share of the depth of the scene that is cut away in front, 0 to 1. */
  cut: number;
  /** The plane that fits a path best; null: none. */
  plane: Plane | null;
}

/** Draws a scene. Knows the canvas and nothing around it; throws where there is no WebGL2. */
export class SpaceView {
  readonly #renderer: WebGLRenderer;
  readonly #stage = new Stage();
  readonly #sun = new DirectionalLight(0xffffff, 1.6);
  readonly #sky = new HemisphereLight(0xffffff, 0x8a949c, 1.9);
  readonly #states: Kind[];
  readonly #others: Kind;
  readonly #ties: Kind;
  readonly #sticks: Kind;
  readonly #shadows: Kind;
  readonly #stickShadows: Kind;
  readonly #trails: Ribbons;
  readonly #shafts: Kind;
  readonly #heads: Kind;
  readonly #ring: Kind;
  readonly #grid: LineSegments;
  readonly #axes: Kind;
  readonly #plates: LineSegments;
  readonly #plateFill: Mesh;
  readonly floor: Floor;
  readonly #extras: Extras;
  readonly #reach: number;
  /** A film is being made, of pictures that are as many pixels large and come as fast as can be. */
  keepsSize = false;
  /** The processor draws: edges are smooth in what stands still alone. */
  readonly #isSlow: boolean;
  #width = 1;
  #height = 1;
  #ratio = 1;
  #drawnRatio = 0;
  #still = 0;

  constructor(
    readonly canvas: HTMLCanvasElement,
    readonly scene: Scene,
    readonly sticks: readonly Stick[],
  ) {
    this.#isSlow = isDrawnByProcessor();
    const context = canvas.getContext("webgl2", { antialias: !this.#isSlow, preserveDrawingBuffer: true, alpha: false });
    if (context === null) throw new Error("no WebGL2");
    this.#renderer = new WebGLRenderer({ canvas, context });
    const M = scene.names.length;
    const stage = this.#stage;
    this.floor = floorOf(scene);
    const lit = (): MeshLambertMaterial => new MeshLambertMaterial();
    const plain = (): MeshBasicMaterial => new MeshBasicMaterial({ side: DoubleSide });
    const rod = (sides = 10): BufferGeometry => new CylinderGeometry(1, 1, 1, sides, 1, true);
    this.#grid = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true }));
    this.#plates = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
    this.#plateFill = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.22, depthWrite: false }));
    stage.add(this.#grid, this.#plateFill, this.#plates, this.#sky, this.#sun, this.#sun.target);
    this.#shadows = new Kind(stage, new CircleGeometry(1, 20), plain(), M);
    this.#stickShadows = new Kind(stage, rod(6), plain(), sticks.length);
    this.#sticks = new Kind(stage, rod(), lit(), sticks.length);
    this.#states = stateShapes.map(
      ({ geometry, facesEye }) => new Kind(stage, geometry(), facesEye ? plain() : lit(), M),
    );
    this.#others = new Kind(stage, new RingGeometry(0.72, 1, 24), plain(), M);
    this.#ties = new Kind(stage, rod(6), plain(), M);
    this.#trails = new Ribbons(stage, mostTrail);
    this.#shafts = new Kind(stage, rod(14), lit(), scene.forces.length);
    this.#heads = new Kind(stage, arrowHead(), lit(), scene.forces.length);
    this.#ring = new Kind(stage, new RingGeometry(1.55, 1.95, 32), plain(), 1, { order: 5 });
    this.#axes = new Kind(stage, rod(8), plain(), 3, { coloured: true });
    this.#layPlates();
    this.#extras = new Extras(stage, scene);
    const [low, high] = bounds(scene, 0);
    this.#reach = Math.max(0.2, length(sub(high, low)));
  }

  resize(width: number, height: number, ratio = Math.min(2, Math.max(1, window.devicePixelRatio))): void {
    this.#width = width;
    this.#height = height;
    this.#ratio = ratio;
    this.#drawnRatio = 0;
  }

  #scale(ratio: number): void {
    if (ratio === this.#drawnRatio) return;
    this.#drawnRatio = ratio;
    this.#renderer.setPixelRatio(ratio);
    this.#renderer.setSize(this.#width, this.#height, false);
  }

  /** Pixels of a place in the picture, and its depth. */
  place(camera: Camera, x: Vec): [x: number, y: number, depth: number] {
    return project(camera, poseOf(camera), this.#width, this.#height, x);
  }

  /** Draw calls of the last picture. */
  get calls(): number {
    return this.#renderer.info.render.calls;
  }

  /** Draw; where the processor does it, a picture that nothing follows is drawn once more with smooth edges. */
  draw(look: Look): void {
    if (!this.#isSlow) {
      this.drawSmooth(look);
      return;
    }
    window.clearTimeout(this.#still);
    this.#scale(1);
    this.#draw(look);
    this.canvas.dataset["still"] = "no";
    if (this.keepsSize) return;
    this.#still = window.setTimeout(() => this.drawSmooth(look), stillAfter);
  }

  /** Draw as a picture that is kept shall look. */
  drawSmooth(look: Look): void {
    window.clearTimeout(this.#still);
    this.#scale(this.#isSlow ? smoothRatio : this.#ratio);
    this.#draw(look);
    this.canvas.dataset["still"] = "yes";
  }

  #draw(look: Look): void {
    const pose = poseOf(look.camera);
    this.#paint();
    const tint = this.#putMarkers(look, pose);
    this.#putSticks(look, tint);
    this.#putTrails(look, pose);
    this.#putForces(look, pose);
    this.#extras.put(look, (x) => this.#radius(look.camera, pose, x), tint);
    this.#cut(look, pose);
    this.#sun.position.set(...add(pose.eye, add(scaled(pose.up, 0.6), pose.right, -0.5), look.camera.distance));
    this.#sun.target.position.set(...look.camera.target);
    this.#renderer.render(this.#stage, this.#cameraOf(look.camera, pose));
  }

  /** Cut away what is nearer than a plane across the view. */
  #cut(look: Look, pose: Pose): void {
    if (look.cut <= 0) {
      this.#renderer.clippingPlanes = [];
      return;
    }
    const forward = pose.forward;
    const middle = dot(look.camera.target, forward);
    const depth = middle + (look.cut - 0.5) * this.#reach;
    this.#renderer.clippingPlanes = [new ClipPlane(new Vector3(...forward), -depth)];
  }

  /** Give back what a browser has few of. */
  dispose(): void {
    window.clearTimeout(this.#still);
    this.#renderer.dispose();
    this.#renderer.getContext().getExtension("WEBGL_lose_context")?.loseContext();
  }

  #cameraOf(camera: Camera, pose: Pose): PerspectiveCamera | OrthographicCamera {
    const aspect = this.#width / this.#height;
    const half = camera.distance * Math.tan(fieldOfView / 2);
    const made = camera.perspective
      ? new PerspectiveCamera((fieldOfView * 180) / Math.PI, aspect, 0.02, 400)
      : new OrthographicCamera(-half * aspect, half * aspect, half, -half, -200, 400);
    made.position.set(...pose.eye);
    made.up.set(...pose.up);
    made.lookAt(new Vector3(...add(pose.eye, pose.forward)));
    made.updateProjectionMatrix();
    return made;
  }

  #painted: unknown = null;

  /** Colours of the theme, which may have changed since the last picture. */
  #paint(): void {
    const p = palette();
    if (p === this.#painted) return;
    this.#painted = p;
    this.#stage.background = new Color(p.background);
    const colour = (kind: Kind, value: string): void => void (kind.mesh.material as MeshBasicMaterial).color.set(value);
    p.marks.forEach((value, state) => colour(this.#states[state]!, value));
    colour(this.#others, p.second);
    colour(this.#ties, p.second);
    colour(this.#sticks, p.stick);
    colour(this.#shadows, p.shadow);
    colour(this.#stickShadows, p.shadow);
    colour(this.#shafts, p.force);
    colour(this.#heads, p.force);
    colour(this.#ring, p.second);
    this.#extras.paint(p);
    (this.#plates.material as LineBasicMaterial).color.set(p.muted);
    (this.#plateFill.material as MeshBasicMaterial).color.set(p.muted);
    const { positions, strong } = floorLines(this.floor);
    const [weak, firm] = [new Color(p.floor), new Color(p.floorStrong)];
    this.#grid.geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
    this.#grid.geometry.setAttribute("color", new Float32BufferAttribute(strong.flatMap((s) => (s ? firm : weak).toArray()), 3));
    this.#axes.begin();
    const axis = 0.25;
    const origin = this.floor.origin;
    p.axes.forEach((value, k) => {
      const way: Vec = [k === 0 ? axis : 0, k === 1 ? axis : 0, k === 2 ? axis : 0];
      this.#axes.rod(origin, add(origin, way), 0.006, new Color(value));
    });
    this.#axes.end();
  }

  /** Radius of a marker in m: 9 mm, and never too small to see. */
  #radius(camera: Camera, pose: Pose, x: Vec): number {
    const depth = dot(sub(x, pose.eye), pose.forward);
    return Math.max(0.009, 3.6 * metresPerPixel(camera, depth, this.#height));
  }

  #putMarkers(look: Look, pose: Pose): (marker: number) => boolean {
    const { scene, floor } = this;
    const { points } = scene;
    const all = [...this.#states, this.#shadows, this.#ring, this.#others, this.#ties];
    for (const kind of all) kind.begin();
    const [first, second] = floor.axes;
    const shown = (m: number): boolean => !look.hidden(m);
    for (let m = 0; m < scene.names.length; ++m) {
      if (!shown(m)) continue;
      const state = scene.markers.states[m * points + look.point]!;
      const x = at(scene.markers.x, points, m, look.point);
      const r = this.#radius(look.camera, pose, x);
      const { facesEye } = stateShapes[state]!;
      if (facesEye) this.#states[state]!.put(scaled(pose.right, r), scaled(pose.up, r), scaled(pose.forward, -r), x);
      else this.#states[state]!.put([r, 0, 0], [0, r, 0], [0, 0, r], x);
      if (m === look.picked) this.#ring.put(scaled(pose.right, r), scaled(pose.up, r), scaled(pose.forward, -r), x);
      if (state < firstAbsent) {
        this.#shadows.put(scaled(first, r), scaled(second, r), scaled(scene.up, r), floor.below(x, 0.0015));
      }
      const other = look.others ? this.#other(m, look.point) : null;
      if (other === null) continue;
      const reach = scaled(pose.right, 1.25 * r);
      this.#others.put(reach, scaled(pose.up, 1.25 * r), scaled(pose.forward, -r), other);
      if (state < firstAbsent) this.#ties.rod(x, other, 0.35 * r);
    }
    for (const kind of all) kind.end();
    return shown;
  }

  /** Where the model has a marker, or where it was before cleaning; null where nobody knows. */
  #other(marker: number, point: number): Vec | null {
    const { scene } = this;
    const x = scene.model ?? scene.before?.x;
    if (x === undefined) return null;
    if (scene.model === null && scene.before!.states[marker * scene.points + point]! >= firstAbsent) return null;
    if (scene.model !== null && scene.markers.states[marker * scene.points + point]! >= firstAbsent) return null;
    return at(x, scene.points, marker, point);
  }

  #putSticks(look: Look, shown: (marker: number) => boolean): void {
    const { scene } = this;
    const { points, markers } = scene;
    this.#sticks.begin();
    this.#stickShadows.begin();
    for (const [a, b] of look.lines ? this.sticks : []) {
      const absent = (m: number): boolean => !shown(m) || markers.states[m * points + look.point]! >= firstAbsent;
      if (absent(a) || absent(b)) continue;
      const from = at(markers.x, points, a, look.point);
      const to = at(markers.x, points, b, look.point);
      this.#sticks.rod(from, to, 0.0045);
      this.#stickShadows.rod(this.floor.below(from, 0.001), this.floor.below(to, 0.001), 0.004);
    }
    this.#sticks.end();
    this.#stickShadows.end();
  }

  #putTrails(look: Look, pose: Pose): void {
    const { points, markers } = this.scene;
    const [from, to] = [Math.max(0, look.point - look.trail[0]), Math.min(points - 1, look.point + look.trail[1])];
    const [old, middle, recent] = palette().trail.map((c) => new Color(c)) as [Color, Color, Color];
    const colour = new Color();
    const sight = (x: Vec): Vec => (look.camera.perspective ? sub(x, pose.eye) : pose.forward);
    const stride = Math.max(1, Math.ceil(((to - from + 1) * look.trailOf.length) / mostTrail));
    this.#trails.begin();
    for (const m of look.trailOf) {
      const places: Vec[] = [];
      const shares: number[] = [];
      const end = (): void => {
        this.#trails.path(places, sight, (x) => 0.28 * this.#radius(look.camera, pose, x), (i) => {
          const share = shares[i]!;
          return share < 0.5 ? colour.lerpColors(old, middle, 2 * share) : colour.lerpColors(middle, recent, 2 * share - 1);
        });
        places.length = shares.length = 0;
      };
      for (let p = from; p <= to; p += stride) {
        if (markers.states[m * points + p]! >= firstAbsent) {
          end();
          continue;
        }
        places.push(at(markers.x, points, m, p));
        shares.push((p - from) / Math.max(1, to - from));
      }
      end();
    }
    this.#trails.end();
  }

  #putForces(look: Look, pose: Pose): void {
    const { scene } = this;
    this.#shafts.begin();
    this.#heads.begin();
    for (const { force, point } of scene.forces) {
      const f = scaled(at(force, scene.points, 0, look.point), metresPerNewton);
      const x = at(point, scene.points, 0, look.point);
      if (length(f) < 0.02) continue;
      const r = 0.9 * this.#radius(look.camera, pose, x);
      const tip = add(x, f);
      const head = Math.min(5 * r, 0.5 * length(f));
      const along = unit(f);
      const aside = unit(cross(along, Math.abs(along[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
      this.#shafts.rod(x, add(tip, along, -head), r);
      this.#heads.put(scaled(aside, 2.4 * r), scaled(along, head), scaled(cross(aside, along), 2.4 * r), tip);
    }
    this.#shafts.end();
    this.#heads.end();
  }

  #layPlates(): void {
    const edges: number[] = [];
    const faces: number[] = [];
    for (const corners of this.scene.plates) {
      const [a, b, c, d] = corners.map((x) => add(x, this.scene.up, 0.002)) as [Vec, Vec, Vec, Vec];
      edges.push(...a, ...b, ...b, ...c, ...c, ...d, ...d, ...a);
      faces.push(...a, ...b, ...c, ...a, ...c, ...d);
    }
    this.#plates.geometry.setAttribute("position", new Float32BufferAttribute(edges, 3));
    this.#plateFill.geometry.setAttribute("position", new Float32BufferAttribute(faces, 3));
    this.#plates.visible = this.#plateFill.visible = edges.length > 0;
  }
}
