// Makes what other programs are tried with: node prepare.mjs RADIOSITY DIRECTORY
// Scenes solved into meshes and lightmaps, our own pictures of them, and scenes.json with their cameras.

import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { writeCutOut } from "./cutout.mjs";
import { NAMES, writeTextured } from "./textured.mjs";

const [program, directory] = process.argv.slice(2);
if (!directory) {
  console.error("usage: node prepare.mjs RADIOSITY DIRECTORY");
  process.exit(2);
}
mkdirSync(directory, { recursive: true });
const SCENES = [
  { name: "cornell-box", file: "scenes/cornell-box.obj", eye: [0.278, 0.273, -0.75], target: [0.278, 0.26, 0.28], fov: 40 },
  { name: "two-rooms", file: "scenes/two-rooms.obj", eye: [0.5, 1.6, 0.5], target: [3, 1, 2.5], fov: 60 },
  ...NAMES.map((name) => ({ name, file: writeTextured(directory, name), textured: true, eye: [0.2, 1.7, 2.8], target: [1.7, 0.7, 1.0], fov: 60 })),
  { name: "cut-out", file: writeCutOut(directory, "cut-out"), textured: true, holes: true, eye: [0.3, 1.7, 2.9], target: [1.7, 0.8, 0.6], fov: 60 },
].map((scene) => ({ ...scene, width: 480, height: 360 }));

// The exposure value that a GLB's colours were made with; a picture from another eye would find its own.
function exposure(path) {
  const bytes = readFileSync(path);
  return JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString()).asset.extras.exposure.ev;
}

const run = (...options) => execFileSync(program, options.map(String), { stdio: ["ignore", "ignore", "inherit"] });
for (const { name, file, eye, target, fov, width, height } of SCENES) {
  const place = (ending) => join(directory, `${name}${ending}`);
  run("solve", file, "--quality", "draft", "-q", "-o", place(".glb"), "--lightmap", 1024);
  const view = ["--eye", eye, "--target", target, "--fov", fov, "--size", `${width}x${height}`];
  run("render", place(".glb"), "-q", "-o", place(".png"), ...view, "--exposure", exposure(place(".glb")));
  run("render", place(".glb"), "-q", "-o", place(".exr"), ...view);
}
writeFileSync(join(directory, "scenes.json"), JSON.stringify(SCENES));
console.log(`${SCENES.length} scenes in ${directory}`);
