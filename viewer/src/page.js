// The page: moves the walker, draws when something changed, and says where one is.

import { MathUtils } from 'three';

import { Bird } from './bird.js';
import { Credit } from './credit.js';
import { Finder } from './finder.js';
import { Guide, calm } from './guide.js';
import { Input } from './input.js';
import { listen } from './keys.js';
import { Minimap } from './minimap.js';
import { shown } from './paint.js';
import { Panel } from './panel.js';
import { toHash } from './pose.js';
import { Unreadable } from './records.js';
import { shoot } from './shot.js';
import { faced, picked, where } from './sight.js';
import { bestAzimuth, corners, frontFor, homeIn } from './vantage.js';
import { between, show, shownBy, viewOf } from './view.js';
import { Walker, rows } from './walker.js';
import { nameOf } from './words.js';

const $ = (id) => document.getElementById(id);
const FLIGHT_S = 1.1;
const LONGEST_STEP_S = 0.1;
const LONGEST_PAST_S = 0.6;
const SETTLING_FRAMES = 3; // after a change, so that a sharp picture stays
const SAID_S = 6; // a message stays
const PAVED_M = 300; // about the first picture; what is farther is paved after it

export class Page {
  constructor(city, stage) {
    this.city = city;
    this.stage = stage;
    this.input = new Input($('view'), $('stick'));
    this.walker = new Walker();
    this.bird = new Bird();
    this.minimap = new Minimap($('plan').firstElementChild);
    this.credit = new Credit($('credit'), city.record.credits ?? []);
    this.guide = new Guide(this);
    this.panel = new Panel($('panel'), {
      onClose: () => this.guide.then.on || this.mark(null),
      onVisit: (record) => this.guide.visit(String(record.id)),
      onThen: (record, key) => this.guide.enter(String(record.id), key),
    });
    this.finder = new Finder($('finder'), city.record, (id) => this.guide.seek(id, { show: true }));
    this.flying = false;
    this.height = 0; // 0 on foot, 1 in the air
    this.fov = this.stage.lens.fov;
    this.chosen = null;
    this.home = null;
    this.held = false;
    this.said = 0;
    this.still = 0;
    this.quiet = 0; // seconds that a message stays yet
    this.begun = false; // there is something to see
    this.stage.scene.add(city.group);
    this.stage.camera.rotation.order = 'YXZ';
    this.walker.raised = this.stage.raised;
    this.walker.bounds = this.stage.box;
  }

  /** Paves what is near, then waits for the first model to stand before it; the rest of the city comes after. */
  async begin(loading) {
    const { city, stage } = this;
    listen(this);
    this.resize();
    this.walker.pose = { ...city.middle(), yaw: 0, pitch: 0 };
    const linked = location.hash.length > 1 && await this.guide.open(location.hash);
    const { near, far } = city.ground(this.walker.feet, PAVED_M);
    stage.paveAll(near);
    const settled = this.firstBlock(linked);
    stage.renderer.setAnimationLoop((time) => this.frame(time));
    loading.models(city);
    this.home = homeIn(city, await settled, this.walker.pose);
    if (!linked) this.stand(this.home);
    this.begun = true;
    city.all(stage.camera, stage.renderer);
    document.body.classList.add('running');
    if (!this.panel.open) $('view').focus({ preventScroll: true });
    this.aim();
    this.draw();
    performance.mark('first picture');
    stage.paveAll(far);
  }

  /** Resolves to the first block once it stands; to another where `any` will do, or it can't be had. */
  firstBlock(any) {
    const { city, stage } = this;
    const first = city.record.blocks.find(({ name }) => city.frames.has(name));
    const standing = [];
    return new Promise((resolve, reject) => {
      city.onBlock = (block) => {
        stage.settle(block, city.records.of(block).map(({ shape }) => shape).filter(Boolean));
        this.inscribe(block);
        this.guide.came(block);
        this.wake();
        standing.push(block);
        if (any || !first || block === first || city.errors.length) resolve(block);
      };
      city.onGone = (block) => stage.unsettle(block);
      city.onError = (error) => {
        if (error instanceof Unreadable) this.say(error.message);
        if (standing.length) resolve(standing[0]);
        else if (city.failed.size >= city.record.blocks.length) reject(error);
        else if (any) resolve(first); // it stands nowhere
        else this.walker.pose = { ...this.walker.pose, ...city.middle() }; // to the next
      };
    });
  }

  /** Writes the names of a block's streets, told by buildings that stand on one only. */
  inscribe(block) {
    const streets = new Map();
    for (const { shape, record: { street, fronts } } of this.city.records.of(block)) {
      if (!shape || !street || (fronts ?? [0]).length !== 1) continue;
      streets.set(street, [...(streets.get(street) ?? []), frontFor(this.city, shape)]);
    }
    for (const [street, walls] of streets) this.stage.inscribe(block, street, rows(walls)[0]);
  }

  frame(time) {
    const past = Math.min((time - (this.lastTime ?? time)) / 1000, LONGEST_PAST_S);
    const dt = Math.min(past, LONGEST_STEP_S);
    this.lastTime = time;
    if (this.held) return;
    if (this.begun) this.step(dt, past);
    this.city.update(this.walker.feet);
    if (!this.begun || !this.changed()) return; // drawing nothing takes as long as drawing a city
    this.stage.pace(this.still === 0 ? dt : 0);
    this.draw();
  }

