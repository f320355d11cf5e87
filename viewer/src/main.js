// Wires the page together, and lets tests and scripts drive it through window.nostalgin.

import { MathUtils, Quaternion, Raycaster, Vector2, Vector3 } from 'three';

import { Bird, ELEVATION_RAD } from './bird.js';
import { open } from './city.js';
import { nameOfCode } from './evidence.js';
import { Finder } from './finder.js';
import { Input } from './input.js';
import { fillLegend } from './legend.js';
import { Minimap } from './minimap.js';
import { shown } from './paint.js';
import { Panel } from './panel.js';
import { fromHash, toHash } from './pose.js';
import { Stage } from './stage.js';
import { frontOf } from './survey.js';
import { Walker, along, before, rows } from './walker.js';
import { contains } from './outline.js';
import { nameOf } from './words.js';

const $ = (id) => document.getElementById(id);
const FLIGHT_S = 1.1;
const FARTHEST_M = 28; // to step back from a front
const MOST_WALLS = 300; // are looked at to choose a view
const LONGEST_STEP_S = 0.1;
const SETTLING_FRAMES = 3; // after a change, so that a sharp picture stays

class Page {
  constructor(city) {
    this.city = city;
    this.stage = new Stage($('view'));
    this.input = new Input($('view'), $('stick'));
    this.walker = new Walker();
    this.bird = new Bird();
    this.minimap = new Minimap($('plan').firstElementChild);
    this.panel = new Panel($('panel'), {
      onClose: () => this.mark(null),
      onVisit: (record) => this.visit(String(record.id)),
    });
    this.finder = new Finder($('finder'), city, (id) => this.visit(id, true));
    this.ray = new Raycaster();
    this.ray.firstHitOnly = true;
    this.flying = false;
    this.height = 0; // 0 on foot, 1 in the air
    this.chosen = null;
    this.home = null;
    this.held = false;
    this.said = 0;
    this.still = 0;
    this.stage.scene.add(city.group);
    this.stage.camera.rotation.order = 'YXZ';
    city.tiles.setCamera(this.stage.camera);
    this.walker.raised = this.stage.raised;
    this.walker.bounds = this.stage.box;
  }

  /** Paves what the records tell, then waits for the first model to stand before it. */
  async begin() {
    const { city, stage } = this;
    for (const block of city.record.blocks) {
      if (block.outline_m?.length && city.frames.has(block.name)) {
        stage.pave(block.name, block.outline_m.map((ring) => city.placed(block, ring)));
      }
    }
    this.listen();
    this.resize();
    const wished = fromHash(location.hash);
    const middle = city.middle();
    this.walker.pose = wished.pose ?? { x: middle.x, z: middle.z, yaw: 0, pitch: 0 };
    if (wished.evidence) this.setEvidence(true);
    const settled = this.firstBlock();
    stage.renderer.setAnimationLoop((time) => this.frame(time));
    const block = await settled;
    this.home = this.homeIn(block);
    if (!wished.pose) this.walker.pose = this.home;
    if (wished.bird) this.setBird(true, true);
    if (wished.building && city.buildings.has(wished.building)) this.select(wished.building);
    document.body.classList.add('running');
    $('view').focus({ preventScroll: true });
  }

  /** Resolves to the first block once it stands, or to another where it can't be had. */
  firstBlock() {
    const { city, stage } = this;
    const first = city.record.blocks.find(({ name }) => city.frames.has(name));
    const standing = [];
    return new Promise((resolve, reject) => {
      city.onBlock = (block) => {
        const shapes = block.buildings.map(({ id }) => city.buildings.get(String(id)).shape);
        stage.settle(block, shapes.filter(Boolean));
        this.inscribe(block);
        standing.push(block);
        if (block === first || city.errors.length) resolve(block);
      };
      city.onError = (error) => {
        if (standing.length) resolve(standing[0]);
        else if (city.errors.length >= city.record.blocks.length) reject(error);
      };
    });
  }

  /** Writes the names of a block's streets, told by buildings that stand on one only. */
  inscribe(block) {
    const streets = new Map();
    for (const { id, street, fronts } of block.buildings) {
      const { shape } = this.city.buildings.get(String(id));
      if (!shape || !street || (fronts ?? [0]).length !== 1) continue;
      streets.set(street, [...(streets.get(street) ?? []), this.frontOf(shape)]);
    }
    for (const [street, walls] of streets) this.stage.inscribe(street, rows(walls)[0]);
  }

