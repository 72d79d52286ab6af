// Tries exported files in three.js, in Chromium: node three.mjs [--screenshots] DIRECTORY
// The directory is what prepare.mjs has made. The mesh must look like our picture of it, and
// the lightmap's mesh, with the map laid on, must send the radiance that our picture holds. One line a
// check; exit status 1 if any fails. three.js is installed once into $THREE_DIR, by default ~/.cache/three.

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { homedir } from "node:os";
import { extname, join, normalize, resolve } from "node:path";

import { Browser } from "../browser/chromium.mjs";
import { must } from "../browser/components.mjs";

const PACKAGE = "three@0.187.0";
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".json": "application/json", ".png": "image/png" };

// Most pixels, as a share, that may be more than 4 of 255 from ours.
const FAR = 0.01;

// Most that radiance may differ, on average, as a share of its mean. Standard materials keep some hundredths of the
// light for their gloss.
const DIFFUSE = 0.01;
const GLOSSY = 0.03;

// Least correlation of pictures by the exposed map and the linear one, which a map laid on wrongly has not.
const AGREEMENT = 0.8;

function library() {
  const directory = process.env.THREE_DIR ?? join(homedir(), ".cache", "three");
  const found = join(directory, "node_modules", "three");
  if (!existsSync(found)) {
    mkdirSync(directory, { recursive: true });
    const install = ["install", "--silent", "--no-audit", "--no-fund", "--prefix", directory];
    execFileSync("npm", [...install, PACKAGE], { stdio: ["ignore", "ignore", "inherit"] });
  }
  return found;
}

// Modules are not read from file: addresses, so the files are served to this machine alone.
function serve(roots) {
  const server = createServer((request, response) => {
    const [, root, ...rest] = decodeURIComponent(new URL(request.url, "http://x").pathname).split("/");
    const path = join(roots[root] ?? "/nowhere", normalize(rest.join("/")));
    if (!existsSync(path)) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { "content-type": TYPES[extname(path)] ?? "application/octet-stream" });
    response.end(readFileSync(path));
  });
  return new Promise((done) => server.listen(0, "127.0.0.1", () => done(server)));
}

// What a GLB says of its primitives, in the order of its nodes.
function primitives(path) {
  const bytes = readFileSync(path);
  const json = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString());
  const below = (index) => [json.nodes[index], ...(json.nodes[index].children ?? []).flatMap(below)];
  const nodes = json.scenes[json.scene].nodes.flatMap(below).filter(({ mesh }) => mesh !== undefined);
  return nodes.flatMap(({ mesh }) => json.meshes[mesh].primitives).map(({ attributes, indices }) => ({
    vertices: json.accessors[attributes.POSITION].count,
    corners: json.accessors[indices].count,
    attributes: Object.keys(attributes).length,
  }));
}

function counted(meshes, path) {
  const expected = primitives(path);
  must(meshes.length === expected.length, `${meshes.length} meshes of ${expected.length}`);
  meshes.forEach((mesh, i) => {
    for (const key of ["vertices", "corners"]) must(mesh[key] === expected[i][key], `${key}: ${mesh[key]} of ${expected[i][key]}`);
    must(mesh.attributes.length === expected[i].attributes, `attributes ${mesh.attributes}`);
  });
}

async function vertices(page, scene, directory) {
  const { meshes, far, plain, shades } = await page.evaluate((scene) => vertexLight(scene), scene);
  counted(meshes, join(directory, `${scene.name}.glb`));
  for (const { attributes, material, mapped } of meshes) {
    for (const name of ["color", "_radiosity"]) must(attributes.includes(name), `no ${name} in ${attributes}`);
    must(material === "MeshBasicMaterial", material);
    must(mapped === attributes.includes("uv"), "textures and their coordinates do not agree");
  }
  must(meshes.some(({ mapped }) => mapped) === Boolean(scene.textured), "a texture is missing");
  must(shades > 200, `only ${shades} colours`);
  const percent = (share) => `${(100 * share).toFixed(2)} %`;
  must(far < FAR, `${percent(far)} of the pixels are not those of our picture`);
  return `all but ${percent(far)} of the pixels as ours, with 4 samples all but ${percent(plain)}`;
}

async function lightmap(page, scene, directory) {
  const { meshes, glossy, diffuse, shades, agreement } = await page.evaluate((scene) => mapLight(scene), scene);
  counted(meshes, join(directory, `${scene.name}.lightmap.glb`));
  for (const { attributes, material } of meshes) {
    must(attributes.includes("uv1"), `no uv1 in ${attributes}`);
    must(material === "MeshStandardMaterial", material);
  }
  must(shades > 200, `only ${shades} colours`);
  const percent = (share) => `${(100 * share).toFixed(2)} %`;
  must(glossy < GLOSSY && diffuse < DIFFUSE, `radiance ${percent(glossy)}, diffuse ${percent(diffuse)} from our picture`);
  must(agreement > AGREEMENT, `the exposed map follows the linear one by ${agreement.toFixed(3)} only`);
  return `lightmap within ${percent(glossy)}, on diffuse materials ${percent(diffuse)}, exposed one follows by ${agreement.toFixed(3)}`;
}

async function check(page, scene, directory, takesPictures) {
  const done = [];
  for (const [what, act] of Object.entries({ vertices, lightmap })) {
    try {
      done.push(await act(page, scene, directory));
    } finally {
      if (takesPictures) writeFileSync(join(directory, `${scene.name}-three-${what}.png`), await page.screenshot());
    }
  }
  must(page.complaints.length === 0, page.complaints.join("\n  "));
  return done.join(", ");
}

const takesPictures = process.argv[2] === "--screenshots";
const directory = process.argv[takesPictures ? 3 : 2];
if (!directory) {
  console.error("usage: node three.mjs [--screenshots] DIRECTORY");
  process.exit(2);
}
const server = await serve({ three: library(), page: import.meta.dirname, files: resolve(directory) });
const browser = new Browser();
let allGood = true;
for (const scene of JSON.parse(readFileSync(join(directory, "scenes.json")))) {
  try {
    const address = new URL(`http://127.0.0.1:${server.address().port}/page/three.html`);
    const page = await browser.open(address, { width: scene.width, height: scene.height });
    console.log(`${scene.name}: ${await check(page, scene, directory, takesPictures)}`);
    await page.close();
  } catch (error) {
    console.error(`${scene.name}: ${error.message}`);
    allGood = false;
  }
}
await browser.close();
server.close();
process.exit(allGood ? 0 : 1);
