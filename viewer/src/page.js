// The page: moves the walker, draws when something changed, and answers keys and clicks.

import { MathUtils, Quaternion, Raycaster, Vector2, Vector3 } from 'three';

import { Bird } from './bird.js';
import { nameOfCode } from './evidence.js';
import { Finder } from './finder.js';
import { Input } from './input.js';
import { Minimap } from './minimap.js';
import { shown } from './paint.js';
import { Panel } from './panel.js';
import { fromHash, toHash } from './pose.js';
import { Stage } from './stage.js';
import { bestAzimuth, corners, frontFor, homeIn, nearest, poseBefore } from './vantage.js';
import { Walker, rows } from './walker.js';
import { nameOf } from './words.js';

const $ = (id) => document.getElementById(id);
const FLIGHT_S = 1.1;
const LONGEST_STEP_S = 0.1;
const SETTLING_FRAMES = 3; // after a change, so that a sharp picture stays

export class Page {
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
    this.home = homeIn(this.city, block, this.walker.pose);
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
      streets.set(street, [...(streets.get(street) ?? []), frontFor(this.city, shape)]);
    }
    for (const [street, walls] of streets) this.stage.inscribe(street, rows(walls)[0]);
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
    const near = nearest(this.city, this.walker.feet);
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
      this.walker.pose = poseBefore(this.city, found.shape);
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
      this.bird.frame(corners(this.city, this.stage.box), this.stage.camera, bestAzimuth(this.city, this.walker.yaw));
    }
    this.flying = on;
    if (now) this.height = on ? 1 : 0;
    document.body.classList.toggle('bird', on);
    press('KeyB', on);
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
