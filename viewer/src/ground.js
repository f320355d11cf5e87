// The ground is drawn, not photographed: streets, kerbs, sidewalks, yards, and the soft
// shade where a wall meets the ground.

import {
  BufferGeometry, Color, Float32BufferAttribute, Mesh, PlaneGeometry, ShaderMaterial, Shape,
  ShapeGeometry, UniformsLib, UniformsUtils, Path, DoubleSide,
} from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';

import { anticlockwise, hull, widened } from './outline.js';

export const KERB_M = 0.15;
export const SIDEWALK_M = 4; // a New York sidewalk of 13 feet
const KERBSTONE_M = 0.22;
const SHADE_M = 1.4;
const KIND = { street: 0, sidewalk: 1, kerb: 2, face: 3, yard: 4 };

/** The street plane, wide enough that fog hides its end. */
export function street() {
  const plane = new PlaneGeometry(9000, 9000).rotateX(-Math.PI / 2).translate(0, -KERB_M, 0);
  return new Mesh(of('street', plane), stone());
}

/**
 * Sidewalks, kerbs and yards of one block. `outlines` are rows of [x, z].
 *
 * Returns `{ parts, walks }`: geometries for `paved`, and the outlines within which feet
 * stand raised.
 */
export function pavement(outlines) {
  const parts = [];
  const walks = [];
  for (const outline of outlines) {
    const lots = anticlockwise(outline.map(([x, z]) => [x, -z])); // y up, as outlines want
    const kerb = widened(lots, SIDEWALK_M);
    const inner = widened(lots, SIDEWALK_M - KERBSTONE_M);
    const turn = bearing(lots);
    parts.push(flat(inner, lots, 'sidewalk', turn), flat(kerb, inner, 'kerb', turn));
    parts.push(flat(lots, null, 'yard', turn), face(kerb));
    walks.push(kerb.map(([x, y]) => [x, -y]));
  }
  return { parts, walks };
}

/** One mesh, and so one draw call, of the pavement of many blocks. */
export function paved(parts) {
  return new Mesh(mergeGeometries(parts), stone());
}

/** An outline for a block whose record has none: the hull of its walls. */
export function outlineOf(shapes) {
  return hull(shapes.flatMap(({ walls }) => walls.flatMap(({ a, b }) => [a, b])));
}

