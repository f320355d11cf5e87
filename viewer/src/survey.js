// What a mesh says of each building: its walls, its roofs, its height.

import { Vector3 } from 'three';

const STEEP = 0.5; // a face whose normal points up by more is roof, not wall
const SAME_PLANE_M = 0.05;
const RANK = { plain: 0, copied: 1, own: 2 };

/**
 * `codeAt(u, v)` tells the mesh's evidence, see `reader`. Map from feature number to `{ walls, roofs, top, roof }` (heights of the two last), in the frame of the world.
 *
 * A wall is `{ a, b, out, bottom, top, kind }`: the ends of its foot as [x, z], seen from
 * outside a lies on the left; `out` is its outward normal as [x, z]; `kind` is 'own' where
 * it wears its own photograph, else 'copied' or 'plain'. A roof is three [x, z].
 */
export function survey(mesh, codeAt) {
  const found = new Map();
  const { position, uv, _feature_id_0: features } = mesh.geometry.attributes;
  if (!features) return found;
  const index = mesh.geometry.index;
  const count = index ? index.count : position.count;
  const corners = [new Vector3(), new Vector3(), new Vector3()];
  const normal = new Vector3();
  const other = new Vector3();
  for (let i = 0; i < count; i += 3) {
    const rows = [0, 1, 2].map((k) => (index ? index.getX(i + k) : i + k));
    corners.forEach((c, k) => c.fromBufferAttribute(position, rows[k]).applyMatrix4(mesh.matrixWorld));
    normal.subVectors(corners[1], corners[0]).cross(other.subVectors(corners[2], corners[0]));
    if (normal.lengthSq() < 1e-12) continue;
    normal.normalize();
    const feature = features.getX(rows[0]);
    if (!found.has(feature)) found.set(feature, { planes: new Map(), roofs: [], top: 0, roof: 0 });
    const shape = found.get(feature);
    shape.top = Math.max(shape.top, ...corners.map((c) => c.y));
    if (normal.y > STEEP) {
      shape.roofs.push(corners.map((c) => [c.x, c.z]));
      shape.roof = Math.max(shape.roof, corners[0].y);
    }
    if (Math.abs(normal.y) <= STEEP) addWall(shape.planes, corners, normal, kindOf(codeAt, uv, rows));
  }
  for (const [feature, { planes, roofs, top, roof }] of found) {
    found.set(feature, { walls: [...planes.values()].map(footOf), roofs, top, roof });
  }
  return found;
}

/** What a triangle wears, told by the evidence at a few of its texels. */
function kindOf(codeAt, uv, rows) {
  if (!uv) return 'plain';
  const codes = [[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4], [3, 3, 1], [1, 3, 3]].map((weights) => {
    const sum = weights[0] + weights[1] + weights[2];
    const at = (get) => rows.reduce((total, row, k) => total + get.call(uv, row) * weights[k], 0) / sum;
    return codeAt(at(uv.getX), at(uv.getY));
  });
  if (codes.some((code) => (code >= 1 && code <= 4) || code === 7)) return 'own';
  return codes.includes(5) ? 'copied' : 'plain';
}

/** Joins triangles that share a plane into one wall. */
function addWall(planes, corners, normal, kind) {
  const length = Math.hypot(normal.x, normal.z);
  const out = [normal.x / length, normal.z / length];
  const right = [out[1], -out[0]]; // seen from outside
  const depth = corners[0].x * out[0] + corners[0].z * out[1];
  const key = [out[0] * 100, out[1] * 100, depth / SAME_PLANE_M].map(Math.round).join(); // -0 is 0
  const wall = planes.get(key) ?? {
    out, right, depth, from: Infinity, to: -Infinity, bottom: Infinity, top: -Infinity, kind: 'plain',
  };
  for (const c of corners) {
    const along = c.x * right[0] + c.z * right[1];
    wall.from = Math.min(wall.from, along);
    wall.to = Math.max(wall.to, along);
    wall.bottom = Math.min(wall.bottom, c.y);
    wall.top = Math.max(wall.top, c.y);
  }
  if (RANK[kind] > RANK[wall.kind]) wall.kind = kind;
  planes.set(key, wall);
}

function footOf({ out, right, depth, from, to, bottom, top, kind }) {
  const at = (along) => [out[0] * depth + right[0] * along, out[1] * depth + right[1] * along];
  return { a: at(from), b: at(to), out, bottom, top, kind };
}

/** The wall to stand before: the widest with its own photograph, if it is free. */
export function frontOf(shape, clear = () => true) {
  const width = ({ a, b }) => Math.hypot(b[0] - a[0], b[1] - a[1]);
  const rank = (wall) => width(wall) + 1e3 * RANK[wall.kind] + (clear(wall) ? 1e4 : 0);
  return shape.walls.reduce((best, wall) => (!best || rank(wall) > rank(best) ? wall : best), null);
}
