// How much of a city a page keeps: what it draws, and what it drew last, within a budget.

import { RGBAFormat, TextureUtils, UnsignedByteType } from 'three';

const MIB = 2 ** 20;
const KEPT_BYTES = 192 * MIB; // beyond, models that nothing draws go, those drawn longest ago first
const MOST_BYTES = 640 * MIB; // beyond, nothing finer comes: the coarse stays
const AT_ONCE = 0.25; // of what is too much goes in one frame

/** Bounds what `tiles` keeps. Counted are geometries and textures as a graphics card holds them. */
export function bound(tiles) {
  Object.assign(tiles.lruCache, { minBytesSize: KEPT_BYTES, maxBytesSize: MOST_BYTES, unloadPercent: AT_ONCE });
  tiles.registerPlugin({ name: 'NOSTALGIN_budget', calculateBytesUsed: (tile, scene) => evidenceBytes(scene) });
}

/** What the evidence's textures of a loaded model take: the library knows of no second texture. */
export function evidenceBytes(scene) {
  const images = new Set();
  scene?.traverse(({ userData: { evidence } }) => evidence && images.add(evidence.image));
  return [...images].reduce(
    (sum, { width, height }) => sum + TextureUtils.getByteLength(width, height, RGBAFormat, UnsignedByteType), 0,
  );
}
