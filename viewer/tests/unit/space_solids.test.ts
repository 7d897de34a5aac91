// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the parts of the space view put where, without a canvas.
import { Mesh, Scene as Stage, type BufferGeometry } from "three";
import { describe, expect, it } from "vitest";
import type { Vec } from "../../src/scene/vec.ts";
import type { Look } from "../../src/scene/look.ts";
import { install } from "../fake_dom.ts";
import { sceneWith } from "../scene_with.ts";

install();
const { poseOf } = await import("../../src/scene/camera.ts");
const { floorOf } = await import("../../src/scene/floor.ts");
const { ForceArrows, metresPerNewton } = await import("../../src/scene/force_arrows.ts");
const { Ground } = await import("../../src/scene/ground.ts");
const { MarkerSolids } = await import("../../src/scene/marker_solids.ts");
const { Trails } = await import("../../src/scene/trails.ts");
const { palette } = await import("../../src/theme.ts");

const look = (more: Partial<Look> = {}): Look => ({
  camera: { target: [0, 0, 0], up: [0, 0, 1], azimuth: 0.3, elevation: 0.2, distance: 3, perspective: true },
  point: 0, picked: -1, trailOf: [], trail: [5, 5], lines: true, others: true, hidden: () => false, regions: 1, bodies: true, rays: true, cut: 0, plane: null, ...more,
});
const radius = (): number => 0.01;

/** Corners that are drawn, of all meshes of a stage. */
function drawn(stage: Stage): Vec[] {
  return stage.children.filter((c): c is Mesh => c instanceof Mesh && c.visible).flatMap((mesh) => {
    const geometry = mesh.geometry as BufferGeometry;
    const position = geometry.getAttribute("position");
    const index = geometry.index!;
    const count = Math.min(index.count, geometry.drawRange.count);
    return Array.from({ length: count }, (_, i) => index.getX(i)).map((i): Vec => [position.getX(i), position.getY(i), position.getZ(i)]);
  });
}
const within = (corners: Vec[], x: Vec, reach: number): Vec[] => corners.filter((c) => Math.hypot(...c.map((v, k) => v - x[k as 0])) < reach);

describe("forces", () => {
  const scene = sceneWith(["A"], 2, () => [0, 0, 1], { forces: [{ name: "plate", force: Float32Array.from([0, 0, 0, 0, 700, 5]), point: Float32Array.from([0.2, 0.2, 0.3, 0.3, 0, 0]) }] });
  it("are arrows from where they act, a metre for 1,000 N", () => {
    expect(metresPerNewton).toBe(0.001);
    const stage = new Stage();
    const arrows = new ForceArrows(stage, scene);
    arrows.put(look(), radius);
    const heights = drawn(stage).map((c) => c[2]);
    expect(Math.min(...heights)).toBeCloseTo(0, 6);
    expect(Math.max(...heights)).toBeCloseTo(0.7, 6);
    expect(within(drawn(stage), [0.2, 0.3, 0.35], 0.4).length).toBe(drawn(stage).length);
  });
  it("that are hardly there are left out", () => {
    const stage = new Stage();
    new ForceArrows(stage, scene).put(look({ point: 1 }), radius);
    expect(drawn(stage)).toEqual([]);
  });
});