  /** `dt` is how long one walks, `past` how long one flies: a slow machine flies no slower. */
  step(dt, past = dt) {
    if (this.input.used) document.body.classList.add('walked');
    const goal = this.flying ? 1 : 0;
    const left = Math.abs(goal - this.height);
    this.height += Math.sign(goal - this.height) * Math.min(left, dt / FLIGHT_S);
    if (this.flying) this.bird.step(dt, this.input);
    else this.walker.step(dt, this.input, this.city.walls);
    this.guide.step(past);
    this.aim();
    this.said += dt;
    this.quiet -= dt;
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
      ...camera.matrixWorld.elements, ...camera.projectionMatrix.elements, city.loaded,
      city.tiles.loadProgress, shown.evidence.value, this.chosen, innerWidth, innerHeight,
      city.tiles.visibleTiles.size, this.guide.then.on,
    ].join();
    const same = state === this.state;
    this.state = state;
    this.still = same ? this.still + 1 : 0;
    return this.still < SETTLING_FRAMES;
  }

  /** Sees to it that the next frame is drawn. */
  wake() {
    this.state = null;
  }

  aim() {
    const { camera } = this.stage;
    this.walker.aim(camera);
    let view = viewOf(camera, this.fov);
    if (this.height > 0) {
      this.bird.aim(camera);
      view = between(view, viewOf(camera, this.stage.lens.fov), MathUtils.smootherstep(this.height, 0, 1));
    }
    this.stage.reach(this.height);
    show(camera, this.guide.over(view));
  }

  /** What the camera shows now. */
  view() {
    this.aim();
    return shownBy(this.stage.camera);
  }

  draw() {
    const { then } = this.guide;
    this.stage.draw(this.height, this.walker.feet, { over: then.on, low: then.low });
    this.minimap.draw(this.walker.pose, this.city, this.stage, this.chosen, shown.evidence.value);
    const progress = Math.round(this.city.tiles.loadProgress * 100);
    $('progress').setAttribute('aria-valuenow', progress);
    $('progress').firstElementChild.style.width = `${progress}%`;
  }

  /** Says where one is, on the page and in the address bar. */
  tell() {
    const hit = this.flying ? null : faced(this.city, this.stage.camera.position, this.walker.yaw);
    const shot = this.guide.then.on ? this.city.buildings.get(this.chosen) : null;
    const place = this.flying ? 'From above' : where(hit, this.stage.streetAt(this.walker.feet));
    const text = shot ? `As ${nameOf(shot.record)} was photographed` : place;
    if (this.quiet <= 0 && $('place').textContent !== text) $('place').textContent = text;
    this.credit.show((this.chosen ? this.city.buildings.get(this.chosen) : hit)?.record ?? null);
    const hash = toHash({
      pose: this.walker.pose,
      building: this.chosen,
      then: this.guide.then.key,
      evidence: shown.evidence.value > 0,
      bird: this.flying,
    });
    if (hash !== location.hash) history.replaceState(null, '', hash);
  }

  /** Says something for a while where else the place is told. */
  say(text) {
    $('place').textContent = text;
    this.quiet = SAID_S;
  }

  /** The building that is faced, or null. */
  faces() {
    const hit = faced(this.city, this.stage.camera.position, this.walker.yaw);
    return hit ? String(hit.record.id) : null;
  }

  /** The building at a point of the view, both coordinates from -1 to 1; or null. */
  pick(x, y) {
    this.aim();
    return picked(this.city, this.stage.camera, x, y);
  }

  /** Stands somewhere; a wider view than usual stays until one walks. */
  stand(pose) {
    this.walker.pose = pose;
    this.fov = pose.fov ?? this.stage.lens.fov;
    this.aim();
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
    this.wake();
  }

  /** Whether a photograph lies over the model. */
  showing(on) {
    document.body.classList.toggle('then', on);
    this.press('KeyT', on);
    this.guide.then.fit();
    this.wake();
  }

  setEvidence(on) {
    shown.evidence.value = on ? 1 : 0;
    $('legend').hidden = !on;
    this.press('KeyE', on);
  }

  setBird(on, now = calm()) {
    if (on && !this.flying) {
      this.bird.frame(corners(this.city, this.stage.box, this.walker.feet), this.stage.camera, bestAzimuth(this.city, this.walker.yaw));
    }
    this.flying = on;
    if (now) this.height = on ? 1 : 0;
    document.body.classList.toggle('bird', on);
    this.press('KeyB', on);
  }

  click(x, y) {
    const found = this.pick(x, y);
    if (found) this.select(String(found.id), found.evidence);
    else this.panel.close();
  }

  /** Saves a picture of the view. */
  shoot() {
    return shoot($('view'), () => this.draw(), this.city.record.title, $('credit').textContent);
  }

  press(code, on) {
    document.querySelector(`#tools [data-key=${code}]`).setAttribute('aria-pressed', on);
  }

  resize() {
    this.stage.fit(innerWidth, innerHeight);
    this.fov = this.stage.lens.fov;
    this.guide.then.fit();
    this.city.resize(this.stage.renderer);
  }
}
