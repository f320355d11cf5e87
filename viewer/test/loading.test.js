// What is said while a city loads, on a page of one element and under a clock of our own.

import assert from 'node:assert/strict';
import { mock, test } from 'node:test';

import { Loading } from '../src/loading.js';

function notice() {
  let children = [];
  return {
    append: (...more) => children.push(...more),
    replaceChildren: (...others) => { children = others; },
    get words() { return children.map(({ textContent }) => textContent); },
  };
}

const city = { tiles: { stats: { downloading: 1 } }, record: { blocks: [1, 2, 3] } };

function underTime(work) {
  globalThis.document = { createElement: () => ({}) };
  mock.timers.enable({ apis: ['setTimeout'] });
  try {
    work(mock.timers);
  } finally {
    mock.timers.reset();
  }
}

test('why it could not be shown stays, whatever was awaited', () => underTime((clock) => {
  const element = notice();
  const loading = new Loading(element);
  loading.models(city);
  loading.end();
  element.replaceChildren({ textContent: 'The city could not be shown.' });
  clock.tick(60_000);
  assert.deepEqual(element.words, ['The city could not be shown.']);
}));

test('what may help where it takes long is said once, and stays', () => underTime((clock) => {
  const element = notice();
  const loading = new Loading(element);
  loading.models(city);
  clock.tick(7_000);
  assert.equal(element.words.length, 1);
  clock.tick(60_000);
  assert.equal(element.words.length, 2);
  assert.match(element.words[0], /the first of 3 blocks: fetching it/);
  assert.match(element.words[1], /nostalgin view/);
}));
