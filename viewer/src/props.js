// Things of known size, drawn to show how large a street is: figures of 1.7 m, lamp posts
// and motor cars as they stood about 1940. They are drawn, not photographed; the legend
// says so.

import {
  BoxGeometry, Color, CylinderGeometry, Float32BufferAttribute, Group, InstancedMesh, Matrix4,
  MeshBasicMaterial, SphereGeometry, Vector3,
} from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';

import { KERB_M } from './ground.js';

const NEAR_M = 170; // only so near are they drawn
const MOVED_M = 25; // then they are gathered anew
const MOST = 240; // of a kind
const LAMPS_M = 34; // apart
const SUN = new Vector3(-0.45, 0.75, 0.5).normalize();

/** Where things stand along a kerb: rows of `{ kind, x, y, z, yaw }`. `outline` is of [x, z]. */
export function along(outline) {
  const things = [];
  const middle = [0, 1].map((i) => outline.reduce((sum, p) => sum + p[i], 0) / outline.length);
  outline.forEach(([ax, az], i) => {
    const [bx, bz] = outline[(i + 1) % outline.length];
    const length = Math.hypot(bx - ax, bz - az);
    if (length < 16) return;
    const way = [(bx - ax) / length, (bz - az) / length];
    let out = [way[1], -way[0]];
    if (out[0] * ((ax + bx) / 2 - middle[0]) + out[1] * ((az + bz) / 2 - middle[1]) < 0) out = [-out[0], -out[1]];
    const put = (kind, s, off, y, turn) => things.push({
      kind, x: ax + way[0] * s + out[0] * off, y, z: az + way[1] * s + out[1] * off, yaw: turn,
    });
    const yaw = Math.atan2(-out[0], -out[1]);
    for (let s = 9; s < length - 6; s += LAMPS_M) put('lamp', s, -0.55, 0, yaw);
    const draw = dice(ax * 7.1 + az * 3.3 + bx);
    if (length > 30) put('car', 14 + draw() * (length - 28), 1.25, -KERB_M, yaw);
    const figures = Math.min(3, Math.floor(length / 35));
    for (let n = 0; n < figures; n++) {
      put('figure', 4 + draw() * (length - 8), -1.3 - draw() * 1.2, 0, draw() * 2 * Math.PI);
    }
  });
  return things;
}

/** Numbers from 0 to 1 that follow from a number, so that a city looks the same each time. */
function dice(seed) {
  let state = Math.abs(Math.floor(seed * 1000)) % 2147483647 || 1;
  return () => {
    state = (state * 48271) % 2147483647;
    return state / 2147483647;
  };
}

export class Props {
  constructor() {
    this.group = new Group();
    this.at = null;
    this.known = 0; // outlines
    this.things = [];
    const material = new MeshBasicMaterial({ vertexColors: true });
    this.kinds = Object.fromEntries(Object.entries({ lamp: lamp(), car: car(), figure: figure() }).map(([kind, shape]) => {
      const mesh = new InstancedMesh(shape, material, MOST);
      mesh.frustumCulled = false;
      mesh.count = 0;
      this.group.add(mesh);
      return [kind, mesh];
    }));
  }

