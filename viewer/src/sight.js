// What stands before one's eyes, and what it is called.

import { Raycaster, Vector2, Vector3 } from 'three';

import { ASSUMED, nameOfCode } from './evidence.js';
import { codeAt } from './model.js';
import { nameOf } from './words.js';

const FAR_M = 80; // beyond, a front is not faced but seen
const LEVEL_RAD = 0.09; // of the look that tells what is faced: over a car, into the first storey

const ray = new Raycaster();
ray.firstHitOnly = true;

/** The building under a point of the view, both coordinates from -1 to 1; or null. */
export function picked(city, camera, x, y) {
  ray.far = Infinity;
  ray.setFromCamera(new Vector2(x, y), camera);
  const hit = first(city);
  if (!hit) return null;
  const { found: { block, record } } = hit;
  const code = hit.uv ? codeAt(hit.object, hit.uv, city.keys) : ASSUMED;
  return { ...record, block: block.block, distance: hit.distance, evidence: nameOfCode(code) };
}

/** The building that eyes at `position`, turned by `yaw`, face, and how far off; or null. */
export function faced(city, position, yaw) {
  const level = Math.cos(LEVEL_RAD);
  ray.far = FAR_M;
  ray.set(position, new Vector3(-Math.sin(yaw) * level, Math.sin(LEVEL_RAD), -Math.cos(yaw) * level));
  const hit = first(city);
  return hit && { ...hit.found, distance: hit.distance };
}

/** `Facing 115 West 40 Street, 12 m`; where nothing is faced, the street that is looked along. */
export function where(hit, street) {
  if (hit) return `Facing ${nameOf(hit.record)}, ${hit.distance.toFixed(0)} m`;
  return street ? `On ${street}` : '';
}

function first(city) {
  const [hit] = ray.intersectObjects([...city.walls], false);
  const found = hit && city.buildingAt(hit.object, hit.face);
  return found ? Object.assign(hit, { found }) : null;
}
