// Makes large surfaces for measurements: cuts every triangle of a binary STL into n x n equal ones.
// usage: node refine_stl.mjs IN.stl OUT.stl N
import { readFileSync, writeFileSync } from "node:fs";

const [input, output, parts] = process.argv.slice(2);
const n = Number(parts);
const k_head = 84, k_record = 50; // bytes of the header with the number, of a triangle
const bytes = readFileSync(input);
const n_in = bytes.readUInt32LE(80);
if (bytes.length !== k_head + k_record * n_in || !(Number.isInteger(n) && n > 0)) throw new Error(`usage: node refine_stl.mjs IN.stl (binary) OUT.stl N`);
const result = Buffer.alloc(k_head + k_record * n_in * n * n);
result.writeUInt32LE(n_in * n * n, 80);
let at = k_head;
for (let t = 0; t < n_in; ++t) {
  const from = k_head + k_record * t;
  const corner = [0, 1, 2].map((c) => [0, 1, 2].map((axis) => bytes.readFloatLE(from + 12 + 12 * c + 4 * axis)));
  // Points on an edge come from its ends in one order, whichever triangle asks: neighbours get the same bytes.
  const order = [0, 1, 2].sort((a, b) => corner[a][0] - corner[b][0] || corner[a][1] - corner[b][1] || corner[a][2] - corner[b][2]);
  const point = (i, j) => {
    const share = [n - i - j, i, j];
    const used = order.filter((c) => share[c] > 0);
    return [0, 1, 2].map((axis) => (used.length === 1 ? corner[used[0]][axis] : used.reduce((sum, c) => sum + share[c] * corner[c][axis], 0) / n));
  };
  const add = (...points) => {
    for (let k = 0; k < 3; ++k) for (let axis = 0; axis < 3; ++axis) result.writeFloatLE(points[k][axis], at + 12 + 12 * k + 4 * axis);
    at += k_record;
  };
  for (let i = 0; i < n; ++i)
    for (let j = 0; i + j < n; ++j) {
      add(point(i, j), point(i + 1, j), point(i, j + 1));
      if (i + j + 1 < n) add(point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
    }
}
writeFileSync(output, result);