  /** Puts up what stands near `feet`; `raised` are the kerbs of all blocks. */
  gather({ x, z }, raised) {
    if (this.at && raised.length === this.known && Math.hypot(x - this.at[0], z - this.at[1]) < MOVED_M) return;
    for (; this.known < raised.length; this.known++) this.things.push(...along(raised[this.known]));
    this.at = [x, z];
    const near = this.things.filter((one) => Math.hypot(one.x - x, one.z - z) < NEAR_M);
    const turned = new Matrix4();
    for (const [kind, mesh] of Object.entries(this.kinds)) {
      const own = near.filter((one) => one.kind === kind).slice(0, MOST);
      own.forEach((one, i) => mesh.setMatrixAt(i, turned.makeRotationY(one.yaw).setPosition(one.x, one.y, one.z)));
      mesh.count = own.length;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }
}

/** One geometry of parts, each with its gray, shaded as if the sun stood in the south-west. */
function shaded(parts) {
  return mergeGeometries(parts.map(([geometry, tone]) => {
    const plain = geometry.index ? geometry.toNonIndexed() : geometry;
    plain.deleteAttribute('uv');
    const { normal } = plain.attributes;
    const color = [];
    for (let i = 0; i < normal.count; i++) {
      const light = 0.72 + 0.4 * Math.max(0, new Vector3().fromBufferAttribute(normal, i).dot(SUN));
      color.push(...new Color().setScalar(tone * light).toArray());
    }
    plain.setAttribute('color', new Float32BufferAttribute(color, 3));
    plain.deleteAttribute('normal');
    return plain;
  }));
}

const box = (w, h, d, x, y, z) => new BoxGeometry(w, h, d).translate(x, y, z);
const rod = (r0, r1, h, x, y, z, sides = 7) => new CylinderGeometry(r1, r0, h, sides).translate(x, y + h / 2, z);

/** A figure of 1.70 m in coat and hat. */
function figure() {
  return shaded([
    [rod(0.075, 0.09, 0.5, -0.09, 0, 0.02), 0.05],
    [rod(0.075, 0.09, 0.5, 0.09, 0, -0.04), 0.05],
    [rod(0.24, 0.19, 0.62, 0, 0.42, 0, 9), 0.075],
    [rod(0.19, 0.15, 0.42, 0, 1.02, 0, 9), 0.08],
    [rod(0.06, 0.05, 0.55, -0.235, 0.82, 0), 0.07],
    [rod(0.06, 0.05, 0.55, 0.235, 0.82, 0), 0.07],
    [new SphereGeometry(0.105, 9, 7).translate(0, 1.535, 0), 0.3],
    [rod(0.17, 0.17, 0.02, 0, 1.585, 0, 11), 0.06],
    [rod(0.11, 0.1, 0.1, 0, 1.6, 0, 11), 0.06],
  ]);
}

/** A bishop's-crook lamp post of 6.1 m; its arm reaches to -z, which is over the street. */
function lamp() {
  const at = (n) => [-0.5 + 0.5 * Math.cos((n / 8) * Math.PI), 5.5 + 0.6 * Math.sin((n / 8) * Math.PI)];
  const crook = Array.from({ length: 8 }, (_, n) => {
    const [[z0, y0], [z1, y1]] = [at(n), at(n + 1)];
    const part = new CylinderGeometry(0.035, 0.035, Math.hypot(z1 - z0, y1 - y0) + 0.03, 6);
    return [part.rotateX(Math.atan2(z1 - z0, y1 - y0)).translate(0, (y0 + y1) / 2, (z0 + z1) / 2), 0.06];
  });
  return shaded([
    [rod(0.2, 0.16, 0.5, 0, 0, 0, 8), 0.06],
    [rod(0.12, 0.05, 5.05, 0, 0.5, 0, 8), 0.065],
    ...crook,
    [rod(0.12, 0.05, 0.16, 0, 5.3, -1, 8), 0.06],
    [new SphereGeometry(0.14, 9, 7).translate(0, 5.24, -1), 0.72],
  ]);
}

/** A sedan of about 1938: 4.7 m long, 1.75 m wide and high, along x. */
function car() {
  const wheel = (x, z) => new CylinderGeometry(0.36, 0.36, 0.16, 12).rotateX(Math.PI / 2).translate(x, 0.36, z);
  const fender = (x, z) => new CylinderGeometry(0.46, 0.46, 0.28, 12, 1, false, 0, Math.PI).rotateX(Math.PI / 2)
    .rotateZ(Math.PI / 2).translate(x, 0.42, z);
  const cabin = tapered(box(2.3, 0.72, 1.4, 0.35, 1.38, 0), 1.02, 0.62, 0.84, 0.35);
  const glass = tapered(box(1.95, 0.42, 1.42, 0.35, 1.36, 0), 1.15, 0.74, 0.9, 0.35);
  return shaded([
    [box(4.1, 0.5, 1.3, 0.05, 0.78, 0), 0.055],
    [tapered(box(1.35, 0.42, 1.05, -1.45, 1.1, 0), 0.9, 0.9, 0.7, -1.45), 0.06],
    [tapered(box(0.9, 0.5, 1.25, 1.75, 1.1, 0), 0.85, 0.4, 0.8, 1.45), 0.055],
    [cabin, 0.05],
    [glass, 0.17],
    [box(2.2, 0.08, 1.68, 0.2, 0.42, 0), 0.04],
    ...[[-1.45, 0.7], [-1.45, -0.7], [1.4, 0.7], [1.4, -0.7]].flatMap(([x, z]) => [
      [wheel(x, z), 0.025], [fender(x, z), 0.045],
    ]),
    [box(0.1, 0.16, 1.7, -2.3, 0.5, 0), 0.4],
    [box(0.1, 0.16, 1.7, 2.35, 0.5, 0), 0.35],
    [box(0.06, 0.5, 0.5, -2.14, 0.98, 0), 0.32],
    [new SphereGeometry(0.13, 8, 6).translate(-1.95, 0.95, 0.55), 0.55],
    [new SphereGeometry(0.13, 8, 6).translate(-1.95, 0.95, -0.55), 0.55],
  ]);
}

/** A box whose top is narrower: by `along` and `across`, about x = `middle`. */
function tapered(geometry, bottom, along, across, middle) {
  const { position } = geometry.attributes;
  geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox;
  for (let i = 0; i < position.count; i++) {
    const up = (position.getY(i) - min.y) / (max.y - min.y);
    position.setX(i, middle + (position.getX(i) - middle) * (bottom + (along - bottom) * up));
    position.setZ(i, position.getZ(i) * (1 + (across - 1) * up));
  }
  geometry.computeVertexNormals();
  return geometry;
}
