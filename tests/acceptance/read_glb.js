// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What gltf-validator says of a GLB and where three's GLTFLoader puts its nodes, as JSON:
//   { errors, warnings, messages, times, nodes: { name: [[x, y, z, largest scale] of each time] } }.
//   node read_glb.mjs FILE RATE FRAMES, under that name: it is a module
import fs from "node:fs";
import { AnimationMixer, LoopOnce, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import validator from "gltf-validator";

globalThis.self = globalThis;
const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
const [rate, frames] = process.argv.slice(3).map(Number);
const { issues } = await validator.validateBytes(bytes, { maxIssues: 10 });

const gltf = await new GLTFLoader().parseAsync(bytes.buffer, "");
const mixer = new AnimationMixer(gltf.scene);
for (const clip of gltf.animations) {
  const action = mixer.clipAction(clip).setLoop(LoopOnce);
  action.clampWhenFinished = true; // else the last frame is the first one again
  action.play();
}
const nodes = {};
for (let frame = 0; frame < frames; ++frame) {
  mixer.setTime(Math.fround(frame / rate));
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.traverse((node) => {
    if (!node.userData.name && !node.name) return;
    const position = node.getWorldPosition(new Vector3()).toArray();
    (nodes[node.userData.name || node.name] ??= []).push([...position, Math.max(...node.scale.toArray())]);
  });
}
process.stdout.write(
  JSON.stringify({
    errors: issues.numErrors,
    warnings: issues.numWarnings,
    messages: issues.messages.map((message) => `${message.code} ${message.pointer}`),
    nodes,
  }),
);
