// One mesh a block: a model comes as a node a building, which is a draw call each.

import { BufferAttribute, Mesh } from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';

import { codeOf } from './evidence.js';

const SAMPLE_PX = 1024; // the evidence atlas is read at no more than this

/**
 * Replaces all meshes of a loaded model by one, and returns it; null where there is none.
 *
 * `keys` are the colours of the evidence's codes. Its `userData` holds `ids` (building id by feature number), `evidence` (the texture) and
 * `codeAt(u, v)`; each vertex says as `assumed` whether its whole building is.
 */
export function united(scene, assumed, keys) {
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
  mesh.userData = { ids, evidence, codeAt: evidence ? reader(evidence.image, keys) : () => 6 };
  for (const part of parts) part.removeFromParent();
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

/** A function that tells the evidence code at a texture coordinate. */
function reader(image, keys) {
  const scale = Math.min(1, SAMPLE_PX / Math.max(image.width, image.height));
  const [width, height] = [image.width, image.height].map((size) => Math.max(1, Math.round(size * scale)));
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext('2d', { willReadFrequently: true });
  context.imageSmoothingEnabled = false;
  context.drawImage(image, 0, 0, width, height);
  const { data } = context.getImageData(0, 0, width, height);
  return (u, v) => {
    const x = Math.min(width - 1, Math.max(0, Math.floor(u * width)));
    const y = Math.min(height - 1, Math.max(0, Math.floor(v * height)));
    const at = 4 * (y * width + x);
    return data[at + 3] < 128 ? 0 : codeOf(keys, data[at], data[at + 1], data[at + 2]);
  };
}
