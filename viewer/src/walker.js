// The walker's eyes: where they are and where they look.

import { MathUtils, Vector3 } from 'three';

import { EYE_M, eased, walk } from './body.js';
import { KERB_M } from './ground.js';
import { holding } from './lens.js';
import { contains } from './outline.js';

const WALK_M_S = 2.6; // brisk: a block is long
const RUN_M_S = 8;
const TURN_RAD_S = 1.7;
const LOOK_RAD_PX = 0.0032;
const STEEPEST = MathUtils.degToRad(85);
const NEAREST_M = 8; // to a front, where there is room
const WIDEST_DEG = 100; // of a view, where there is none
const AROUND = 1.12; // of a front, so that its edges are seen
const SAME_LINE_M = 3;
const WIDE_M = 12;
const REACH_M = 220; // no walking further than this from the nearest block

export class Walker {
  constructor() {
    this.feet = new Vector3();
    this.eye = EYE_M; // above y = 0
    this.yaw = 0; // 0 looks north, grows to the left
    this.pitch = 0;
    this.raised = []; // outlines of [x, z] where the ground is a sidewalk
    this.bounds = null; // Box3 of the city
  }

  step(dt, input, walls) {
    const { look } = input.taken();
    this.yaw += look[0] * LOOK_RAD_PX + input.turn * TURN_RAD_S * dt;
    this.pitch = MathUtils.clamp(this.pitch + look[1] * LOOK_RAD_PX, -STEEPEST, STEEPEST);
    const [right, forward] = input.move;
    const pace = (input.hurried ? RUN_M_S : WALK_M_S) * dt / Math.max(1, Math.hypot(right, forward));
    const [s, c] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    const move = { x: (right * c - forward * s) * pace, z: (-right * s - forward * c) * pace };
    if (move.x || move.z) walk(this.feet, move, walls);
    this.#stayNear();
    this.feet.y = this.#ground();
    this.eye = eased(this.eye, this.feet.y + EYE_M, dt);
  }

  aim(camera) {
    camera.position.set(this.feet.x, this.eye, this.feet.z);
    camera.rotation.set(this.pitch, this.yaw, 0, 'YXZ');
  }

  get pose() {
    return {
      x: this.feet.x,
      y: this.eye,
      z: this.feet.z,
      yaw: MathUtils.euclideanModulo(MathUtils.radToDeg(this.yaw) + 180, 360) - 180,
      pitch: MathUtils.radToDeg(this.pitch),
    };
  }

  set pose({ x, z, yaw, pitch }) {
    this.feet.set(x, 0, z);
    this.feet.y = this.#ground();
    this.eye = this.feet.y + EYE_M;
    this.yaw = MathUtils.degToRad(yaw);
    this.pitch = MathUtils.clamp(MathUtils.degToRad(pitch), -STEEPEST, STEEPEST);
  }

  #ground() {
    const here = [this.feet.x, this.feet.z];
    return this.raised.some((outline) => contains(outline, here)) ? 0 : -KERB_M;
  }

  #stayNear() {
    if (!this.bounds || this.bounds.isEmpty()) return;
    const { min, max } = this.bounds;
    this.feet.x = MathUtils.clamp(this.feet.x, min.x - REACH_M, max.x + REACH_M);
    this.feet.z = MathUtils.clamp(this.feet.z, min.z - REACH_M, max.z + REACH_M);
  }
}

/**
 * Where to stand to see a whole wall: on its street, facing it, within `room` metres. Where
 * that is too near for the `lens` of the eyes, the view is made wider: its `fov` says how wide.
 */
export function before(wall, room, lens = { fov: 62, aspect: 4 / 3 }) {
  const { a, b, out, top } = wall;
  const front = { width: AROUND * Math.hypot(b[0] - a[0], b[1] - a[1]), top: AROUND * top };
  let distance = Math.min(room, NEAREST_M);
  const seen = () => holding(front, distance, EYE_M, lens.aspect);
  while (distance < room && seen().fov > lens.fov) distance = Math.min(room, distance + 0.5);
  const { fov, tilt } = seen();
  return {
    x: (a[0] + b[0]) / 2 + out[0] * distance,
    y: EYE_M,
    z: (a[1] + b[1]) / 2 + out[1] * distance,
    yaw: MathUtils.radToDeg(Math.atan2(out[0], out[1])),
    pitch: tilt,
    fov: MathUtils.clamp(fov, lens.fov, WIDEST_DEG),
  };
}

/** Walls that stand side by side along one street, the row that shows most first. */
export function rows(walls) {
  const found = [];
  for (const wall of walls) {
    const near = found.find(([first]) => dot(first.out, wall.out) > 0.98
      && Math.abs(dot(first.a, first.out) - dot(wall.a, first.out)) < SAME_LINE_M);
    if (near) near.push(wall);
    else found.push([wall]);
  }
  // many fronts make a street, not one wide one
  const shown = (row) => row.reduce(
    (sum, { a, b }) => sum + Math.min(WIDE_M, Math.hypot(b[0] - a[0], b[1] - a[1])), 0,
  );
  return found.sort((p, q) => shown(q) - shown(p));
}

/** Where a walk begins: off the kerb, looking along a row of fronts. */
export function along(row, room) {
  const [{ a, out }] = row;
  const right = [out[1], -out[0]];
  const start = Math.min(...row.map((one) => dot(one.a, right)));
  const end = Math.max(...row.map((one) => dot(one.b, right)));
  const back = Math.min(room, 13);
  const s = start - Math.min(6, 0.1 * (end - start));
  const reach = Math.min(end - s, 45); // look at a point of the row this far on
  const look = [0, 1].map((i) => right[i] * 0.62 * reach - out[i] * back);
  const depth = dot(a, out);
  return {
    x: right[0] * s + out[0] * (depth + back),
    y: EYE_M,
    z: right[1] * s + out[1] * (depth + back),
    yaw: MathUtils.radToDeg(Math.atan2(-look[0], -look[1])),
    pitch: 10,
  };
}

const dot = (p, q) => p[0] * q[0] + p[1] * q[1];
