// The stage: renderer, camera, sky, street, and what each block adds to the ground.

import {
  Box3, BufferGeometry, Float32BufferAttribute, FogExp2, LineBasicMaterial, LineSegments, Mesh,
  PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from 'three';
import { acceleratedRaycast } from 'three-mesh-bvh';

import { outlineOf, pavement, shade, street } from './ground.js';
import { fade, label, repeated } from './labels.js';
import { HORIZON, sky } from './sky.js';

Mesh.prototype.raycast = acceleratedRaycast;

const HAZE = 0.0042; // per metre, on the street
const INK = 0x26241f;
const SLOW_S = 0.045;
const PATIENCE = 6; // slow frames
const COARSE = 0.55; // of the screen's own resolution

export class Stage {
  constructor(canvas) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera = new PerspectiveCamera(62, 1, 0.12, 4000);
    this.scene = new Scene();
    this.scene.fog = new FogExp2(HORIZON, HAZE);
    this.dome = sky();
    this.scene.add(this.dome, street());
    this.box = new Box3();
    this.raised = [];
    this.paved = new Set(); // names of blocks
    this.settled = new Set();
    this.names = []; // of streets
    this.chosen = null;
    this.lag = 0;
    this.sharpness = 1;
  }

  fit(width, height) {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.fov = width < height ? 78 : 62;
    this.camera.updateProjectionMatrix();
  }

  /**
   * Draws coarser while frames that follow each other take long, and sharply at rest.
   * `dt` is the time since the last frame, or 0 at rest.
   */
  pace(dt) {
    const slow = dt > SLOW_S;
    this.lag = Math.max(0, Math.min(2 * PATIENCE, this.lag + (slow ? 1 : -1)));
    const wanted = dt > 0 && this.lag > PATIENCE ? COARSE : 1;
    if (wanted === this.sharpness) return;
    this.sharpness = wanted;
    this.renderer.setPixelRatio(wanted * Math.min(devicePixelRatio, 2));
  }

  /** `height` is 0 on the street and 1 in the air, where haze thins and names appear. */
  draw(height = 0) {
    this.scene.fog.density = HAZE * (1 - 0.85 * height);
    fade(this.names, height);
    this.dome.position.copy(this.camera.position);
    this.renderer.render(this.scene, this.camera);
  }

  /** Lays sidewalks round outlines of [x, z], once per block. */
  pave(name, outlines) {
    if (this.paved.has(name) || !outlines.length) return;
    this.paved.add(name);
    const { group, walks } = pavement(outlines);
    this.scene.add(group);
    this.raised.push(...walks);
    for (const [x, z] of outlines.flat()) this.box.expandByPoint(new Vector3(x, 0, z));
  }

  /** Adds what is known of a block only once its model is there. */
  settle(block, shapes) {
    this.pave(block.name, [outlineOf(shapes)]);
    if (this.settled.has(block.name)) return; // it was here before, and went
    this.settled.add(block.name);
    this.scene.add(shade(shapes.flatMap(({ walls }) => walls)), edges(shapes, INK, 0.35));
    for (const { top } of shapes) this.box.max.y = Math.max(this.box.max.y, top);
  }

  /** Writes a street's name beside the walls that stand on it. */
  inscribe(name, row) {
    const plane = label(name, row);
    if (repeated(plane, this.names)) return;
    this.names.push(plane);
    this.scene.add(plane);
  }

  /** Draws a line round one building, or none. */
  choose(shape) {
    if (this.chosen) {
      this.scene.remove(this.chosen);
      this.chosen.geometry.dispose();
    }
    this.chosen = shape ? edges([shape], 0xf4d58a, 1) : null;
    if (this.chosen) this.scene.add(this.chosen);
  }
}

/** The outlines of walls up to the roof (a gable shows its own), just before them. */
function edges(shapes, color, opacity) {
  const position = [];
  for (const { walls, roof } of shapes) {
    for (const { a, b, out, bottom, top } of walls) {
      const at = ([x, z], y) => [x + out[0] * 0.02, y, z + out[1] * 0.02];
      const end = Math.min(top, roof || top);
      position.push(...at(a, bottom), ...at(a, end), ...at(b, end), ...at(b, bottom));
      if (end === top) position.push(...at(a, end), ...at(b, end));
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(position, 3));
  const material = new LineBasicMaterial({ color, opacity, transparent: opacity < 1 });
  return new LineSegments(geometry, material);
}
