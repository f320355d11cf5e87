// Street names, written on the streets for the bird's eye.

import { CanvasTexture, Mesh, MeshBasicMaterial, PlaneGeometry } from 'three';

import { KERB_M, SIDEWALK_M } from './ground.js';

const LETTER_M = 6.5;
const FROM_KERB_M = 4.8;
const APART_M = 45; // the same name is not written twice within this distance
const LEGIBLE_M = 170; // from so far a name can be read
const LARGEST = 2.4;
const INK = '#f8f4ea';

const ON_M = 22; // of the line that a name is written on: there one is on that street

/** Where the name of a street lies, beside the row of walls that stand on it. */
export function spot(row) {
  const [{ a, out }] = row;
  const right = [out[1], -out[0]];
  const along = ([x, z]) => x * right[0] + z * right[1];
  const start = Math.min(...row.map((wall) => along(wall.a)));
  const end = Math.max(...row.map((wall) => along(wall.b)));
  const depth = a[0] * out[0] + a[1] * out[1] + SIDEWALK_M + FROM_KERB_M;
  const at = (s) => [out[0] * depth + right[0] * s, out[1] * depth + right[1] * s];
  const yaw = Math.atan2(out[0], out[1]); // read from the street, facing the fronts
  return { middle: at((start + end) / 2), yaw, line: [at(start), at(end)] };
}

/** A name as `written`, in its `spot`. */
export function label(name, { middle: [x, z], yaw, line }, { texture, aspect }) {
  const plane = new Mesh(
    new PlaneGeometry(LETTER_M * aspect, LETTER_M).rotateX(-Math.PI / 2),
    new MeshBasicMaterial({ map: texture, transparent: true, opacity: 0, depthWrite: false, fog: false }),
  );
  plane.position.set(x, 0.05 - KERB_M, z);
  plane.rotation.y = yaw;
  plane.renderOrder = 1;
  plane.visible = false;
  plane.name = name;
  plane.userData.line = line;
  return plane;
}

/** Whether a street's name stands near [x, z] already. */
export function repeated(name, [x, z], others, apart = APART_M) {
  return others.some((other) => other.name === name
    && Math.hypot(other.position.x - x, other.position.z - z) < apart);
}

/** The name whose street runs by [x, z], or an empty word. */
export function nearestName(planes, [x, z]) {
  const far = planes.map(({ userData: { line: [a, b] } }) => {
    const way = [b[0] - a[0], b[1] - a[1]];
    const t = ((x - a[0]) * way[0] + (z - a[1]) * way[1]) / Math.max(1e-9, way[0] ** 2 + way[1] ** 2);
    const s = Math.max(0, Math.min(1, t));
    return Math.hypot(a[0] + s * way[0] - x, a[1] + s * way[1] - z);
  });
  const least = Math.min(...far, Infinity);
  return least < ON_M ? planes[far.indexOf(least)].name : '';
}

/** Fades all names in or out; seen from far, they are written larger. */
export function fade(planes, opacity, distance) {
  const size = Math.max(1, Math.min(LARGEST, distance / LEGIBLE_M));
  for (const plane of planes) {
    plane.scale.set(size, 1, size);
    plane.visible = opacity > 0.02;
    plane.material.opacity = 0.9 * opacity;
  }
}

/** Letters set apart by hair spaces, but where they join, as in Arabic, or stand on one another. */
export function spread(name) {
  const apart = /^[\p{Script=Latin}\p{Script=Greek}\p{Script=Cyrillic}\p{Script=Common}]*$/u.test(name);
  return apart ? [...name].join('\u200a') : name;
}

/** A name in letters: `{ texture, aspect }`. */
export function written(name) {
  const canvas = document.createElement('canvas');
  const context = canvas.getContext('2d');
  const font = '600 72px Garamond, Georgia, serif';
  context.font = font;
  const spaced = spread(name.toUpperCase());
  canvas.width = Math.min(2048, Math.ceil(context.measureText(spaced).width) + 48);
  canvas.height = 112;
  context.font = font;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillStyle = INK;
  context.strokeStyle = '#3a362f';
  context.lineWidth = 9;
  context.lineJoin = 'round';
  context.strokeText(spaced, canvas.width / 2, canvas.height / 2, canvas.width - 24);
  context.fillText(spaced, canvas.width / 2, canvas.height / 2, canvas.width - 24);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = 'srgb';
  texture.anisotropy = 8;
  return { texture, aspect: canvas.width / canvas.height };
}
