// The stage: renderer, camera, sky, street, and what each block adds to the ground.

import {
  Box3, BufferGeometry, Float32BufferAttribute, FogExp2, Group, LineBasicMaterial, LineSegments, Mesh,
  PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from 'three';
import { acceleratedRaycast } from 'three-mesh-bvh';

import { outlineOf, paved, pavement, shade, street } from './ground.js';
import { Names } from './names.js';
import { Props } from './props.js';
import { HORIZON, sky } from './sky.js';

Mesh.prototype.raycast = acceleratedRaycast;

const HAZE = 0.0042; // per metre, on the street
const FAR_M = [800, 9000]; // on the street, where haze hides what is farther, and in the air
const NEAR_M = [0.12, 4];
const CELL_M = 400; // pavement of so large a square is one draw call
const INK = 0x26241f;
const SLOW_S = 0.045;
const PATIENCE = 6; // slow frames
const COARSE = 0.55; // of the screen's own resolution

export class Stage {
  constructor(canvas) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera = new PerspectiveCamera(62, 1, 0.12, FAR_M[0]);
    this.scene = new Scene();
    this.scene.fog = new FogExp2(HORIZON, HAZE);
    this.dome = sky();
    this.props = new Props();
    this.street = street();
    this.ground = new Group().add(this.street); // street, pavement, and what lies at walls' feet
    this.scene.add(this.dome, this.ground, this.props.group);
    this.box = new Box3();
    this.raised = [];
    this.paved = new Set(); // names of blocks
    this.settled = new Map(); // name of a block -> what lies at its feet
    this.signs = new Names(this.scene); // streets' names
    this.chosen = null;
    this.lag = 0;
    this.sharpness = 1;
  }

  /** The streets' names that stand. */
  get names() {
    return this.signs.planes;
  }

  /** What the eyes of a walker hold. */
  get lens() {
    return { fov: this.camera.fov, aspect: this.camera.aspect };
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

  /** Sees from as near to as far as one stands: names lie so flat on a street that depth has to be fine. */
  reach(height) {
    this.camera.near = NEAR_M[0] + (NEAR_M[1] - NEAR_M[0]) * height;
    this.camera.far = FAR_M[0] + (FAR_M[1] - FAR_M[0]) * height;
  }

  /**
   * `height` is 0 on the street and 1 in the air, where haze thins and names appear. What is
   * drawn for scale stands about `feet`, and not where a photograph lies `over` the view; the
   * ground is not drawn for a camera as `low` as itself.
   */
  draw(height, feet, { over = false, low = false } = {}) {
    const { camera } = this;
    this.scene.fog.density = over ? 0 : HAZE * (1 - 0.9 * height);
    this.signs.fade(height, camera.position.y);
    this.props.group.visible = !over;
    this.ground.visible = !low;
    this.props.gather(feet, this.raised);
    this.street.position.set(camera.position.x, 0, camera.position.z);
    this.dome.position.copy(camera.position);
    this.renderer.render(this.scene, camera);
  }

  /** Lays the sidewalks of many blocks: pairs of a name and outlines of [x, z]. */
  paveAll(blocks) {
    const cells = new Map();
    for (const [name, outlines] of blocks) {
      const [[x, z]] = outlines[0];
      const cell = `${Math.floor(x / CELL_M)},${Math.floor(z / CELL_M)}`;
      cells.set(cell, [...(cells.get(cell) ?? []), ...this.#pavement(name, outlines)]);
    }
    for (const parts of cells.values()) if (parts.length) this.ground.add(paved(parts));
  }

  /** What paves a block, once per block. */
  #pavement(name, outlines) {
    if (this.paved.has(name) || !outlines.length) return [];
    this.paved.add(name);
    const { parts, walks } = pavement(outlines);
    this.raised.push(...walks);
    for (const [x, z] of outlines.flat()) this.box.expandByPoint(new Vector3(x, 0, z));
    return parts;
  }

  /** Adds what is known of a block only once its model is there. */
  settle(block, shapes) {
    this.paveAll([[block.name, [outlineOf(shapes)]]]);
    this.#sweep(block); // a finer model may have come
    const feet = [shade(shapes.flatMap(({ walls }) => walls)), edges(shapes, INK, 0.35)];
    this.settled.set(block.name, feet);
    this.ground.add(...feet);
    for (const { top } of shapes) this.box.max.y = Math.max(this.box.max.y, top);
  }

  /** Takes away what came with a block's model. */
  unsettle(block) {
    this.#sweep(block);
    this.signs.erase(block.name);
  }

  #sweep(block) {
    for (const one of this.settled.get(block.name) ?? []) {
      this.ground.remove(one);
      one.geometry.dispose();
      one.material.dispose();
    }
    this.settled.delete(block.name);
  }

  /** Writes a street's name beside a block's walls that stand on it. */
  inscribe(block, name, row) {
    if (row) this.signs.write(block.name, name, row);
  }

  /** The street on which the feet stand, or an empty word. */
  streetAt(feet) {
    return this.signs.at(feet);
  }

  /** Draws a line round one building, or none. */
  choose(shape) {
    if (this.chosen) {
      this.scene.remove(this.chosen);
      this.chosen.geometry.dispose();
      this.chosen.material.dispose();
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
