// Opens the city, and lets tests and scripts drive its page through window.nostalgin.

import { api } from './api.js';
import { fillLegend } from './legend.js';
import { Loading } from './loading.js';
import { open } from './opening.js';
import { Page } from './page.js';
import { Unreadable } from './records.js';
import { Stage } from './stage.js';

const loading = new Loading(document.getElementById('notice'));

function complain(error) {
  loading.end();
  const text = document.createElement('p');
  const missing = !(error instanceof Unreadable) && /json|404|Failed to fetch/.test(String(error));
  text.textContent = missing
    ? 'There is no city here yet. Run “nostalgin build CITY”, then “nostalgin view CITY”.'
    : `The city could not be shown: ${error.message ?? error}`;
  document.getElementById('notice').replaceChildren(text);
}

async function start() {
  // street names are painted once, so their letters have to be there
  const letters = document.fonts.load('600 72px Garamond').catch(() => []);
  const opening = open('', (what) => loading.tell(what));
  const stage = new Stage(document.getElementById('view')); // a browser takes long over it: the list comes meanwhile
  const [city] = await Promise.all([opening, letters]);
  document.title = `${city.record.title} · Nostalgin`;
  document.querySelector('#title h1').textContent = city.record.title;
  fillLegend(document.querySelector('#legend ul'));
  const page = new Page(city, stage);
  await page.begin(loading);
  loading.end();
  return page;
}

const starting = start();
starting.catch(complain);
window.nostalgin = api(starting);
