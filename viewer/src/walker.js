// The walker's eyes: where they are and where they look.

import { MathUtils, Vector3 } from 'three';

import { EYE_M, eased, walk } from './body.js';
import { KERB_M } from './ground.js';
import { contains } from './outline.js';

const WALK_M_S = 2.6; // brisk: a block is long
const RUN_M_S = 8;
const TURN_RAD_S = 1.7;
const LOOK_RAD_PX = 0.0032;
const STEEPEST = MathUtils.degToRad(85);
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

/** Where to stand to see a wall whole: on its street, facing it, within `room` metres. */
export function before(wall, room = 16) {
  const { a, b, out, top } = wall;
  const width = Math.hypot(b[0] - a[0], b[1] - a[1]);
  const distance = Math.min(room, Math.max(7, 0.9 * width, 0.95 * top));
  const middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  const rise = Math.atan2(Math.max(0, 0.42 * top - EYE_M), distance);
  return {
    x: middle[0] + out[0] * distance,
    y: EYE_M,
    z: middle[1] + out[1] * distance,
    yaw: MathUtils.radToDeg(Math.atan2(out[0], out[1])),
    pitch: MathUtils.radToDeg(rise),
  };
}

/** Where a walk begins: off the kerb, looking along a row of fronts that share a street. */
export function along(wall, walls, room = 16) {
  const { out } = wall;
  const right = [out[1], -out[0]];
  const at = (point, way) => point[0] * way[0] + point[1] * way[1];
  const depth = at(wall.a, out);
  const row = walls.filter((one) => at(one.out, out) > 0.98 && Math.abs(at(one.a, out) - depth) < 3);
  const start = Math.min(...row.map((one) => at(one.a, right)));
  const end = Math.max(...row.map((one) => at(one.b, right)));
  const back = Math.min(room, 11);
  const s = start + Math.min(4, 0.1 * (end - start));
  const turn = MathUtils.degToRad(38); // away from the street's own direction
  const look = [0, 1].map((i) => right[i] * Math.cos(turn) - out[i] * Math.sin(turn));
  return {
    x: right[0] * s + out[0] * (depth + back),
    y: EYE_M,
    z: right[1] * s + out[1] * (depth + back),
    yaw: MathUtils.radToDeg(Math.atan2(-look[0], -look[1])),
    pitch: 9,
  };
}
