// The bird's view: an orbit round a point on the ground.

import { Box3, MathUtils, Vector3 } from 'three';

const LOOK_RAD_PX = 0.005;
const PAN_PER_S = 0.7; // of the distance
export const ELEVATION_RAD = 0.66;
const MARGIN = 0.84; // of the view's half, for what lies round its edge
const ZOOM = 1.12; // a notch of the wheel

export class Bird {
  constructor() {
    this.target = new Vector3();
    this.distance = 120;
    this.azimuth = 0; // 0 looks north
    this.elevation = ELEVATION_RAD;
    this.far = 1000;
  }

  /** Frames points on and above the ground, seen from the azimuth given. */
  frame(points, camera, azimuth = this.azimuth) {
    this.target.setY(0);
    this.azimuth = azimuth;
    this.elevation = ELEVATION_RAD;
    const box = new Box3().setFromPoints(points);
    box.getCenter(this.target).setY(0);
    const eye = camera.clone();
    eye.far = 1e5;
    eye.updateProjectionMatrix(); // the walker's may be a photograph's
    const up = Math.tan(MathUtils.degToRad(camera.fov / 2));
    for (let turn = 0; turn < 4; turn++) {
      this.#approach(points, eye);
      const { min, max } = seen(points, eye);
      const [x, y] = [(min.x + max.x) / 2, (min.y + max.y) / 2];
      this.#shift(x * up * camera.aspect * this.distance, (y * up * this.distance) / Math.sin(this.elevation));
    }
    this.#approach(points, eye);
    this.far = this.distance * 3;
  }

  /** Goes as near as all points allow. */
  #approach(points, eye) {
    let [near, far] = [20, 20000];
    for (let i = 0; i < 26; i++) {
      this.distance = (near + far) / 2;
      this.aim(eye);
      eye.updateMatrixWorld();
      const { min, max } = seen(points, eye);
      const most = Math.max(-min.x, -min.y, max.x, max.y);
      if (most < MARGIN) far = this.distance;
      else near = this.distance;
    }
  }

  #shift(right, forward) {
    const [s, c] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    this.target.x += right * c - forward * s;
    this.target.z += -right * s - forward * c;
  }

  step(dt, input) {
    const { look, zoom } = input.taken();
    this.azimuth += look[0] * LOOK_RAD_PX + input.turn * 1.2 * dt;
    this.elevation = MathUtils.clamp(this.elevation + look[1] * LOOK_RAD_PX, 0.15, 1.55);
    this.distance = MathUtils.clamp(this.distance * ZOOM ** zoom, 15, this.far);
    const [right, forward] = input.move;
    const pace = PAN_PER_S * this.distance * dt * (input.hurried ? 2.5 : 1);
    this.#shift(right * pace, forward * pace);
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

/** The part of the view that points take up, from -1 to 1; endless if one lies behind. */
function seen(points, camera) {
  const box = new Box3();
  const at = new Vector3();
  for (const point of points) {
    at.copy(point).applyMatrix4(camera.matrixWorldInverse);
    if (at.z > -1) return new Box3(at.set(-Infinity, -Infinity, 0), new Vector3(Infinity, Infinity, 0));
    box.expandByPoint(at.applyMatrix4(camera.projectionMatrix));
  }
  return box;
}