/** The shade at the foot of each wall that reaches the ground. */
export function shade(walls) {
  const position = [];
  const depth = [];
  const y = 0.012;
  for (const { a, b, out, bottom } of walls) {
    if (bottom > 0.5) continue;
    const far = ([x, z]) => [x + out[0] * SHADE_M, z + out[1] * SHADE_M];
    const [c, d] = [far(b), far(a)];
    for (const [p, s] of [[a, 1], [b, 1], [c, 0], [a, 1], [c, 0], [d, 0]]) {
      position.push(p[0], y, p[1]);
      depth.push(s);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(position, 3));
  geometry.setAttribute('depth', new Float32BufferAttribute(depth, 1));
  const material = new ShaderMaterial({
    vertexShader: SHADE_VERTEX,
    fragmentShader: SHADE_FRAGMENT,
    transparent: true,
    depthWrite: false,
    side: DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: -2,
    polygonOffsetUnits: -8,
  });
  return new Mesh(geometry, material);
}

/** The direction of the longest edge, along which flagstones lie. */
function bearing(outline) {
  let best = [1, 0];
  outline.forEach((p, i) => {
    const q = outline[(i + 1) % outline.length];
    const edge = [q[0] - p[0], q[1] - p[1]];
    if (Math.hypot(...edge) > Math.hypot(...best)) best = edge;
  });
  return Math.atan2(best[1], best[0]);
}

function flat(outer, hole, kind, turn) {
  const shape = new Shape(outer.map(([x, y]) => ({ x, y })));
  if (hole) shape.holes.push(new Path(hole.map(([x, y]) => ({ x, y }))));
  const geometry = new ShapeGeometry(shape);
  const { position } = geometry.attributes;
  const [c, s] = [Math.cos(turn), Math.sin(turn)];
  const uv = [];
  for (let i = 0; i < position.count; i++) {
    const [x, y] = [position.getX(i), position.getY(i)];
    uv.push(c * x + s * y, c * y - s * x);
  }
  geometry.setAttribute('uv', new Float32BufferAttribute(uv, 2));
  return of(kind, geometry.rotateX(-Math.PI / 2));
}

/** A geometry without index whose vertices say what they are of. */
function of(kind, geometry) {
  const plain = geometry.index ? geometry.toNonIndexed() : geometry;
  plain.deleteAttribute('normal');
  const kinds = new Float32Array(plain.attributes.position.count).fill(KIND[kind]);
  plain.setAttribute('kind', new Float32BufferAttribute(kinds, 1));
  return plain;
}

/** The upright side of the kerb. */
function face(outline) {
  const position = [];
  outline.forEach(([x, y], i) => {
    const [u, v] = outline[(i + 1) % outline.length];
    const [a, b] = [[x, 0, -y], [u, 0, -v]];
    const [c, d] = [[u, -KERB_M, -v], [x, -KERB_M, -y]];
    for (const p of [d, c, b, d, b, a]) position.push(...p);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(position, 3));
  geometry.setAttribute('uv', new Float32BufferAttribute(new Float32Array((position.length / 3) * 2), 2));
  return of('face', geometry);
}

let material = null;

function stone() {
  material ??= new ShaderMaterial({
    uniforms: UniformsUtils.merge([UniformsLib.fog, { tone: { value: new Color(1, 0.985, 0.96) } }]),
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    fog: true,
  });
  return material;
}

const VERTEX = `
#include <common>
#include <fog_pars_vertex>
attribute float kind;
varying vec2 vStone;
varying vec2 vGround;
varying float vKind;
void main() {
  vKind = kind;
  vec4 world = modelMatrix * vec4(position, 1.0);
  vGround = world.xz;
  vStone = uv;
  vec4 mvPosition = viewMatrix * world;
  gl_Position = projectionMatrix * mvPosition;
  #include <fog_vertex>
}
`;

const FRAGMENT = `
#include <common>
#include <fog_pars_fragment>
uniform vec3 tone;
varying vec2 vStone;
varying vec2 vGround;
varying float vKind;
float hash(vec2 p) { p = fract(p * vec2(123.34, 456.21)); p += dot(p, p + 45.32); return fract(p.x * p.y); }
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}
float grain(vec2 p, float size) {
  float fade = 1.0 - smoothstep(0.3, 1.2, max(fwidth(p.x), fwidth(p.y)) / size);
  return fade <= 0.0 ? 0.0 : fade * (noise(p / size) - 0.5);
}
float joint(float at, float every, float half_m) {
  float wide = fwidth(at);
  float d = abs(fract(at / every + 0.5) - 0.5) * every;
  float fade = 1.0 - smoothstep(0.2, 0.7, wide / every);
  return fade * (1.0 - smoothstep(half_m, half_m + wide * 1.3, d));
}
void main() {
  float g = 0.24; // the kerb's face
  int kind = int(vKind + 0.5);
  // widths of pixels are asked for outside the branches, where all have them
  float wide = fwidth(vStone.x) + fwidth(vStone.y);
  vec2 joints = vec2(joint(vStone.x, 1.52, 0.008), joint(vStone.y, 1.52, 0.008));
  float edge = joint(vStone.x + vStone.y, 2.4, 0.008);
  float fine = grain(vGround, 0.05), small = grain(vGround, 0.09), rough = grain(vGround, 0.4);
  if (kind == 0) {
  g = 0.20 + 0.025 * grain(vGround, 9.0) + 0.03 * grain(vGround.yx, 2.3) + 0.05 * fine
    + 0.03 * rough;
  } else if (kind == 1) {
  vec2 flag = floor(vStone / vec2(1.52, 1.52));
  float far = 1.0 - smoothstep(0.15, 0.6, wide);
  g = 0.385 + 0.045 * far * (hash(flag) - 0.5) + 0.05 * grain(vGround, 3.1) + 0.04 * fine;
  g *= 1.0 - 0.32 * max(joints.x, joints.y);
  } else if (kind == 2) {
  g = (0.46 + 0.05 * small) * (1.0 - 0.3 * edge);
  } else if (kind == 4) {
  g = 0.17 + 0.07 * grain(vGround, 2.0) + 0.04 * rough;
  }
  gl_FragColor = vec4(tone * g, 1.0);
  #include <colorspace_fragment>
  #ifdef USE_FOG
  // level ground is seen at so flat an angle that haze has to come sooner
  float haze = 1.0 - exp(-fogDensity * fogDensity * vFogDepth * vFogDepth * 7.0);
  gl_FragColor.rgb = mix(gl_FragColor.rgb, fogColor, haze);
  #endif
}
`;

const SHADE_VERTEX = `
attribute float depth;
varying float vDepth;
void main() { vDepth = depth; gl_Position = projectionMatrix * viewMatrix * modelMatrix * vec4(position, 1.0); }
`;

const SHADE_FRAGMENT = `
varying float vDepth;
void main() { gl_FragColor = vec4(0.02, 0.02, 0.02, 0.42 * vDepth * vDepth); }
`;
