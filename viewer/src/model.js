// One mesh a block: a model comes as a node a building, which is a draw call each.

import { BufferAttribute, Mesh } from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';

import { ASSUMED, NOTHING, codeOf } from './evidence.js';

const SAMPLE_PX = 1024; // a survey reads the evidence atlas at no more than this

/**
 * Replaces all meshes of a loaded model by one, and returns it; null where there is none.
 * The ground of yards is let go: the viewer paves its own.
 *
 * Its `userData` holds `ids` (building id by feature number) and `evidence` (the texture);
 * each vertex says as `assumed` whether its whole building is.
 */
export function united(scene, assumed) {
  const parts = [];
  scene.traverse((mesh) => mesh.isMesh && mesh.geometry.attributes._feature_id_0 && parts.push(mesh));
  if (!parts.length) return null;
  const [first] = parts;
  const ids = idsOf(first, parts);
  const inverse = scene.matrixWorld.clone().invert();
  const geometries = parts.map((part) => {
    const geometry = part.geometry.clone();
    geometry.applyMatrix4(inverse.clone().multiply(part.matrixWorld));
    const flags = features(part).map((feature) => (assumed(ids[feature]) ? 1 : 0));
    geometry.setAttribute('assumed', new BufferAttribute(new Float32Array(flags), 1));
    return geometry;
  });
  const mesh = new Mesh(mergeGeometries(geometries), first.material);
  const { evidence } = first.userData;
  mesh.userData = { ids, evidence };
  const rest = [];
  scene.traverse((one) => one.isMesh && rest.push(one));
  for (const one of rest) one.removeFromParent();
  scene.add(mesh);
  return mesh;
}

/** The feature number of each vertex. */
function features({ geometry: { attributes: { _feature_id_0: numbers } } }) {
  return Array.from({ length: numbers.count }, (_, i) => numbers.getX(i));
}

/** The building id of each feature number, from the model's property table. */
function idsOf(mesh, parts) {
  const metadata = mesh.userData.structuralMetadata;
  const ids = [];
  for (const feature of new Set(parts.flatMap(features))) {
    const row = metadata?.getPropertyTableData(0, feature) ?? {};
    ids[feature] = String(row.id ?? row.building_id ?? feature);
  }
  return ids;
}

/**
 * A function that tells a mesh's evidence code at a texture coordinate, read once and so
 * for many of them. It holds megabytes: let go of it. `keys` are the colours of the codes.
 */
export function reader({ userData: { evidence } }, keys) {
  if (!evidence) return () => ASSUMED;
  const { image } = evidence;
  const scale = Math.min(1, SAMPLE_PX / Math.max(image.width, image.height));
  const [width, height] = [image.width, image.height].map((size) => Math.max(1, Math.round(size * scale)));
  const data = pixels(image, [0, 0, image.width, image.height], width, height);
  return (u, v) => coded(data, 4 * (texel(v, height) * width + texel(u, width)), keys);
}

/** A mesh's evidence code at one texture coordinate, to the texel; it keeps nothing. */
export function codeAt({ userData: { evidence } }, { x: u, y: v }, keys) {
  if (!evidence) return ASSUMED;
  const { image } = evidence;
  return coded(pixels(image, [texel(u, image.width), texel(v, image.height), 1, 1], 1, 1), 0, keys);
}

const texel = (share, size) => Math.min(size - 1, Math.max(0, Math.floor(share * size)));

const coded = (data, at, keys) => (data[at + 3] < 128 ? NOTHING : codeOf(keys, data[at], data[at + 1], data[at + 2]));

/** A part of an image at another size, red, green, blue, alpha; the nearest texel counts. */
function pixels(image, part, width, height) {
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  context.imageSmoothingEnabled = false;
  context.drawImage(image, ...part, 0, 0, width, height);
  return context.getImageData(0, 0, width, height).data;
}
