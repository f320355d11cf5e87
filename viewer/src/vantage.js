// Good places to see the city from, told by what stands where.

import { MathUtils, Raycaster, Vector3 } from 'three';

import { ELEVATION_RAD } from './bird.js';
import { contains } from './outline.js';
import { frontOf } from './survey.js';
import { along, before, rows } from './walker.js';

const FARTHEST_M = 70; // to step back from a front
const NEAREST_M = 2.5;
const BACK_M = 1; // to what stands behind one
const ABOUT_M = 600; // of a place, a large city goes on beyond
const MOST_WALLS = 300; // are looked at to choose a view

const ray = new Raycaster();
ray.firstHitOnly = true;

/** Where a walk begins: along the row of a block that shows most photographs. */
export function homeIn(city, block, otherwise) {
  const walls = city.records.of(block).flatMap(({ shape }) => shape?.walls ?? []).filter((wall) => clear(city, wall));
  const [best] = rows(walls.filter(({ kind }) => kind === 'own'));
  const row = best ?? rows(walls)[0];
  return row ? along(row, 0.7 * room(city, row[0])) : otherwise;
}

/** Where to stand to see a building: by its model, or else by its footprint; null if neither is known. */
export function poseBefore(city, found, lens) {
  const wall = found.shape ? frontFor(city, found.shape) : city.wallOf(found);
  return wall && before(wall, room(city, wall), lens);
}

/** The wall that a building shows to the street. */
export function frontFor(city, shape) {
  return frontOf(shape, (wall) => clear(city, wall));
}

/** The side from which most of the photographs can be seen; of equals, the one ahead. */
export function bestAzimuth(city, yaw) {
  const walls = [...city.buildings.values()].flatMap(({ shape }) => shape?.walls ?? []);
  const fronts = walls.filter(({ kind }) => kind === 'own').slice(0, MOST_WALLS);
  const sides = Array.from({ length: 16 }, (_, i) => (i * Math.PI) / 8);
  const worth = sides.map((azimuth) => {
    const sum = fronts.reduce((total, wall) => total + seen(city, wall, azimuth), 0);
    return sum * (1 + 0.1 * Math.cos(azimuth - yaw));
  });
  return sides[worth.indexOf(Math.max(...worth))];
}

/** Points that the bird's view has to hold: all about a place, whether its models have come or not. */
export function corners(city, { min, max }, { x, z }) {
  const points = [];
  const upright = ([u, v], bottom, top) => points.push(new Vector3(u, bottom, v), new Vector3(u, top, v));
  for (const block of city.about([x, z], ABOUT_M)) {
    const known = city.records.of(block);
    for (const found of known) {
      for (const { a, top, bottom } of found.shape?.walls ?? [city.wallOf(found)].filter(Boolean)) upright(a, bottom, top);
    }
    if (known.length) continue; // else as high as it may be
    for (const ring of block.outline_m ?? []) for (const at of city.placed(block, ring)) upright(at, 0, block.top_m ?? 0);
  }
  return points.length ? points : [min.clone(), max.clone()];
}

/** How far one can step back from a wall. */
function room(city, wall) {
  const out = new Vector3(wall.out[0], 0, wall.out[1]);
  ray.set(off(wall, 1.5), out);
  const [hit] = ray.intersectObjects([...city.walls], false);
  return hit ? MathUtils.clamp(hit.distance - BACK_M, NEAREST_M, FARTHEST_M) : FARTHEST_M;
}

/** Whether the ground before a wall is free. */
function clear(city, { a, b, out }) {
  const at = [(a[0] + b[0]) / 2 + 2 * out[0], (a[1] + b[1]) / 2 + 2 * out[1]];
  return !city.near(at, 0).some(({ shape }) => shape?.roofs.some((roof) => contains(roof, at)));
}

/** How much of a wall is seen from far and above; 0 where something hides it. */
function seen(city, wall, azimuth) {
  const { a, b, out, top } = wall;
  const towards = new Vector3(Math.sin(azimuth), 0, Math.cos(azimuth));
  const facing = out[0] * towards.x + out[1] * towards.z;
  if (facing <= 0.1) return 0;
  ray.set(off(wall, 0.6 * top), towards.setY(Math.tan(ELEVATION_RAD)).normalize());
  if (ray.intersectObjects([...city.walls], false).length) return 0;
  return facing * Math.min(20, Math.hypot(b[0] - a[0], b[1] - a[1])) * Math.min(40, top);
}

/** A point just before the middle of a wall. */
function off({ a, b, out }, height) {
  return new Vector3((a[0] + b[0]) / 2 + 0.3 * out[0], height, (a[1] + b[1]) / 2 + 0.3 * out[1]);
}
