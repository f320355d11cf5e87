// Then and now: the model seen from where a photographer stood, the photograph laid over it.

import { Matrix4, Quaternion, Vector3 } from 'three';

import { fitted, through } from './lens.js';
import { local } from './panel.js';
import { nameOf } from './words.js';

const MARGIN_PX = 12;
const LOWEST_M = 0.3; // of a camera: below, the front's foot was misplaced

/** Where a photo's camera stands in the city: `{ position, quaternion }`, as three.js looks. */
export function stationOf({ position_m: at, block_from_camera: rows }, frame) {
  const turned = ([east, north, up]) => new Vector3(east, up, -north);
  const [right, down, ahead] = [0, 1, 2].map((column) => turned(rows.map((row) => row[column])));
  const basis = new Matrix4().makeBasis(right, down.negate(), ahead.negate());
  const level = new Matrix4().extractRotation(frame);
  return {
    position: turned(at).applyMatrix4(frame),
    quaternion: new Quaternion().setFromRotationMatrix(level.multiply(basis)),
  };
}

/** The photo of a building that a view can be shown from: the one named, or else the first. */
export function photoOf(building, key = null) {
  const able = (building?.record.photos ?? []).filter(({ camera, file }) => camera && local(file));
  return able.find((photo) => photo.key === key) ?? (key ? null : able[0] ?? null);
}

/** What is said beneath: how far off he stood, how surely that is known, what does not agree. */
export function told({ position_m: at, position_sd_m: sd, roof_m: roof }, record) {
  const words = [];
  const high = at[2] >= LOWEST_M
    ? `the camera ${at[2].toFixed(1)} m above the ground`
    : 'how high is not known, for the foot of the front is hidden in the photograph';
  const spread = Number.isFinite(sd) ? `, give or take ${sd < 1 ? sd.toFixed(1) : sd.toFixed(0)} m` : '';
  words.push(`Where the photographer stood${spread}; ${high}.`);
  const off = record.height_m - roof;
  if (Math.abs(off) > 0.12 * roof) {
    words.push(`This photograph makes the front ${roof.toFixed(0)} m high, the model has it ${record.height_m.toFixed(0)} m.`);
  }
  return words.join(' ');
}

export class Then {
  /** `elements`: the picture, the bar beneath it, and what covers part of the screen. */
  constructor({ picture, bar }, { onSlide, onLeave }) {
    this.picture = picture;
    this.bar = bar;
    this.slider = bar.querySelector('input');
    this.key = null; // of the photo that is shown
    this.station = null;
    this.slider.addEventListener('input', () => {
      this.#mix();
      onSlide();
    });
    bar.querySelector('button').addEventListener('click', onLeave);
  }

  get on() {
    return this.key !== null;
  }

  /** Stands where a photo of a building was taken. */
  enter(photo, { record }, frame) {
    this.key = photo.key;
    this.camera = photo.camera;
    this.station = stationOf(photo.camera, frame);
    const image = this.picture.querySelector('img');
    image.src = photo.file;
    image.alt = `Photograph of ${nameOf(record)}`;
    this.bar.querySelector('p').textContent = told(photo.camera, record);
    this.slider.value = 100;
    this.#mix();
    this.bar.hidden = false;
    this.picture.hidden = true; // until one has arrived
    this.fit();
  }

  /** Whether the camera would stand in or below the street, which then can't be drawn. */
  get low() {
    return this.on && this.camera.position_m[2] < LOWEST_M;
  }

  /** The model has taken the camera's place: the photograph may appear. */
  arrived() {
    this.picture.hidden = !this.on;
  }

  leave() {
    this.key = null;
    this.picture.hidden = this.bar.hidden = true;
  }

  /** Lays the photograph as large as the screen allows above the bar, and makes the frustum fit it. */
  fit() {
    if (!this.on) return;
    const screen = { width: innerWidth, height: innerHeight };
    const foot = screen.height - this.bar.getBoundingClientRect().top;
    const room = {
      x: MARGIN_PX,
      y: MARGIN_PX,
      width: screen.width - 2 * MARGIN_PX,
      height: screen.height - foot - 2 * MARGIN_PX,
    };
    const box = fitted(this.camera.size_px, room);
    this.frustum = through(this.camera, box, screen);
    Object.assign(this.picture.style, {
      left: `${box.x}px`, top: `${box.y}px`, width: `${box.width}px`, height: `${box.height}px`,
    });
  }

  #mix() {
    const share = this.slider.value / 100;
    this.picture.querySelector('img').style.opacity = share;
    this.slider.setAttribute('aria-valuetext', share > 0.5 ? 'mostly the photograph' : 'mostly the model');
  }
}