  homeIn(block) {
    const known = block.buildings.map(({ id }) => this.city.buildings.get(String(id)));
    const walls = known.flatMap(({ shape }) => shape?.walls ?? []).filter((wall) => this.clear(wall));
    const [best] = rows(walls.filter(({ kind }) => kind === 'own'));
    const row = best ?? rows(walls)[0];
    return row ? along(row, this.room(row[0])) : this.walker.pose;
  }

  poseBefore(shape) {
    const wall = this.frontOf(shape);
    return before(wall, this.room(wall));
  }

  frontOf(shape) {
    return frontOf(shape, (candidate) => this.clear(candidate));
  }

  /** How far one can step back from a wall. */
  room({ a, b, out: [x, z] }) {
    const out = new Vector3(x, 0, z);
    const foot = new Vector3((a[0] + b[0]) / 2, 1.5, (a[1] + b[1]) / 2).addScaledVector(out, 0.3);
    this.ray.set(foot, out);
    const hit = this.ray.intersectObjects([...this.city.walls], false)[0];
    return hit ? Math.max(2.5, Math.min(FARTHEST_M, hit.distance * 0.7)) : FARTHEST_M;
  }

  /** Whether the ground before a wall is free. */
  clear({ a, b, out }) {
    const at = [(a[0] + b[0]) / 2 + 2 * out[0], (a[1] + b[1]) / 2 + 2 * out[1]];
    for (const { shape } of this.city.buildings.values()) {
      if (shape?.roofs.some((roof) => contains(roof, at))) return false;
    }
    return true;
  }

  frame(time) {
    const dt = Math.min((time - (this.lastTime ?? time)) / 1000, LONGEST_STEP_S);
    this.lastTime = time;
    if (this.held) return;
    if (this.input.used) document.body.classList.add('walked');
    this.step(dt);
    this.city.update(this.walker.feet);
    if (!this.changed()) return;
    this.stage.pace(this.still === 0 ? dt : 0);
    this.draw();
  }

  step(dt) {
    const goal = this.flying ? 1 : 0;
    const left = Math.abs(goal - this.height);
    this.height += Math.sign(goal - this.height) * Math.min(left, dt / FLIGHT_S);
    if (this.flying) this.bird.step(dt, this.input);
    else this.walker.step(dt, this.input, this.city.walls);
    this.aim();
    this.said += dt;
    if (this.said > 0.4) {
      this.said = 0;
      this.tell();
    }
  }

  /** Whether the next picture would differ from the last: none is drawn in vain. */
  changed() {
    const { camera } = this.stage;
    const { city } = this;
    const state = [
      ...camera.matrixWorld.elements, camera.aspect, city.loaded, city.tiles.loadProgress,
      shown.evidence.value, this.chosen, innerWidth, innerHeight, city.tiles.visibleTiles.size,
    ].join();
    const same = state === this.state;
    this.state = state;
    this.still = same ? this.still + 1 : 0;
    return this.still < SETTLING_FRAMES;
  }

  aim() {
    const { camera } = this.stage;
    if (this.height < 1) this.walker.aim(camera);
    if (this.height > 0) {
      const from = { p: camera.position.clone(), q: camera.quaternion.clone() };
      this.bird.aim(camera);
      if (this.height < 1) {
        const t = MathUtils.smootherstep(this.height, 0, 1);
        camera.position.lerpVectors(from.p, camera.position.clone(), t);
        camera.quaternion.copy(new Quaternion().slerpQuaternions(from.q, camera.quaternion.clone(), t));
      }
    }
    camera.updateMatrixWorld();
  }

  draw() {
    this.stage.draw(this.height);
    this.minimap.draw(this.walker.pose, this.city, this.stage.raised, this.chosen, shown.evidence.value);
    const progress = Math.round(this.city.tiles.loadProgress * 100);
    $('progress').setAttribute('aria-valuenow', progress);
    $('progress').firstElementChild.style.width = `${progress}%`;
  }

  /** Says where one is, on the page and in the address bar. */
  tell() {
    const near = this.nearest();
    const text = near ? `${near.distance < 25 ? 'Before' : 'Near'} ${nameOf(near.record)}` : '';
    if ($('place').textContent !== text) $('place').textContent = text;
    const hash = toHash({
      pose: this.walker.pose,
      building: this.chosen,
      evidence: shown.evidence.value > 0,
      bird: this.flying,
    });
    if (hash !== location.hash) history.replaceState(null, '', hash);
  }

