// Keys, mouse and fingers, gathered into intentions: where to walk, how to turn.

const WALK = { KeyW: [0, 1], ArrowUp: [0, 1], KeyS: [0, -1], ArrowDown: [0, -1], KeyA: [-1, 0], KeyD: [1, 0] };
const TURN = { ArrowLeft: 1, ArrowRight: -1 };
const SLIDES = /^(Arrow|Home|End|Page)/; // keys that a slider wants for itself
const CLICK_PX = 6; // a press that moves less is a click
const PINCH_PX = 26; // two fingers closing by so much are a notch of the wheel
const ZOOM = { Equal: -1, NumpadAdd: -1, Minus: 1, NumpadSubtract: 1 };

export class Input {
  constructor(canvas, stick) {
    this.canvas = canvas;
    this.keys = new Set();
    this.look = [0, 0]; // pixels turned since last asked
    this.zoom = 0; // notches since last asked
    this.stick = [0, 0];
    this.used = false; // has anybody done anything yet?
    this.onClick = () => {};
    this.onMove = () => {}; // somebody walks or looks round
    this.onKey = () => {};
    this.#keyboard();
    this.#pointer();
    this.#touchStick(stick);
  }

  /** Right and forward, each from -1 to 1. */
  get move() {
    const sum = [...this.stick];
    for (const key of this.keys) {
      const way = WALK[key];
      if (way) for (const i of [0, 1]) sum[i] += way[i];
    }
    return sum.map((v) => Math.max(-1, Math.min(1, v)));
  }

  /** Left is 1, right is -1. */
  get turn() {
    return [...this.keys].reduce((sum, key) => sum + (TURN[key] ?? 0), 0);
  }

  get hurried() {
    return this.keys.has('ShiftLeft') || this.keys.has('ShiftRight');
  }

  /** What the pointer did since the last call. */
  taken() {
    const { look, zoom } = this;
    this.look = [0, 0];
    this.zoom = 0;
    return { look, zoom };
  }

  toggleLock() {
    if (document.pointerLockElement) document.exitPointerLock();
    else this.canvas.requestPointerLock?.();
  }

  #keyboard() {
    const typing = (target) => target.closest?.('input:not([type=range]), textarea, select, dialog');
    const sliding = ({ target, code }) => target.type === 'range' && SLIDES.test(code);
    addEventListener('keydown', (event) => {
      if (typing(event.target) || sliding(event) || event.ctrlKey || event.metaKey || event.altKey) return;
      const known = event.code in WALK || event.code in TURN;
      const scrolls = event.target.closest?.('aside') && event.code.startsWith('Arrow');
      if (known && !scrolls) {
        event.preventDefault();
        this.keys.add(event.code);
        this.used = true;
        if (!event.repeat) this.onMove();
      } else if (event.code in ZOOM) this.zoom += ZOOM[event.code];
      else if (event.code.startsWith('Shift')) this.keys.add(event.code);
      else if (!event.repeat) this.onKey(event);
    });
    addEventListener('keyup', (event) => this.keys.delete(event.code));
    addEventListener('blur', () => this.keys.clear());
  }

  #pointer() {
    const down = new Map(); // pointer id -> where it is
    let travelled = 0;
    const { canvas } = this;
    const spread = () => {
      const [a, b] = [...down.values()];
      return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
    };
    canvas.addEventListener('pointerdown', (event) => {
      down.set(event.pointerId, [event.clientX, event.clientY]);
      travelled = down.size > 1 ? CLICK_PX : 0; // two fingers never click
      this.used = true;
      canvas.setPointerCapture?.(event.pointerId);
      canvas.focus();
    });
    canvas.addEventListener('pointermove', (event) => {
      if (document.pointerLockElement) {
        this.look[0] -= event.movementX;
        this.look[1] -= event.movementY;
        return;
      }
      const last = down.get(event.pointerId);
      if (!last) return;
      const before = spread();
      const here = [event.clientX, event.clientY];
      down.set(event.pointerId, here);
      const still = travelled < CLICK_PX;
      travelled += Math.abs(here[0] - last[0]) + Math.abs(here[1] - last[1]);
      if (still && travelled >= CLICK_PX) this.onMove();
      if (before) this.zoom += (before - spread()) / PINCH_PX;
      else this.look = [this.look[0] + here[0] - last[0], this.look[1] + here[1] - last[1]];
    });
    const up = (event) => down.delete(event.pointerId);
    canvas.addEventListener('pointerup', (event) => {
      if (!up(event) || travelled >= CLICK_PX) return;
      const locked = Boolean(document.pointerLockElement);
      const box = canvas.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * 2 - 1;
      const y = 1 - ((event.clientY - box.top) / box.height) * 2;
      this.onClick(locked ? 0 : x, locked ? 0 : y);
    });
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom += Math.sign(event.deltaY);
    }, { passive: false });
  }

  #touchStick(stick) {
    const centre = () => {
      const box = stick.getBoundingClientRect();
      return [box.x + box.width / 2, box.y + box.height / 2, box.width / 2];
    };
    const set = (event) => {
      const [x, y, radius] = centre();
      this.stick = [(event.clientX - x) / radius, (y - event.clientY) / radius];
      const length = Math.hypot(...this.stick);
      if (length > 1) this.stick = this.stick.map((v) => v / length);
      stick.style.setProperty('--x', this.stick[0]);
      stick.style.setProperty('--y', -this.stick[1]);
    };
    const rest = () => {
      this.stick = [0, 0];
      stick.style.setProperty('--x', 0);
      stick.style.setProperty('--y', 0);
    };
    stick.addEventListener('pointerdown', (event) => {
      stick.setPointerCapture(event.pointerId);
      this.onMove();
      set(event);
    });
    stick.addEventListener('pointermove', (event) => stick.hasPointerCapture(event.pointerId) && set(event));
    for (const end of ['pointerup', 'pointercancel']) stick.addEventListener(end, rest);
  }
}