describe("markers", () => {
  const model = Float32Array.from([0, 0, 0.05, 1, 1, 0.05, 3, 3, 0.1].flatMap((v) => [v, v]));
  const scene = sceneWith(["A", "B", "low"], 2, (m) => (m === 2 ? [3, 3, 0.1] : [m, m, 0.5]), { model });
  scene.markers.states[3] = 4;
  const floor = floorOf(scene);
  const put = (more: Partial<Look>): { corners: Vec[]; shown: (m: number) => boolean } => {
    const stage = new Stage();
    const solids = new MarkerSolids(stage, scene, [[0, 1]], floor);
    const l = look(more);
    const shown = solids.put(l, poseOf(l.camera), radius);
    return { corners: drawn(stage), shown };
  };
  it("stand where they are, with a shadow on the floor below", () => {
    const { corners } = put({ lines: false, others: false });
    expect(within(corners, [0, 0, 0.5], 0.02).length).toBeGreaterThan(20);
    const shadow = within(corners, floor.below([1, 1, 0.5], 0.0015), 0.02);
    expect(shadow.length).toBeGreaterThan(20);
    for (const c of shadow) expect(c[2]).toBeCloseTo(floor.height + 0.0015, 6);
  });
  it("are joined by lines, and tied to where the model has them", () => {
    const bare = put({ lines: false, others: false }).corners.length;
    expect(put({ lines: true, others: false }).corners.length).toBeGreaterThan(bare);
    const tied = put({ lines: false, others: true }).corners;
    expect(within(tied, [0, 0, 0.05], 0.02).length).toBeGreaterThan(20);
  });
  it("that are missing have no shadow, no line and no tie", () => {
    const { corners } = put({ point: 1 });
    expect(within(corners, [1, 1, 0.5], 0.03).length).toBeGreaterThan(0);
    expect(within(corners, floor.below([1, 1, 0.5], 0.0015), 0.02)).toEqual([]);
    expect(within(corners, [0.5, 0.5, 0.5], 0.3)).toEqual([]);
    expect(within(corners, [1, 1, 0.05], 0.03)).toEqual([]);
  });
  it("that are hidden are not drawn", () => {
    const { corners, shown } = put({ hidden: (m) => m === 1, others: false });
    expect([shown(0), shown(1)]).toEqual([true, false]);
    expect(within(corners, [1, 1, 0.5], 0.1)).toEqual([]);
  });
  it("have a ring where one is picked", () => {
    const none = put({ others: false, lines: false }).corners.length;
    expect(put({ others: false, lines: false, picked: 1 }).corners.length).toBeGreaterThan(none);
  });
});

describe("paths", () => {
  it("run over the instants around, and end where the marker is missing", () => {
    const scene = sceneWith(["A"], 21, (_, p) => [0.1 * p, 0, 1]);
    scene.markers.states.fill(4, 12, 15);
    const stage = new Stage();
    const trails = new Trails(stage, scene);
    const l = look({ point: 10, trailOf: [0], trail: [5, 8] });
    trails.put(l, poseOf(l.camera), radius);
    const xs = drawn(stage).map((c) => c[0]);
    expect(Math.min(...xs)).toBeCloseTo(0.5, 1);
    expect(Math.max(...xs)).toBeCloseTo(1.8, 1);
    expect(xs.filter((x) => x > 1.16 && x < 1.44)).toEqual([]);
    trails.put({ ...l, trailOf: [] }, poseOf(l.camera), radius);
    expect(drawn(stage)).toEqual([]);
  });
});

describe("what stands still", () => {
  it("is a floor, the axes of the laboratory and the plates on it", () => {
    const plates = [[[0, 0, 0], [0.4, 0, 0], [0.4, 0.6, 0], [0, 0.6, 0]] as Vec[]];
    const scene = sceneWith(["A"], 1, () => [0.2, 0.3, 1], { plates });
    const stage = new Stage();
    const floor = floorOf(scene);
    new Ground(stage, scene, floor).paint(palette());
    const [grid, fill, edges, axes] = stage.children as [Mesh, Mesh, Mesh, Mesh];
    expect(grid.geometry.getAttribute("position").count).toBeGreaterThan(8);
    expect(fill.geometry.getAttribute("position").count).toBe(6);
    expect(edges.geometry.getAttribute("position").count).toBe(8);
    axes.geometry.computeBoundingBox();
    const { min, max } = axes.geometry.boundingBox!;
    expect(max.z - floor.origin[2]).toBeCloseTo(0.25, 2);
    expect(min.z).toBeGreaterThan(floor.origin[2] - 0.01);
  });
  it("has no plates where there are none", () => {
    const scene = sceneWith(["A"], 1, () => [0, 0, 1]);
    const stage = new Stage();
    new Ground(stage, scene, floorOf(scene)).paint(palette());
    expect([stage.children[1]!.visible, stage.children[2]!.visible]).toEqual([false, false]);
  });
});
