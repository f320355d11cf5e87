// A tour: the best-photographed fronts, as site.json names them, in an order that makes a short walk.

/**
 * The best `most` of `stops` (`{ id, worth, at: [x, z] }`), from the one nearest to `from`
 * always on to the nearest that is left.
 */
export function route(stops, from, most = 12) {
  const left = stops.filter((stop) => stop.worth > 0)
    .sort((p, q) => q.worth - p.worth || (p.id < q.id ? -1 : 1))
    .slice(0, most);
  const way = [];
  let here = from;
  while (left.length) {
    const far = left.map(({ at }) => Math.hypot(at[0] - here[0], at[1] - here[1]));
    const [next] = left.splice(far.indexOf(Math.min(...far)), 1);
    way.push(next);
    here = next.at;
  }
  return way;
}

const STAY_S = 7;

/** Leads from stop to stop; `visit(stop)` goes there. */
export class Tour {
  constructor(bar, { onStop, onVisit }) {
    this.bar = bar;
    this.onStop = onStop;
    this.onVisit = onVisit;
    this.stops = [];
    this.place = -1;
    this.paused = false;
    this.stayed = 0;
    this.words = bar.querySelector('p');
    const act = {
      back: () => this.go(-1), on: () => this.go(1), pause: () => this.pause(!this.paused), stop: () => this.stop(),
    };
    for (const button of bar.querySelectorAll('button')) {
      button.addEventListener('click', act[button.dataset.act]);
    }
  }

  get on() {
    return this.place >= 0;
  }

  start(stops, paused) {
    this.stops = stops;
    this.place = stops.length - 1;
    if (!stops.length) return;
    this.bar.hidden = false;
    this.pause(paused);
    this.go(1);
  }

  go(by) {
    this.place = (this.place + by + this.stops.length) % this.stops.length;
    this.stayed = 0;
    const stop = this.stops[this.place];
    this.words.textContent = `${this.place + 1} of ${this.stops.length}: ${stop.name}`;
    this.onVisit(stop);
  }

  pause(on) {
    this.paused = on;
    const button = this.bar.querySelector('[data-act=pause]');
    button.setAttribute('aria-pressed', on);
  }

  step(dt) {
    if (!this.on || this.paused) return;
    this.stayed += dt;
    if (this.stayed > STAY_S) this.go(1);
  }

  stop() {
    if (!this.on) return;
    this.place = -1;
    this.bar.hidden = true;
    this.onStop();
  }
}
