import assert from 'node:assert/strict';
import { afterEach, beforeEach, test } from 'node:test';

import { Records, Unreadable } from '../src/records.js';

const NAMES = ['1', '2-3', 'Łódź 7', 'odd'];
const fetching = globalThis.fetch;
let asked = [];

const block = (name, buildings = 2) => ({ name, block: name, buildings, record: `records/${name}.json` });
const record = (name) => ({ block: name, buildings: [{ id: `${name}-1` }, { id: `${name}-2-9` }] });

/** Serves the records of blocks, but for those that `spoilt` tells otherwise. */
function serve(spoilt = {}) {
  globalThis.fetch = async (file) => {
    asked.push(file);
    const name = /records\/(.*)\.json/.exec(file)[1];
    return spoilt[name] ?? new Response(JSON.stringify(record(name)));
  };
}

beforeEach(() => {
  asked = [];
  serve();
});
afterEach(() => {
  globalThis.fetch = fetching;
});

test('a building is found by one record, whatever its block is called', async () => {
  for (const name of NAMES) {
    asked = [];
    const records = new Records(NAMES.map((one) => block(one)));
    const found = await records.find(`${name}-2-9`);
    assert.equal(found.block.name, name);
    assert.equal(asked.length, 1);
  }
});

test('of blocks whose names begin alike the one is found that has the building', async () => {
  const records = new Records([block('1'), block('1-2')]);
  assert.equal((await records.find('1-2-1')).block.name, '1-2');
  assert.equal((await records.find('1-2-9')).block.name, '1');
});

test('an id that does not tell its block is looked up', async () => {
  globalThis.fetch = async () => new Response(JSON.stringify({ buildings: [{ id: 'corner house' }] }));
  const records = new Records([block('1', 1)], { 'corner house': '1' });
  assert.equal((await records.find('corner house')).block.name, '1');
});

test('what the city has not is not there, and nothing is asked for it', async () => {
  const records = new Records([block('1')]);
  for (const id of ['9-9', 'nonsense', '', '__proto__', 'constructor', '-', '1']) assert.equal(await records.find(id), null, id);
  assert.deepEqual(asked, []);
  assert.equal(await records.find('1-77'), null);
});

test('a record that is wanted twice at once is fetched once', async () => {
  const one = block('1');
  const records = new Records([one]);
  const [a, b] = await Promise.all([records.read(one), records.read(one)]);
  assert.equal(a, b);
  assert.equal(asked.length, 1);
});

test('a record that is gone or damaged is named with the remedy, and read again when it is wanted again', async () => {
  const one = block('1');
  const bad = [
    () => new Response('', { status: 404 }), () => new Response('{"buildings": [', {}), () => new Response('null'),
    () => new Response('{"buildings": []}'), () => Promise.reject(new TypeError('Failed to fetch')),
  ];
  for (const make of bad) {
    const records = new Records([one, block('1-2')]);
    serve({ 1: make() });
    await assert.rejects(records.read(one), (error) => error instanceof Unreadable
      && /block 1 .*records\/1\.json.*nostalgin build/.test(error.message));
    assert.equal((await records.find('1-2-1')).block.name, '1-2');
    serve();
    assert.equal((await records.read(one)).length, 2);
  }
});

test('what is long unused is let go, what is needed stays, and comes again', async () => {
  const blocks = Array.from({ length: 300 }, (_, n) => block(`b${n}`));
  const records = new Records(blocks);
  for (const one of blocks) {
    await records.read(one);
    records.prune(({ name }) => name === 'b0');
  }
  assert.ok(records.here.size < 100);
  assert.equal(records.buildings.size, 2 * records.here.size);
  assert.ok(records.buildings.has('b0-1') && records.buildings.has('b299-1') && !records.buildings.has('b1-1'));
  assert.equal((await records.find('b1-1')).record.id, 'b1-1');
});

test('what a model brought is put back where it was let go meanwhile', async () => {
  const blocks = Array.from({ length: 200 }, (_, n) => block(`b${n}`));
  const records = new Records(blocks);
  const own = await records.read(blocks[0]);
  for (const one of blocks) await records.read(one);
  for (const one of blocks.slice(1)) await records.read(one);
  records.prune(() => false);
  assert.deepEqual(records.of(blocks[0]), []);
  assert.equal(records.keep(blocks[0], own), own);
  assert.equal(records.buildings.get('b0-1'), own[0]);
});
