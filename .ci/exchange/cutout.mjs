// A room with a screen of leaves before its wall, as glTF: a picture with holes, laid on mirrored, and one of few
// texels that are not mixed.

import { writeFileSync } from "node:fs";
import { join } from "node:path";

import { png } from "./png.mjs";

const SIZE = 256;

// A leaf, of which the alpha alone says where it ends.
function leaf(x, y) {
  const [across, along] = [(x + 0.5) / SIZE - 0.5, (y + 0.5) / SIZE];
  const vein = Math.max(0, 1 - Math.abs(across) * 25);
  const edge = 0.42 * Math.sin(Math.PI * along) * (0.85 + 0.15 * along) - Math.abs(across);
  const alpha = Math.max(0, Math.min(255, Math.round(127.5 + 2000 * edge)));
  return [70 + 60 * vein, 120 + 50 * vein, 40 + 30 * vein, alpha].map(Math.round);
}

const tile = (x, y) => ((x + y) % 2 ? [180, 160, 140, 255] : [150, 120, 110, 255]);

// Corners of a quadrangle, counter-clockwise, and how often a picture lies on it.
const QUADS = [
  { material: 0, corners: [[0, 0, 3], [3, 0, 3], [3, 0, 0], [0, 0, 0]], times: [1, 1] },
  { material: 1, corners: [[0, 0, 0], [3, 0, 0], [3, 2.5, 0], [0, 2.5, 0]], times: [1, 1] },
  { material: 1, corners: [[3, 0, 0], [3, 0, 3], [3, 2.5, 3], [3, 2.5, 0]], times: [1, 1] },
  { material: 1, corners: [[0, 2.5, 0], [3, 2.5, 0], [3, 2.5, 3], [0, 2.5, 3]], times: [1, 1] },
  { material: 2, corners: [[0.4, 0.1, 0.6], [2.6, 0.1, 0.6], [2.6, 2.1, 0.6], [0.4, 2.1, 0.6]], times: [3, 2] },
  { material: 3, corners: [[1, 2.49, 1], [2, 2.49, 1], [2, 2.49, 2], [1, 2.49, 2]], times: [1, 1] },
];

// Writes the scene into a directory and returns the path of its glTF.
export function writeCutOut(directory, name) {
  const place = (ending) => join(directory, `${name}${ending}`);
  writeFileSync(place("-leaf.png"), png(SIZE, leaf, 4));
  writeFileSync(place("-tile.png"), png(8, tile, 4));
  const [positions, uvs, indices] = [[], [], []];
  const primitives = QUADS.map(({ material, corners, times: [u, v] }, quad) => {
    positions.push(corners.flat());
    uvs.push([0, v, u, v, u, 0, 0, 0]);
    indices.push([0, 1, 2, 0, 2, 3]);
    const at = 3 * quad;
    return { attributes: { POSITION: at, TEXCOORD_0: at + 1 }, indices: at + 2, material };
  });
  const [bufferViews, accessors, parts] = [[], [], []];
  let byteOffset = 0;
  const add = (array, type, count, more) => {
    const bytes = Buffer.from(array.buffer);
    bufferViews.push({ buffer: 0, byteOffset, byteLength: bytes.length });
    const componentType = array instanceof Float32Array ? 5126 : 5125;
    accessors.push({ bufferView: bufferViews.length - 1, componentType, count, type, ...more });
    parts.push(bytes);
    byteOffset += bytes.length;
  };
  QUADS.forEach((_, quad) => {
    const axis = (k) => [0, 1, 2, 3].map((corner) => positions[quad][3 * corner + k]);
    const bounds = (pick) => [0, 1, 2].map((k) => Math.fround(pick(...axis(k))));
    add(new Float32Array(positions[quad]), "VEC3", 4, { min: bounds(Math.min), max: bounds(Math.max) });
    add(new Float32Array(uvs[quad]), "VEC2", 4);
    add(new Uint32Array(indices[quad]), "SCALAR", 6);
  });
  const plain = (colour) => ({ pbrMetallicRoughness: { baseColorFactor: colour, metallicFactor: 0 } });
  const pictured = (index) => ({ pbrMetallicRoughness: { baseColorTexture: { index }, metallicFactor: 0 } });
  const document = {
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ name: "room", mesh: 0 }],
    meshes: [{ primitives }],
    materials: [
      { name: "floor", ...pictured(1) },
      { name: "wall", ...plain([0.7, 0.7, 0.7, 1]) },
      { name: "leaf", alphaMode: "MASK", alphaCutoff: 0.5, ...pictured(0) },
      {
        name: "lamp",
        emissiveFactor: [1, 0.9, 0.75],
        extensions: { KHR_materials_emissive_strength: { emissiveStrength: 20 } },
        ...plain([0, 0, 0, 1]),
      },
    ],
    textures: [{ source: 0, sampler: 0 }, { source: 1, sampler: 1 }],
    images: [{ uri: `${name}-leaf.png` }, { uri: `${name}-tile.png` }],
    samplers: [{ wrapS: 33648, wrapT: 33648 }, { magFilter: 9728 }],
    extensionsUsed: ["KHR_materials_emissive_strength"],
    accessors,
    bufferViews,
    buffers: [{ uri: `data:application/octet-stream;base64,${Buffer.concat(parts).toString("base64")}`, byteLength: byteOffset }],
  };
  writeFileSync(place(".gltf"), JSON.stringify(document));
  return place(".gltf");
}
