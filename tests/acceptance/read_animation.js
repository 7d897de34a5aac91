// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Where three's BVHLoader puts the joints of a BVH file, as JSON: { names, frames: [[[x, y, z] of each joint]] }.
//   node read_animation.mjs FILE, under that name: it is a module
import fs from "node:fs";
import { AnimationMixer, Group, LoopOnce, Vector3 } from "three";
import { BVHLoader } from "three/addons/loaders/BVHLoader.js";

const { skeleton, clip } = new BVHLoader().parse(fs.readFileSync(process.argv[2], "utf8"));
const root = new Group();
root.add(skeleton.bones[0]);
const mixer = new AnimationMixer(root);
const action = mixer.clipAction(clip, skeleton.bones[0]).setLoop(LoopOnce);
action.clampWhenFinished = true; // else the last frame is the first one again
action.play();

const times = clip.tracks[0].times;
const frames = Array.from(times, (time) => {
  mixer.setTime(time);
  root.updateMatrixWorld(true);
  return skeleton.bones.map((bone) => bone.getWorldPosition(new Vector3()).toArray());
});
process.stdout.write(JSON.stringify({ names: skeleton.bones.map((bone) => bone.name), frames }));
