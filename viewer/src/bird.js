// The bird's view: an orbit round a point on the ground.

import { MathUtils, Vector3 } from 'three';

const LOOK_RAD_PX = 0.005;
const PAN_PER_S = 0.7; // of the distance
const ZOOM = 1.12; // a notch of the wheel

export class Bird {
  constructor() {
    this.target = new Vector3();
    this.distance = 120;
    this.azimuth = 0; // 0 looks north
    this.elevation = 0.75;
    this.far = 1000;
  }

  /** Frames a box, seen from the azimuth given. */
  frame(box, camera, azimuth = this.azimuth) {
    box.getCenter(this.target);
    this.target.y = 0;
    this.azimuth = azimuth;
    this.elevation = 0.72;
    const eye = camera.clone();
    let [near, far] = [20, 5000];
    for (let i = 0; i < 24; i++) {
      this.distance = (near + far) / 2;
      this.aim(eye);
      eye.updateMatrixWorld();
      if (holds(eye, box)) far = this.distance;
      else near = this.distance;
    }
    this.far = this.distance * 3;
  }

  step(dt, input) {
    const { look, zoom } = input.taken();
    this.azimuth += look[0] * LOOK_RAD_PX + input.turn * 1.2 * dt;
    this.elevation = MathUtils.clamp(this.elevation + look[1] * LOOK_RAD_PX, 0.15, 1.55);
    this.distance = MathUtils.clamp(this.distance * ZOOM ** zoom, 15, this.far);
    const [right, forward] = input.move;
    const pace = PAN_PER_S * this.distance * dt * (input.hurried ? 2.5 : 1);
    const [s, c] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    this.target.x += (right * c - forward * s) * pace;
    this.target.z += (-right * s - forward * c) * pace;
  }

  aim(camera) {
    const level = Math.cos(this.elevation) * this.distance;
    camera.position.set(
      this.target.x + Math.sin(this.azimuth) * level,
      this.target.y + Math.sin(this.elevation) * this.distance,
      this.target.z + Math.cos(this.azimuth) * level,
    );
    camera.rotation.set(-this.elevation, this.azimuth, 0, 'YXZ');
  }
}

/** Whether all corners of a box lie well inside the view. */
function holds(camera, { min, max }) {
  const corner = new Vector3();
  for (let i = 0; i < 8; i++) {
    corner.set(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
    corner.applyMatrix4(camera.matrixWorldInverse);
    if (corner.z > -1) return false;
    corner.applyMatrix4(camera.projectionMatrix);
    if (Math.max(Math.abs(corner.x), Math.abs(corner.y)) > 0.86) return false;
  }
  return true;
}
