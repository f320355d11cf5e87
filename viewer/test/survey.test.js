// What a mesh says of its walls, whatever the last bits of its corners.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { BufferGeometry, Float32BufferAttribute, Mesh } from 'three';

import { survey } from '../src/survey.js';

/** A wall of two triangles, which lean by `noise` to either side. */
function wall(noise) {
  const corners = [[0, 0, 0], [6, 0, noise], [6, 9, 0], [0, 0, 0], [6, 9, 0], [0, 9, noise]];
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(corners.flat(), 3));
  geometry.setAttribute('_feature_id_0', new Float32BufferAttribute(corners.map(() => 4), 1));
  return new Mesh(geometry);
}

for (const noise of [0, 1e-7, -1e-7, 1e-4]) {
  test(`two triangles of one wall are one wall, at a noise of ${noise}`, () => {
    const found = survey(wall(noise), () => 1);
    assert.deepEqual([...found.keys()], [4]);
    const [one, ...others] = found.get(4).walls;
    assert.equal(others.length, 0);
    assert.ok(Math.abs(Math.hypot(one.b[0] - one.a[0], one.b[1] - one.a[1]) - 6) < 1e-2);
    assert.ok(Math.abs(one.top - 9) < 1e-6);
  });
}
