// The key to the colours of the evidence view.

import { KINDS } from './evidence.js';

export function fillLegend(list) {
  list.replaceChildren(...KINDS.map(({ name, color }) => {
    const swatch = document.createElement('i');
    if (color) swatch.style.background = color;
    else swatch.className = 'photograph';
    const item = document.createElement('li');
    item.append(swatch, name);
    return item;
  }));
}