  nearest() {
    const { x, z } = this.walker.feet;
    let best = null;
    for (const { record, shape } of this.city.buildings.values()) {
      for (const { a, b, out } of shape?.walls ?? []) {
        const inFront = (x - a[0]) * out[0] + (z - a[1]) * out[1] > -0.5;
        const t = ((x - a[0]) * (b[0] - a[0]) + (z - a[1]) * (b[1] - a[1]))
          / ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2);
        const s = MathUtils.clamp(t, 0, 1);
        const distance = Math.hypot(a[0] + s * (b[0] - a[0]) - x, a[1] + s * (b[1] - a[1]) - z);
        if (inFront && (!best || distance < best.distance)) best = { record, distance };
      }
    }
    return best;
  }

  /** The building at a point of the view, both coordinates from -1 to 1; or null. */
  pick(x, y) {
    this.aim();
    this.ray.setFromCamera(new Vector2(x, y), this.stage.camera);
    const hit = this.ray.intersectObjects([...this.city.walls], false)[0];
    const found = hit && this.city.buildingAt(hit.object, hit.face);
    if (!found) return null;
    const code = hit.uv ? hit.object.userData.codeAt(hit.uv.x, hit.uv.y) : 6;
    const { block, record } = found;
    return { ...record, block: block.block, distance: hit.distance, evidence: nameOfCode(code) };
  }

  select(id, here = null) {
    const found = this.city.buildings.get(id);
    if (!found) return;
    this.mark(id);
    this.panel.show(found, here);
  }

  mark(id) {
    this.chosen = id;
    this.stage.choose(id ? this.city.buildings.get(id).shape : null);
  }

  /** Goes to stand before a building; flies above it where its model is not yet there. */
  visit(id, show = false) {
    const found = this.city.buildings.get(id);
    if (found.shape) {
      this.setBird(false);
      this.walker.pose = this.poseBefore(found.shape);
    } else if (found.block.outline_m?.length) {
      const [x, z] = this.city.placed(found.block, found.block.outline_m[0])[0];
      this.setBird(false);
      this.walker.pose = { x, z: z + 8, yaw: 0, pitch: 0 };
    }
    if (show) this.select(id);
  }

  setEvidence(on) {
    shown.evidence.value = on ? 1 : 0;
    $('legend').hidden = !on;
    press('KeyE', on);
  }

  setBird(on, now = matchMedia('(prefers-reduced-motion: reduce)').matches) {
    if (on && !this.flying) {
      this.bird.frame(this.corners(), this.stage.camera, this.bestAzimuth());
    }
    this.flying = on;
    if (now) this.height = on ? 1 : 0;
    document.body.classList.toggle('bird', on);
    press('KeyB', on);
  }

  /** The side from which most of the photographs can be seen; of equals, the one ahead. */
  bestAzimuth() {
    const walls = [...this.city.buildings.values()].flatMap(({ shape }) => shape?.walls ?? []);
    const fronts = walls.filter(({ kind }) => kind === 'own').slice(0, MOST_WALLS);
    const sides = Array.from({ length: 16 }, (_, i) => (i * Math.PI) / 8);
    const worth = sides.map((azimuth) => {
      const sum = fronts.reduce((total, wall) => total + this.worth(wall, azimuth), 0);
      return sum * (1 + 0.1 * Math.cos(azimuth - this.walker.yaw));
    });
    return sides[worth.indexOf(Math.max(...worth))];
  }

  /** How much of a wall is seen from far and above; 0 where something hides it. */
  worth({ a, b, out, top }, azimuth) {
    const level = new Vector3(Math.sin(azimuth), 0, Math.cos(azimuth));
    const facing = out[0] * level.x + out[1] * level.z;
    if (facing <= 0.1) return 0;
    const from = new Vector3((a[0] + b[0]) / 2 + 0.3 * out[0], 0.6 * top, (a[1] + b[1]) / 2 + 0.3 * out[1]);
    this.ray.set(from, level.setY(Math.tan(ELEVATION_RAD)).normalize());
    if (this.ray.intersectObjects([...this.city.walls], false).length) return 0;
    return facing * Math.min(20, Math.hypot(b[0] - a[0], b[1] - a[1])) * Math.min(40, top);
  }

  /** Points that the bird's view has to hold. */
  corners() {
    const { min, max } = this.stage.box;
    const points = [];
    for (const { shape } of this.city.buildings.values()) {
      for (const { a, top, bottom } of shape?.walls ?? []) {
        points.push(new Vector3(a[0], bottom, a[1]), new Vector3(a[0], top, a[1]));
      }
    }
    return points.length ? points : [min.clone(), max.clone()];
  }

  key(code) {
    const act = {
      KeyE: () => this.setEvidence(!shown.evidence.value),
      KeyB: () => this.setBird(!this.flying),
      KeyG: () => this.finder.open(),
      KeyH: () => $('help').showModal(),
      KeyL: () => this.input.toggleLock(),
      KeyF: () => this.click(0, 0),
      Home: () => { this.setBird(false); this.walker.pose = this.home ?? this.walker.pose; },
      Escape: () => this.panel.close(),
    }[code];
    act?.();
    return Boolean(act);
  }

  click(x, y) {
    const found = this.pick(x, y);
    if (found) this.select(String(found.id), found.evidence);
    else this.panel.close();
  }

  listen() {
    this.input.onClick = (x, y) => this.click(x, y);
    this.input.onKey = (event) => {
      const code = event.key === '?' ? 'KeyH' : event.code;
      if (this.key(code)) event.preventDefault();
      document.body.classList.toggle('keys', code === 'KeyF' || document.body.classList.contains('keys'));
    };
    for (const button of document.querySelectorAll('[data-key]')) {
      button.addEventListener('click', () => this.key(button.dataset.key));
    }
    document.addEventListener('pointerlockchange', () => {
      document.body.classList.toggle('locked', Boolean(document.pointerLockElement));
    });
    addEventListener('resize', () => this.resize());
    addEventListener('hashchange', () => {
      const { pose, evidence, bird } = fromHash(location.hash);
      if (pose) this.walker.pose = pose;
      this.setEvidence(evidence);
      this.setBird(bird);
    });
  }

  resize() {
    this.stage.fit(innerWidth, innerHeight);
    this.city.tiles.setResolutionFromRenderer(this.stage.camera, this.stage.renderer);
  }
}

