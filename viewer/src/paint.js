// How the model's surfaces look: the photograph as it is, plain volumes as plaster in
// soft light, and, with evidence shown, a colour on whatever no camera saw.

import { MeshBasicMaterial, NearestFilter, NoColorSpace, Vector3, Vector4 } from 'three';

import { palette } from './evidence.js';

/** Shared by all materials: one switch for the whole city. */
export const shown = {
  evidence: { value: 0 },
  keys: { value: [] }, // see `unlock`
  palette: { value: palette().map((row) => new Vector4(...row)) },
  sun: { value: new Vector3(-0.45, 0.75, 0.5).normalize() },
};

/** Gives all materials the colours (0 to 255) of the evidence images' codes. */
export function unlock(keys) {
  shown.keys.value = keys.map((key) => new Vector3(...key).divideScalar(255));
}

/**
 * A loader extension: finds the material of the variant `evidence` (KHR_materials_variants)
 * and keeps its texture, whose colours stand for codes, beside the photograph's.
 */
export class EvidenceVariant {
  constructor(parser) {
    this.name = 'NOSTALGIN_evidence_variant';
    this.parser = parser;
  }

  async afterRoot({ scene }) {
    const names = this.parser.json.extensions?.KHR_materials_variants?.variants ?? [];
    const wanted = names.findIndex(({ name }) => name === 'evidence');
    const meshes = [];
    scene.traverse((object) => object.isMesh && meshes.push(object));
    await Promise.all(meshes.map((mesh) => this.#keep(mesh, wanted)));
  }

  async #keep(mesh, wanted) {
    const mappings = mesh.userData.gltfExtensions?.KHR_materials_variants?.mappings ?? [];
    const mapping = mappings.find(({ variants }) => variants.includes(wanted));
    if (!mapping) return;
    const { map } = await this.parser.getDependency('material', mapping.material);
    if (!map) return;
    map.colorSpace = NoColorSpace; // codes, not colours
    map.minFilter = map.magFilter = NearestFilter;
    map.generateMipmaps = false;
    mesh.userData.evidence = map;
  }
}

/** The city's own material for a block. */
export function surface({ material: { map, color, alphaTest }, userData: { evidence = null } }) {
  const material = new MeshBasicMaterial({ map, color, alphaTest });
  if (map) map.anisotropy = 8;
  material.defines = evidence ? { EVIDENCE: 1, KEYS: shown.keys.value.length } : {};
  const uniforms = { ...shown, evidenceMap: { value: evidence } };
  material.onBeforeCompile = (shader) => patch(shader, uniforms);
  material.customProgramCacheKey = () => `city${Boolean(map)}${Boolean(evidence)}`;
  return material;
}

function patch(shader, uniforms) {
  Object.assign(shader.uniforms, uniforms);
  shader.vertexShader = shader.vertexShader
    .replace('#include <common>', `#include <common>\nattribute float assumed;\n${VARYINGS}`)
    .replace('#include <project_vertex>', `#include <project_vertex>\n${VERTEX}`);
  shader.fragmentShader = shader.fragmentShader
    .replace('#include <common>', `#include <common>\n${VARYINGS}${DECLARATIONS}`)
    .replace('#include <map_fragment>', `#include <map_fragment>\n${FRAGMENT}`);
}

const VARYINGS = `
varying vec3 cityNormal;
varying vec3 cityPosition;
varying float cityAssumed;
`;

const VERTEX = `
cityNormal = mat3(modelMatrix) * normal;
cityPosition = (modelMatrix * vec4(transformed, 1.0)).xyz;
cityAssumed = assumed;
`;

const DECLARATIONS = `
uniform float evidence;
uniform vec4 palette[8];
uniform vec3 sun;
#ifdef EVIDENCE
uniform vec3 keys[KEYS];
uniform sampler2D evidenceMap;
int codeOf(vec3 key) {
  int best = 6;
  float least = 9.0;
  for (int i = 0; i < KEYS; i++) {
    vec3 off = key - keys[i];
    float far = dot(off, off);
    if (far < least) { least = far; best = i; }
  }
  return best;
}
#endif
`;

// A plain surface (nothing or assumed) is lit; a photograph brings its own light. A
// building that is assumed as a whole is hatched, as draughtsmen do.
const FRAGMENT = `
#ifdef EVIDENCE
int code = codeOf(texture2D(evidenceMap, vMapUv).rgb);
#else
int code = 6;
#endif
vec3 n = normalize(cityNormal);
bool roof = abs(n.y) > 0.5;
float hatch = 0.0;
float strength = 0.8;
if (code == 0 || code == 6) {
  float along = roof ? cityPosition.x + cityPosition.z
    : cityPosition.y + dot(cityPosition.xz, vec2(n.z, -n.x));
  float wide = fwidth(along);
  float line = abs(fract(along / 0.9) - 0.5) * 0.9;
  hatch = (1.0 - smoothstep(0.02, 0.02 + wide * 1.3, line)) * (1.0 - smoothstep(0.12, 0.45, wide));
  hatch *= cityAssumed;
  float light = 0.66 + 0.44 * max(dot(n, sun), 0.0);
  light *= roof ? 1.0 : mix(0.86, 1.0, smoothstep(0.0, 9.0, cityPosition.y));
  vec3 plaster = roof ? vec3(0.30, 0.295, 0.28) : mix(vec3(0.245, 0.24, 0.23), vec3(0.43, 0.42, 0.40), cityAssumed);
  diffuseColor.rgb = plaster * light * (1.0 - 0.16 * hatch);
  strength = (roof ? 0.34 : 0.5) + 0.3 * cityAssumed;
}
diffuseColor.rgb *= vec3(1.0, 0.985, 0.955); // the paper's tone
vec4 tint = palette[code];
float gray = dot(diffuseColor.rgb, vec3(0.2126, 0.7152, 0.0722));
vec3 tinted = tint.rgb * tint.rgb * (0.25 + 0.95 * sqrt(gray)) * (1.0 - 0.3 * hatch);
diffuseColor.rgb = mix(diffuseColor.rgb, tinted, evidence * tint.a * strength);
`;
