// A walker: a pair of spheres, at knee and chest, that walls push back.

import { Matrix4, Sphere, Vector3 } from 'three';

export const EYE_M = 1.62;
export const RADIUS_M = 0.35;
const HEIGHTS_M = [0.45, 1.25]; // above the feet
const STRIDE_M = 0.12; // no step is longer, so that no wall is jumped over
const CLIMB_PER_S = 9; // how fast the eyes follow a kerb

const inverse = new Matrix4();
const sphere = new Sphere();
const nearest = new Vector3();
const push = new Vector3();

/**
 * The position after walking `move` (metres, level), sliding along what is in the way.
 *
 * `feet` is changed in place. `walls` are meshes with `geometry.boundsTree`.
 */
export function walk(feet, move, walls) {
  const steps = Math.max(1, Math.ceil(Math.hypot(move.x, move.z) / STRIDE_M));
  for (let i = 0; i < steps; i++) {
    feet.x += move.x / steps;
    feet.z += move.z / steps;
    // Twice, so that a corner's two walls both have their say.
    for (let turn = 0; turn < 2; turn++) for (const wall of walls) standOff(feet, wall);
  }
  return feet;
}

/** Moves `feet` until neither sphere touches the wall. */
function standOff(feet, wall) {
  inverse.copy(wall.matrixWorld).invert();
  for (const height of HEIGHTS_M) {
    sphere.center.set(feet.x, feet.y + height, feet.z).applyMatrix4(inverse);
    sphere.radius = RADIUS_M;
    wall.geometry.boundsTree.shapecast({
      intersectsBounds: (box) => box.intersectsSphere(sphere),
      intersectsTriangle: (triangle) => {
        triangle.closestPointToPoint(sphere.center, nearest);
        const distance = nearest.distanceTo(sphere.center);
        if (distance >= RADIUS_M || distance < 1e-9) return;
        push.subVectors(sphere.center, nearest).multiplyScalar((RADIUS_M - distance) / distance);
        sphere.center.add(push);
        push.transformDirection(wall.matrixWorld).multiplyScalar(RADIUS_M - distance);
        feet.x += push.x;
        feet.z += push.z;
      },
    });
  }
}

/** Eases a height towards its goal; the same whatever the frame rate. */
export function eased(height, goal, dt, rate = CLIMB_PER_S) {
  return goal + (height - goal) * Math.exp(-rate * dt);
}
