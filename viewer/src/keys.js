// What keys, buttons and links do.

import { shown } from './paint.js';

const $ = (id) => document.getElementById(id);

/** What each key does to a page. */
function acts(page) {
  return {
    KeyE: () => page.setEvidence(!shown.evidence.value),
    KeyB: () => { page.guide.moved(); page.setBird(!page.flying); },
    KeyG: () => page.finder.open(),
    KeyH: () => $('help').showModal(),
    KeyL: () => page.input.toggleLock(),
    KeyF: () => page.click(0, 0),
    KeyT: () => page.guide.toggle(),
    KeyR: () => page.guide.lead(),
    KeyP: () => page.shoot(),
    Home: () => {
      page.guide.moved();
      page.setBird(false);
      page.stand(page.home ?? page.walker.pose);
    },
    Escape: () => (page.panel.open ? page.panel.close() : page.guide.moved()),
  };
}

export function listen(page) {
  const act = acts(page);
  const press = (code) => {
    act[code]?.();
    return code in act;
  };
  page.input.onClick = (x, y) => page.click(x, y);
  page.input.onMove = () => page.guide.moved();
  page.input.onKey = (event) => {
    const code = event.key === '?' ? 'KeyH' : event.code;
    if (press(code)) event.preventDefault();
    document.body.classList.toggle('keys', code === 'KeyF' || document.body.classList.contains('keys'));
  };
  for (const button of document.querySelectorAll('[data-key]')) {
    button.addEventListener('click', () => press(button.dataset.key));
  }
  document.addEventListener('pointerlockchange', () => {
    document.body.classList.toggle('locked', Boolean(document.pointerLockElement));
  });
  addEventListener('resize', () => page.resize());
  addEventListener('hashchange', () => page.guide.open(location.hash));
}

