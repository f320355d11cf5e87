// What a camera shows: where it is, how it is turned, and the edges of its frustum.

import { MathUtils, Quaternion, Vector3 } from 'three';

import { even, mixed } from './lens.js';

const LIFT = 0.18; // of the way: a flight rises over what lies between
const HIGHEST_M = 70;

/** A camera's place and turn, with an even frustum of `fov` degrees. */
export function viewOf(camera, fov = camera.fov) {
  return {
    position: camera.position.clone(),
    quaternion: new Quaternion().setFromEuler(camera.rotation),
    frustum: even(fov, camera.aspect),
  };
}

/** Between two views, `t` from 0 to 1; `lift` is how high the way rises between them. */
export function between(a, b, t, lift = 0) {
  const position = new Vector3().lerpVectors(a.position, b.position, t);
  position.y += lift * Math.sin(Math.PI * t);
  const quaternion = new Quaternion().slerpQuaternions(a.quaternion, b.quaternion, t);
  return { position, quaternion, frustum: mixed(a.frustum, b.frustum, t) };
}

/** Makes a camera show a view. */
export function show(camera, { position, quaternion, frustum: { left, right, top, bottom } }) {
  const n = camera.near;
  camera.position.copy(position);
  camera.quaternion.copy(quaternion);
  camera.projectionMatrix.makePerspective(left * n, right * n, top * n, bottom * n, n, camera.far);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  camera.updateMatrixWorld();
}

/** The view that a camera shows. */
export function shownBy({ position, quaternion, projectionMatrixInverse: inverse, near }) {
  const edge = (x, y) => new Vector3(x, y, -1).applyMatrix4(inverse).divideScalar(near);
  const [low, high] = [edge(-1, -1), edge(1, 1)];
  return {
    position: position.clone(),
    quaternion: quaternion.clone(),
    frustum: { left: low.x, right: high.x, top: high.y, bottom: low.y },
  };
}

/** A way from a view that was shown to the one that is wanted now. */
export class Flight {
  constructor() {
    this.from = null;
    this.onArrival = () => {};
  }

  get on() {
    return this.from !== null;
  }

  /** Departs from a view; without seconds one is there at once. */
  depart(view, seconds, onArrival = () => {}) {
    this.onArrival = onArrival;
    this.from = seconds > 0 ? view : null;
    this.seconds = seconds;
    this.past = 0;
    if (!this.on) onArrival();
  }

  step(dt) {
    if (!this.on) return;
    this.past += dt;
    if (this.past < this.seconds) return;
    this.from = null;
    this.onArrival();
  }

  /** What is shown on the way to a view. */
  over(view) {
    if (!this.on) return view;
    const way = this.from.position.distanceTo(view.position);
    const t = MathUtils.smootherstep(this.past / this.seconds, 0, 1);
    return between(this.from, view, t, way > 40 ? Math.min(HIGHEST_M, LIFT * way) : 0);
  }
}
