// Leads about the city: before a building, to where a photographer stood, along a tour, to
// what a link names.

import { Vector3 } from 'three';

import { even } from './lens.js';
import { contains } from './outline.js';
import { fromHash } from './pose.js';
import { Then, photoOf } from './then.js';
import { Tour, route } from './tour.js';
import { poseBefore } from './vantage.js';
import { Flight } from './view.js';
import { nameOf } from './words.js';

const $ = (id) => document.getElementById(id);
const FLIGHT_S = 1.8;

/** Whether somebody asked for less motion. */
export const calm = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

export class Guide {
  constructor(page) {
    this.page = page;
    page.city.holds = () => [page.chosen, this.awaited].filter(Boolean);
    this.flight = new Flight();
    this.awaited = null; // the building to stand before once its model is there
    this.sought = null; // the building whose record is awaited
    this.then = new Then(
      { picture: $('picture'), bar: $('then') },
      { onSlide: () => page.wake(), onLeave: () => this.back() },
    );
    this.tour = new Tour($('tour'), {
      onVisit: ({ id }) => {
        this.seek(id, { fly: true, mark: true });
      },
      onStop: () => page.press('KeyR', false),
    });
  }

  /** Sees to it that the way from here to where one will be is flown. */
  #depart(seconds = FLIGHT_S, onArrival = () => {}) {
    this.page.wake();
    this.flight.depart(this.page.view(), calm() ? 0 : seconds, onArrival);
  }

  /** Visits a building of which nothing may be known yet; whoever moves meanwhile stays. */
  seek(id, { mark = false, ...how } = {}) {
    const { page } = this;
    const go = () => this.visit(id, how) && mark && page.mark(id);
    this.sought = id;
    if (page.city.buildings.has(id)) go();
    else page.city.find(id).then(() => this.sought === id && go(), (error) => page.say(error.message));
  }

  /** Follows a link, of whose building nothing may be known yet; tells whether it leads anywhere. */
  async open(hash) {
    const { page } = this;
    const { building } = fromHash(hash);
    this.sought = building;
    const trouble = building === null ? null : await page.city.find(building).then(() => null, ({ message }) => message);
    if (this.sought !== building) return false;
    const leads = this.follow(hash);
    if (trouble) page.say(trouble);
    return leads;
  }

  /** Stands before a building, by its footprint until its model is there. */
  visit(id, { show = false, fly = false } = {}) {
    const { page } = this;
    const found = page.city.buildings.get(id);
    if (!found) return false;
    if (fly) this.#depart();
    this.#drop();
    page.setBird(false);
    const pose = poseBefore(page.city, found, page.stage.lens);
    if (pose) page.stand(pose);
    this.awaited = found.shape ? null : id;
    if (show) page.select(id);
    return true;
  }

  /** A block's models have come: whoever waited for one of its buildings stands there anew. */
  came(block) {
    const { awaited, page } = this;
    if (!awaited || page.city.buildings.get(awaited)?.block !== block) return;
    if (this.wanted) this.enter(awaited, this.wanted);
    else this.visit(awaited);
  }

  /** Goes to where the photographer of a building stood, or back from there. */
  toggle() {
    if (this.then.on) {
      this.back();
      return;
    }
    const { page } = this;
    const id = page.chosen ?? page.faces();
    if (!id || !this.enter(id)) page.say(id
      ? `No photograph of ${nameOf(page.city.buildings.get(id).record)} tells where it was taken from.`
      : 'Stand before a building first.');
  }

  /** Stands where a photo of a building was taken: the photo named, or else the first. */
  enter(id, key = null) {
    const { page } = this;
    const found = page.city.buildings.get(id);
    const photo = photoOf(found, key);
    const frame = found && page.city.frames.get(found.block.name);
    if (!photo || !frame) return false;
    this.#depart(FLIGHT_S, () => this.then.arrived());
    page.setBird(false);
    this.tour.pause(true);
    this.then.enter(photo, found, frame);
    if (!this.flight.on) this.then.arrived();
    page.stand(this.#feet(found));
    this.awaited = found.shape ? null : id;
    this.wanted = found.shape ? null : photo.key;
    page.mark(id);
    page.showing(true);
    return true;
  }

  /** Where one stands after looking: on the photographer's spot, unless a building is there. */
  #feet(found) {
    const { page, then } = this;
    const { position, quaternion } = then.station;
    const at = [position.x, position.z];
    const within = ({ shape }) => shape?.roofs.some((roof) => contains(roof, at));
    if (page.city.near(at, 0).some(within)) {
      return poseBefore(page.city, found, page.stage.lens) ?? page.walker.pose;
    }
    const ahead = new Vector3(0, 0, -1).applyQuaternion(quaternion);
    return {
      x: position.x,
      z: position.z,
      yaw: (Math.atan2(-ahead.x, -ahead.z) * 180) / Math.PI,
      pitch: (Math.asin(ahead.y) * 180) / Math.PI,
    };
  }

  /** Back from the photographer's spot to one's own eyes. */
  back() {
    if (!this.then.on) return;
    this.#depart(FLIGHT_S / 3);
    this.#drop();
  }

  #drop() {
    this.wanted = null;
    if (!this.then.on) return;
    this.then.leave();
    this.page.showing(false);
  }

  /** Starts or ends the tour of the best-photographed fronts. */
  lead() {
    const { page, tour } = this;
    if (tour.on) {
      tour.stop();
      return;
    }
    const { x, z } = page.walker.pose;
    const stops = (page.city.record.tour ?? []).map((stop) => ({ ...stop, at: page.city.placeOf(stop) })).filter(({ at }) => at);
    tour.start(route(stops, [x, z]), calm());
    if (tour.on) page.press('KeyR', true);
    else page.say('No photograph of this city can be shown.');
  }

  /** Anybody who moves leaves the tour and the photographer's spot. */
  moved() {
    this.tour.stop();
    this.back();
    this.awaited = this.wanted = this.sought = null;
  }

  /** Shows what a link names: a pose, a building, a photograph, or several; tells whether it leads anywhere. */
  follow(hash) {
    const { page } = this;
    const { pose, building, then, evidence, bird } = fromHash(hash);
    page.setEvidence(evidence);
    const known = building !== null && page.city.buildings.has(building);
    if (building !== null && !known) page.say(`This city has no building ${building.slice(0, 40)}.`);
    this.#drop();
    page.setBird(bird, true);
    if (pose) page.stand(pose);
    else if (known && !bird) this.visit(building);
    if (known) page.select(building);
    else page.panel.close();
    if (known && then) this.enter(building, then);
    return pose !== null || known;
  }

  step(dt) {
    this.flight.step(dt);
    this.tour.step(dt);
  }

  /** What is to be seen, given what the walker or the bird sees. */
  over(view) {
    const { then } = this;
    const goal = then.on ? { ...then.station, frustum: then.frustum ?? even(50, 1) } : view;
    return this.flight.over(goal);
  }
}
