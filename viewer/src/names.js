// The streets' names that stand in the scene: a block's come and go with its model, and
// what is written is painted once a name.

import { fade, label, nearestName, repeated, spot, written } from './labels.js';

export class Names {
  constructor(scene) {
    this.scene = scene;
    this.planes = [];
    this.paper = new Map(); // name -> { texture, aspect, planes: how many wear it }
    this.unwritten = []; // { block, name, row }: another block's stands near
  }

  /** Writes a street's name beside the row of walls of a block that stand on it, unless it stands near. */
  write(block, name, row) {
    const known = (one) => one.name === name && one.block === block;
    if (this.unwritten.some(known) || this.planes.some(({ name, userData }) => known({ name, ...userData }))) return;
    const place = spot(row);
    if (repeated(name, place.middle, this.planes)) {
      this.unwritten.push({ block, name, row });
      return;
    }
    const paper = this.paper.get(name) ?? { ...written(name), planes: 0 };
    paper.planes += 1;
    this.paper.set(name, paper);
    const plane = label(name, place, paper);
    plane.userData.block = block;
    this.planes.push(plane);
    this.scene.add(plane);
  }

  /** Takes a block's names away; where others left theirs out for them, those are written. */
  erase(block) {
    const gone = this.planes.filter(({ userData }) => userData.block === block);
    this.planes = this.planes.filter(({ userData }) => userData.block !== block);
    for (const plane of gone) this.#dispose(plane);
    const names = new Set(gone.map(({ name }) => name));
    const waiting = this.unwritten.filter((one) => one.block !== block);
    this.unwritten = waiting.filter(({ name }) => !names.has(name));
    for (const one of waiting) if (names.has(one.name)) this.write(one.block, one.name, one.row);
  }

  #dispose(plane) {
    this.scene.remove(plane);
    plane.geometry.dispose();
    plane.material.dispose();
    const paper = this.paper.get(plane.name);
    paper.planes -= 1;
    if (paper.planes) return;
    paper.texture.dispose();
    this.paper.delete(plane.name);
  }

  /** Fades all names in or out; seen from far, they are written larger. */
  fade(opacity, distance) {
    fade(this.planes, opacity, distance);
  }

  /** The street on which the feet stand, or an empty word. */
  at({ x, z }) {
    return nearestName(this.planes, [x, z]);
  }
}
