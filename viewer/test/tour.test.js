import assert from 'node:assert/strict';
import { test } from 'node:test';

import { web } from '../src/credit.js';
import { nearestName, repeated, spread } from '../src/labels.js';
import { upright } from '../src/minimap.js';
import { along } from '../src/props.js';
import { nameFor } from '../src/shot.js';
import { where } from '../src/sight.js';
import { route } from '../src/tour.js';
import { before } from '../src/walker.js';

const stop = (id, x, value) => ({ id, worth: value, at: [x, 0] });

test('a tour goes on to the nearest of the best', () => {
  const stops = [stop('far', 100, 5), stop('near', 10, 3), stop('poor', 1, 0.1), stop('mid', 40, 4), stop('none', 2, 0)];
  assert.deepEqual(route(stops, [0, 0], 3).map(({ id }) => id), ['near', 'mid', 'far']);
  assert.deepEqual(route(stops, [90, 0], 3).map(({ id }) => id), ['far', 'mid', 'near']);
});

test('a tour is the same whatever the order of the buildings', () => {
  const stops = Array.from({ length: 30 }, (_, i) => stop(`b${i}`, (i * 37) % 101, (i * 13) % 7));
  const way = (list) => route(list, [5, 0], 12).map(({ id }) => id).join();
  assert.equal(way([...stops].reverse()), way(stops));
  assert.equal(new Set(route(stops, [5, 0], 12)).size, 12);
});

test('only web pages are linked to', () => {
  assert.equal(web('https://archive.example/1'), 'https://archive.example/1');
  for (const address of ['javascript:alert(1)', 'data:text/html,x', 'photos/a', '', undefined, 'file:///etc']) {
    assert.equal(web(address), null, String(address));
  }
});

test('letters on the plan never stand on their heads', () => {
  for (let angle = -7; angle < 7; angle += 0.1) {
    assert.ok(Math.cos(upright(angle)) > -1e-6, String(angle));
    assert.ok(Math.abs(Math.tan(upright(angle)) - Math.tan(angle)) < 1e-6 * (1 + Math.tan(angle) ** 2));
  }
});

test('a street is the one whose line is nearest, if it is near', () => {
  const plane = (name, line) => ({ name, position: { x: line[0][0], z: line[0][1] }, userData: { line } });
  const planes = [plane('West 1', [[0, 0], [100, 0]]), plane('Broad', [[50, 30], [50, 90]])];
  assert.equal(nearestName(planes, [40, 5]), 'West 1');
  assert.equal(nearestName(planes, [54, 60]), 'Broad');
  assert.equal(nearestName(planes, [200, 0]), '');
  assert.equal(nearestName([], [0, 0]), '');
  assert.ok(repeated('Broad', [50, 60], planes) && !repeated('Broad', [50, 160], planes));
});

test('letters that join are not set apart, and none is cut in two', () => {
  assert.equal(spread('AB 1'), 'A\u200aB\u200a \u200a1');
  for (const name of ['شارع الملك', 'รัก', 'नगर']) assert.equal(spread(name), name);
  assert.ok(spread('A𝕊').includes('𝕊'));
});

test('what is faced is named with its distance, else the street', () => {
  assert.equal(where({ record: { address: '5 First Avenue' }, distance: 12.4 }, 'x'), 'Facing 5 First Avenue, 12 m');
  assert.equal(where(null, 'First Avenue'), 'On First Avenue');
  assert.equal(where(null, ''), '');
});

test('lamps and figures stand on the sidewalk, cars in the street, whichever way the kerb runs', () => {
  const kerb = [[0, 0], [120, 0], [120, 60], [0, 60]];
  const inside = ({ x, z }) => x > 0 && x < 120 && z > 0 && z < 60;
  for (const outline of [kerb, [...kerb].reverse()]) {
    const things = along(outline);
    for (const one of things) assert.equal(inside(one), one.kind !== 'car', JSON.stringify(one));
    for (const kind of ['lamp', 'figure', 'car']) assert.ok(things.some((one) => one.kind === kind), kind);
  }
  assert.deepEqual(along(kerb), along(kerb));
});

test('a picture gets a harmless name', () => {
  assert.equal(nameFor('Block 993: <West/40>', '2026-01-02'), 'Block-993-West-40-2026-01-02.png');
  assert.equal(nameFor('…', '2026-01-02'), 'nostalgin-2026-01-02.png');
});

test('one stands far enough back to see a front, and looks wider where there is no room', () => {
  const wall = { a: [0, 0], b: [20, 0], out: [0, 1], bottom: 0, top: 15 };
  const lens = { fov: 62, aspect: 1.6 };
  const free = before(wall, 70, lens);
  assert.ok(free.z > 8 && free.z < 30);
  assert.equal(free.fov, 62);
  assert.equal(free.yaw, 0);
  const narrow = before(wall, 9, lens);
  assert.equal(narrow.z, 9);
  assert.ok(narrow.fov > 62 && narrow.fov <= 100);
});
