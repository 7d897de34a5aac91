// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
import { Color, DirectionalLight, HemisphereLight, OrthographicCamera, PerspectiveCamera, Plane as ClipPlane, Scene as Stage, Vector3, WebGLRenderer } from "three";
import { palette } from "../theme.ts";
import { metresPerPixel, poseOf, project, fieldOfView, type Camera, type Pose } from "./camera.ts";
import { isDrawnByProcessor } from "./drawn_by.ts";
import { Extras } from "./extras.ts";
import { floorOf, type Floor } from "./floor.ts";
import { ForceArrows } from "./force_arrows.ts";
import { Ground } from "./ground.ts";
import { GoalMarks } from "./goal_marks.ts";
import type { Look } from "./look.ts";
import { MarkerSolids } from "./marker_solids.ts";
import { bounds, type Scene } from "./scene.ts";
import type { Stick } from "./sticks.ts";
import { Trails } from "./trails.ts";
import { add, dot, length, scaled, sub, type Vec } from "./vec.ts";

/** What stood still for so long, ms, is drawn with so many pixels a side of a pixel of the page where the processor draws. */
const stillAfter = 160;
const smoothRatio = 2;

/** Draws a scene. Knows the canvas and nothing around it; throws where there is no WebGL2. */
export class SpaceView {
  readonly #renderer: WebGLRenderer;
  readonly #stage = new Stage();
  readonly #sun = new DirectionalLight(0xffffff, 1.6);
  readonly #sky = new HemisphereLight(0xffffff, 0x8a949c, 1.9);
  readonly #ground: Ground;
  readonly #markers: MarkerSolids;
  readonly #trails: Trails;
  readonly #forces: ForceArrows;
  readonly floor: Floor;
  readonly #extras: Extras;
  readonly #goals: GoalMarks | null;
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
    sticks: readonly Stick[],
  ) {
    this.#isSlow = isDrawnByProcessor();
    const context = canvas.getContext("webgl2", { antialias: !this.#isSlow, preserveDrawingBuffer: true, alpha: false });
    if (context === null) throw new Error("no WebGL2");
    this.#renderer = new WebGLRenderer({ canvas, context });
    const stage = this.#stage;
    this.floor = floorOf(scene);
    stage.add(this.#sky, this.#sun, this.#sun.target);
    this.#ground = new Ground(stage, scene, this.floor);
    this.#markers = new MarkerSolids(stage, scene, sticks, this.floor);
    this.#trails = new Trails(stage, scene);
    this.#forces = new ForceArrows(stage, scene);
    this.#extras = new Extras(stage, scene);
    this.#goals = scene.goals === undefined ? null : new GoalMarks(stage, scene);
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
    const radius = (x: Vec): number => this.#radius(look.camera, pose, x);
    const shown = this.#markers.put(look, pose, radius);
    this.#trails.put(look, pose, radius);
    this.#forces.put(look, radius);
    this.#extras.put(look, radius, shown);
    this.#goals?.put(look, pose, radius);
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
    for (const part of [this.#ground, this.#markers, this.#forces, this.#extras, this.#goals]) part?.paint(p);
  }

  /** Radius of a marker in m: 9 mm, and never too small to see. */
  #radius(camera: Camera, pose: Pose, x: Vec): number {
    const depth = dot(sub(x, pose.eye), pose.forward);
    return Math.max(0.009, 3.6 * metresPerPixel(camera, depth, this.#height));
  }
}
