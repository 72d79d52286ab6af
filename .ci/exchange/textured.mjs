// Rooms with pictures on their floor, on one wall and on a ball of smooth facets, as OBJ.

import { writeFileSync } from "node:fs";
import { join } from "node:path";

import { png } from "./png.mjs";

const [AROUND, DOWN] = [36, 18];
const room = (tiles) => `v 0 0 0
v 0 0 3
v 0 2.5 0
v 0 2.5 3
v 3 0 0
v 3 0 3
v 3 2.5 0
v 3 2.5 3
v 1 2.49 1
v 2 2.49 1
v 2 2.49 2
v 1 2.49 2
vt 0 0
vt ${tiles} 0
vt ${tiles} ${tiles}
vt 0 ${tiles}
usemtl pictured
f 1/1 2/2 6/3 5/4
f 1/1 5/2 7/3 3/4
usemtl wall
f 3 7 8 4
f 1 3 4 2
f 5 6 8 7
usemtl lamp
f 9 10 11 12
usemtl pictured
s 1
`;
const [CORNERS, COORDINATES, CENTRE, RADIUS] = [12, 4, [1.5, 0.75, 1.2], 0.7];

const SIZE = 256;
const coded = (values) => values.map((x) => Math.max(0, Math.min(255, Math.round(x))));
// A cloudy pattern, 0..1, that repeats.
function cloud(x, y) {
  const turn = (2 * Math.PI) / SIZE;
  return 0.5 + 0.2 * Math.sin(turn * (x + 2 * y)) + 0.2 * Math.cos(turn * (2 * x - y)) + 0.1 * Math.sin(turn * 3 * (x + y));
}
// What compression leaves of an even colour: a few codes up and down.
const grain = (x, y, k) => ((x * 7 + y * 13 + k * 5 + ((x * y) % 11)) % 7) - 3;

const PICTURES = {
  // Blue and yellow squares, one corner reddish, so that a picture laid on wrongly is seen; with soft edges, as Blender
  // mixes neighbouring texels by their codes, others by their light.
  ordinary: {
    tiles: 1,
    colour: (x, y) => {
      const wave = Math.sin((Math.PI * (x + 0.5)) / 32) * Math.sin((Math.PI * (y + 0.5)) / 32);
      const share = Math.max(0, Math.min(1, 0.5 + 2 * wave));
      const [light, dark] = [[220, x < 64 && y < 64 ? 80 : 200, 120], [60, 60, 160]];
      return coded(light.map((c, k) => c * share + dark[k] * (1 - share)));
    },
  },
  dark: { tiles: 1, colour: (x, y) => coded([40, 28, 20].map((c) => c * (0.3 + cloud(x, y)))) },
  saturated: { tiles: 1, colour: (x, y) => coded([255, 25, 0].map((c, k) => c + grain(x, y, k))) },
  tiled: {
    tiles: 6,
    colour: (x, y) => {
      const joint = Math.max(0, 1 - Math.min(x, y, SIZE - x, SIZE - y) / 8);
      return coded([190, 130, 90].map((c) => c * (0.7 + 0.4 * cloud(x, y)) * (1 - joint) + 90 * joint));
    },
  },
};
export const NAMES = Object.keys(PICTURES);

// Vertices row by row, the poles and the seam as often as they have coordinates.
function ball() {
  const lines = [];
  for (let row = 0; row <= DOWN; row += 1) {
    for (let column = 0; column <= AROUND; column += 1) {
      const [tilt, turn] = [(Math.PI * row) / DOWN, (2 * Math.PI * column) / AROUND];
      const out = [Math.sin(tilt) * Math.cos(turn), Math.cos(tilt), Math.sin(tilt) * Math.sin(turn)];
      lines.push(`v ${out.map((x, axis) => (CENTRE[axis] + RADIUS * x).toFixed(6)).join(" ")}`);
      lines.push(`vt ${(2 * column) / AROUND} ${1 - row / DOWN}`);
    }
  }
  const at = (row, column) => {
    const number = row * (AROUND + 1) + column + 1;
    return `${CORNERS + number}/${COORDINATES + number}`;
  };
  for (let row = 0; row < DOWN; row += 1) {
    for (let column = 0; column < AROUND; column += 1) {
      const [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
      if (row > 0) lines.push(`f ${a} ${b} ${c}`);
      if (row < DOWN - 1) lines.push(`f ${a} ${c} ${d}`);
    }
  }
  return `${lines.join("\n")}\n`;
}

// Writes the room with a picture of this name into a directory and returns the path of its OBJ.
export function writeTextured(directory, name) {
  const place = (ending) => join(directory, `${name}${ending}`);
  const { tiles, colour } = PICTURES[name];
  writeFileSync(place("-picture.png"), png(SIZE, colour));
  const pictured = `newmtl pictured\nKd 0.9 0.9 0.9\nmap_Kd ${name}-picture.png\n`;
  writeFileSync(place(".mtl"), `${pictured}newmtl wall\nKd 0.7 0.7 0.7\nnewmtl lamp\nKd 0 0 0\nKe 20 18 15\n`);
  writeFileSync(place(".obj"), `mtllib ${name}.mtl\n${room(tiles)}${ball()}`);
  return place(".obj");
}
