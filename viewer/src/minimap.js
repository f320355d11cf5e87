// A small plan, north up, with the walker in its middle.

import { repeated } from './labels.js';

const RADIUS_M = 95;
const LARGEST_M = 120; // of a building, along a side
const PAPER = '#e9e5da';
const LETTER_M = 10;
const APART_M = 110; // names that are alike

export class Minimap {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.last = '';
  }

  /** Draws anew only when something that it shows has changed. */
  draw({ x, z, yaw }, city, { raised, names }, chosen, evidence) {
    const state = [
      x.toFixed(1), z.toFixed(1), yaw.toFixed(0), city.loaded, raised.length, names.length, chosen, evidence,
    ];
    if (state.join() === this.last) return;
    this.last = state.join();
    const { context: c, canvas } = this;
    const scale = canvas.width / (2 * RADIUS_M);
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.fillStyle = '#c3bfb4';
    c.fillRect(0, 0, canvas.width, canvas.height);
    c.setTransform(scale, 0, 0, scale, canvas.width / 2 - x * scale, canvas.height / 2 - z * scale);
    c.fillStyle = PAPER;
    for (const outline of raised) fill(c, outline);
    for (const { record, shape } of city.near([x, z], RADIUS_M)) {
      if (!shape?.roofs.length || far(shape.roofs[0][0], x, z)) continue;
      c.fillStyle = c.strokeStyle = String(record.id) === chosen ? '#b8862b' : ink(record, evidence);
      c.lineWidth = 0.4;
      for (const roof of shape.roofs) {
        fill(c, roof);
        c.stroke();
      }
    }
    this.#inscribe(names, [x, z]);
    this.#arrow(yaw);
  }

  /** Writes the streets' names along them, the right way up. */
  #inscribe(names, here) {
    const { context: c } = this;
    const written = [];
    c.font = `600 ${LETTER_M}px Garamond, Georgia, serif`;
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    c.fillStyle = '#3a362f';
    for (const plane of names) {
      const place = beside(plane.userData.line, here);
      if (far(place, ...here) || repeated(plane.name, place, written, APART_M)) continue;
      written.push({ name: plane.name, position: { x: place[0], z: place[1] } });
      c.save();
      c.translate(...place);
      c.rotate(upright(-plane.rotation.y));
      c.fillText(plane.name, 0, 0);
      c.restore();
    }
  }

  #arrow(yaw) {
    const { context: c, canvas } = this;
    const size = canvas.width / 22;
    c.setTransform(1, 0, 0, 1, canvas.width / 2, canvas.height / 2);
    c.rotate((-yaw * Math.PI) / 180);
    c.beginPath();
    c.moveTo(0, -1.3 * size);
    c.lineTo(0.85 * size, size);
    c.lineTo(0, 0.55 * size);
    c.lineTo(-0.85 * size, size);
    c.closePath();
    c.fillStyle = '#8c2f1b';
    c.strokeStyle = '#fff';
    c.lineWidth = size / 4;
    c.stroke();
    c.fill();
  }
}

/** The point of a line nearest to one, so that a name stays on the plan. */
function beside([a, b], [x, z]) {
  const way = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(...way) || 1;
  const t = ((x - a[0]) * way[0] + (z - a[1]) * way[1]) / length;
  const half = Math.min(35, length / 2);
  const s = Math.max(half, Math.min(length - half, t)) / length;
  return [a[0] + s * way[0], a[1] + s * way[1]];
}

/** An angle at which letters do not stand on their heads. */
export function upright(angle) {
  const turned = Math.atan2(Math.sin(angle), Math.cos(angle));
  return Math.abs(turned) > Math.PI / 2 + 1e-6 ? turned + Math.PI : turned;
}

/** Whether a building lies so far off that nothing of it is on the plan. */
function far([u, v], x, z) {
  return Math.max(Math.abs(u - x), Math.abs(v - z)) > RADIUS_M + LARGEST_M;
}

function fill(c, outline) {
  c.beginPath();
  outline.forEach(([x, z], i) => (i ? c.lineTo(x, z) : c.moveTo(x, z)));
  c.closePath();
  c.fill();
}

function ink(record, evidence) {
  if (!evidence) return record.assumed ? '#aaa69b' : '#5b5750';
  if (record.assumed) return '#b48bd0';
  const share = Number.isFinite(record.photographed_share) ? record.photographed_share : 0;
  return `color-mix(in srgb, #5b5750 ${Math.round(share * 100)}%, #e69f00)`;
}
