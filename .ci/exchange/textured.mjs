// A room with a chequered floor and a ball of smooth facets, as OBJ.

import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { crc32, deflateSync } from "node:zlib";

const [AROUND, DOWN] = [24, 12];
const MATERIALS = `newmtl floor
Kd 0.8 0.8 0.8
map_Kd chequered.png
newmtl wall
Kd 0.7 0.7 0.7
newmtl ball
Kd 0.8 0.4 0.3
newmtl lamp
Kd 0 0 0
Ke 20 18 15
`;
const ROOM = `v 0 0 0
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
vt 2 0
vt 2 2
vt 0 2
usemtl floor
f 1/1 2/2 6/3 5/4
usemtl wall
f 3 7 8 4
f 1 5 7 3
f 1 3 4 2
f 5 6 8 7
usemtl lamp
f 9 10 11 12
usemtl ball
s 1
`;
const [CORNERS, CENTRE, RADIUS] = [12, [1.5, 0.75, 1.2], 0.7];

// Blue and yellow squares, one corner red, so that a picture laid on wrongly is seen.
function chequered(x, y) {
  if (x < 8 && y < 8) return [230, 30, 30];
  return ((x >> 3) + (y >> 3)) % 2 ? [220, 200, 120] : [60, 60, 160];
}

function png(size, colour) {
  const rows = [];
  for (let y = 0; y < size; y += 1) {
    rows.push(0);
    for (let x = 0; x < size; x += 1) rows.push(...colour(x, y));
  }
  const header = Buffer.alloc(13);
  header.writeUInt32BE(size, 0);
  header.writeUInt32BE(size, 4);
  header.set([8, 2], 8); // bits a channel, RGB
  const chunk = (kind, data) => {
    const body = Buffer.concat([Buffer.from(kind), data]);
    const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
    length.writeUInt32BE(data.length);
    sum.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, sum]);
  };
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  return Buffer.concat([signature, chunk("IHDR", header), chunk("IDAT", deflateSync(Buffer.from(rows))), chunk("IEND", Buffer.alloc(0))]);
}

// Vertices row by row, the poles as often as there are columns.
function ball() {
  const lines = [];
  for (let row = 0; row <= DOWN; row += 1) {
    for (let column = 0; column < AROUND; column += 1) {
      const [tilt, turn] = [(Math.PI * row) / DOWN, (2 * Math.PI * column) / AROUND];
      const out = [Math.sin(tilt) * Math.cos(turn), Math.cos(tilt), Math.sin(tilt) * Math.sin(turn)];
      lines.push(`v ${out.map((x, axis) => (CENTRE[axis] + RADIUS * x).toFixed(6)).join(" ")}`);
    }
  }
  const at = (row, column) => CORNERS + 1 + row * AROUND + (column % AROUND);
  for (let row = 0; row < DOWN; row += 1) {
    for (let column = 0; column < AROUND; column += 1) {
      const [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
      if (row > 0) lines.push(`f ${a} ${b} ${c}`);
      if (row < DOWN - 1) lines.push(`f ${a} ${c} ${d}`);
    }
  }
  return `${lines.join("\n")}\n`;
}

// Writes the scene into a directory and returns the path of its OBJ.
export function writeTextured(directory) {
  const place = (name) => join(directory, name);
  writeFileSync(place("chequered.png"), png(64, chequered));
  writeFileSync(place("textured.mtl"), MATERIALS);
  writeFileSync(place("textured.obj"), `mtllib textured.mtl\n${ROOM}${ball()}`);
  return place("textured.obj");
}
