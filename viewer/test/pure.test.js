import assert from 'node:assert/strict';
import { test } from 'node:test';

import { KINDS, codeOf, keysOf, nameOfCode, palette } from '../src/evidence.js';
import { contains, hull, signedArea2, widened } from '../src/outline.js';
import { fromHash, toHash } from '../src/pose.js';
import { feet, metres, percent } from '../src/words.js';

// as site.json tells them; any colours that lie apart will do
const LEGEND = Object.fromEntries(
  [[0, 0, 0], [255, 255, 255], [255, 240, 180], [255, 140, 60], [230, 90, 120], [90, 170, 250], [170, 140, 230], [110, 225, 150]]
    .map((tint, code) => [code, { name: `code ${code}`, tint }]),
);
const SQUARE = [[0, 0], [10, 0], [10, 10], [0, 10]];

test('a pose survives the address bar', () => {
  const view = {
    pose: { x: -12.3, y: 1.62, z: 40.1, yaw: -90, pitch: 4.5 },
    building: '993-11 <b>&',
    then: '0123456789abcdef',
    evidence: true,
    bird: false,
  };
  assert.deepEqual(fromHash(toHash(view)), view);
});

test('a hash that names no pose gives none', () => {
  for (const hash of ['', '#', '#at=1,2,3', '#at=1,2,3,4,x', '#at=,,,,', '#at=1e9,0,0,0,0']) {
    assert.equal(fromHash(hash).pose, null, hash);
  }
});

test('an outline widened and narrowed again is itself', () => {
  const back = widened(widened(SQUARE, 4), -4);
  back.flat().forEach((value, i) => assert.ok(Math.abs(value - SQUARE.flat()[i]) < 1e-9));
});

test('widening a square by 1 adds 2 to each side, whichever way it runs', () => {
  assert.equal(Math.abs(signedArea2(widened(SQUARE, 1))) / 2, 144);
  assert.equal(Math.abs(signedArea2(widened([...SQUARE].reverse(), 1))) / 2, 144);
});

test('a needle-sharp corner is blunted', () => {
  const needle = widened([[0, 0], [100, 0.5], [0, 1]], 4);
  assert.ok(Math.max(...needle.map(([x]) => x)) < 120);
});

test('a hull holds all its points and nothing inside it', () => {
  const points = [...SQUARE, [5, 5], [1, 9], [10, 5]];
  assert.equal(Math.abs(signedArea2(hull(points))) / 2, 100);
  assert.equal(hull(points).length, 4);
});

test('inside is inside and outside is outside, also in a notch', () => {
  const notched = [[0, 0], [10, 0], [10, 10], [5, 2], [0, 10]];
  assert.ok(contains(notched, [1, 5]));
  assert.ok(!contains(notched, [5, 5]));
  assert.ok(!contains(notched, [-1, 5]));
});

test('only what a camera saw stays untinted', () => {
  const strengths = palette().map((row) => row[3]);
  assert.equal(strengths[1], 0);
  for (const code of [0, 2, 3, 4, 5, 6, 7]) assert.ok(strengths[code] > 0);
  assert.deepEqual(KINDS.map((kind) => kind.code), [1, 2, 3, 4, 5, 7, 6]);
});

test('every colour of the evidence image leads back to its code, also when it is off a little', () => {
  const keys = keysOf(LEGEND);
  keys.forEach(([red, green, blue], code) => {
    assert.equal(codeOf(keys, red, green, blue), code);
    assert.equal(codeOf(keys, red, Math.max(0, green - 3), Math.min(255, blue + 3)), code);
  });
});

test('other colours in the legend are other keys', () => {
  const swapped = keysOf({ ...LEGEND, 3: LEGEND[5], 5: LEGEND[3] });
  assert.equal(codeOf(swapped, ...LEGEND[3].tint), 5);
  assert.equal(codeOf(swapped, ...LEGEND[5].tint), 3);
});

test('a legend that leaves a code without a colour is refused', () => {
  const { 4: _, ...lacking } = LEGEND;
  for (const legend of [undefined, {}, lacking, { ...LEGEND, 2: { name: 'soft' } }, { ...LEGEND, 2: { tint: [1, 2] } }]) {
    assert.throws(() => keysOf(legend), /legend/);
  }
});

test('what another picture shows is named, and an older legend without it is read', () => {
  assert.match(nameOfCode(7), /another picture/);
  const { 7: _, ...older } = LEGEND;
  assert.equal(keysOf(older).length, 7);
});

test('a surface that nothing is known of is called assumed', () => {
  assert.equal(nameOfCode(0), nameOfCode(6));
  assert.match(nameOfCode(3), /painted in/);
});

test('all and none are said only of all and none', () => {
  assert.equal(percent(0.999), '99 %');
  assert.equal(percent(1), '100 %');
  assert.equal(percent(0.001), 'under 1 %');
  assert.equal(percent(0), '0 %');
  assert.equal(percent(undefined), '—');
});

test('metres carry their spread and their feet', () => {
  assert.equal(metres(7.62, 0.3), '7.6 ± 0.3 m (25′ 0″)');
  assert.equal(metres(null), '—');
  assert.equal(feet(0.3047), '1′ 0″');
});
