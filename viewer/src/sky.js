// A pale, even sky, as plates of the time recorded it.

import { BackSide, Color, Mesh, ShaderMaterial, SphereGeometry } from 'three';

export const HORIZON = new Color('#d3d0c8');
export const ZENITH = new Color('#989a99');

/** A dome round the camera; call `dome.position.copy(camera.position)` each frame. */
export function sky() {
  const material = new ShaderMaterial({
    side: BackSide,
    depthWrite: false,
    depthTest: false,
    uniforms: { horizon: { value: HORIZON }, zenith: { value: ZENITH } },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
  });
  const dome = new Mesh(new SphereGeometry(100, 32, 16), material);
  dome.renderOrder = -1;
  dome.frustumCulled = false;
  return dome;
}

const VERTEX = `
varying vec3 vWay;
void main() {
  vWay = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

const FRAGMENT = `
uniform vec3 horizon;
uniform vec3 zenith;
varying vec3 vWay;
float hash(vec2 p) { p = fract(p * vec2(123.34, 456.21)); p += dot(p, p + 45.32); return fract(p.x * p.y); }
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}
void main() {
  vec3 way = normalize(vWay);
  float up = max(way.y, 0.0);
  vec3 color = mix(horizon, zenith, pow(up, 0.6));
  vec2 at = way.xz / (way.y + 0.18) * 1.6;
  float cloud = 0.6 * noise(at) + 0.3 * noise(at * 2.3 + 7.0) + 0.1 * noise(at * 5.1);
  color += 0.16 * smoothstep(0.42, 0.8, cloud) * smoothstep(0.02, 0.3, up);
  color += (hash(gl_FragCoord.xy) - 0.5) / 200.0; // against banding
  gl_FragColor = vec4(color, 1.0);
  #include <colorspace_fragment>
}
`;