function press(code, on) {
  document.querySelector(`#tools [data-key=${code}]`).setAttribute('aria-pressed', on);
}

function complain(error) {
  const text = document.createElement('p');
  const missing = /json|404|Failed to fetch/.test(String(error));
  text.textContent = missing
    ? 'There is no city here yet. Run “nostalgin build CITY”, then “nostalgin view CITY”.'
    : `The city could not be shown: ${error.message ?? error}`;
  $('notice').replaceChildren(text);
}

async function start() {
  // street names are painted once, so their letters have to be there
  const [city] = await Promise.all([open(), document.fonts.load('600 72px Garamond').catch(() => [])]);
  document.title = `${city.record.title} · Nostalgin`;
  document.querySelector('#title h1').textContent = city.record.title;
  fillLegend($('legend').querySelector('ul'));
  const page = new Page(city);
  window.nostalgin.page = page;
  await page.begin();
  return page;
}

const starting = start();
starting.catch(complain);

window.nostalgin = {
  ready: starting.then(() => true),
  step: async (dt) => {
    const page = await starting;
    page.step(dt);
    page.city.update(page.walker.feet);
    page.draw();
  },
  hold: async (on = true) => { (await starting).held = on; },
  get pose() { return window.nostalgin.page.walker.pose; },
  setPose: (pose) => { window.nostalgin.page.walker.pose = pose; window.nostalgin.page.aim(); },
  pick: (x, y) => window.nostalgin.page.pick(x, y),
  select: (id) => window.nostalgin.page.select(id),
  setEvidence: (on) => window.nostalgin.page.setEvidence(on),
  setBird: (on) => window.nostalgin.page.setBird(on, true),
  get stats() {
    const { city, stage, height } = window.nostalgin.page;
    const { calls, triangles } = stage.renderer.info.render;
    return {
      loaded: city.loaded,
      blocks: city.record.blocks.length,
      progress: city.tiles.loadProgress,
      errors: [...city.errors],
      walls: city.walls.size,
      calls,
      triangles,
      height,
    };
  },
};

