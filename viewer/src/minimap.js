// A small plan, north up, with the walker in its middle.

const RADIUS_M = 95;
const LARGEST_M = 120; // of a building, along a side
const PAPER = '#e9e5da';

export class Minimap {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.last = '';
  }

  /** Draws anew only when something that it shows has changed. */
  draw({ x, z, yaw }, city, raised, chosen, evidence) {
    const state = [x.toFixed(1), z.toFixed(1), yaw.toFixed(0), city.loaded, raised.length, chosen, evidence];
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
    for (const [id, { record, shape }] of city.buildings) {
      if (!shape?.roofs.length || far(shape.roofs[0][0], x, z)) continue;
      c.fillStyle = c.strokeStyle = id === chosen ? '#b8862b' : ink(record, evidence);
      c.lineWidth = 0.4;
      for (const roof of shape.roofs) {
        fill(c, roof);
        c.stroke();
      }
    }
    this.#arrow(yaw);
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
