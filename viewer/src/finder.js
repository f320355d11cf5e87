// Find a building by its address, lot or block, with keys alone.

import { nameOf } from './words.js';

const MOST = 80;

export class Finder {
  constructor(dialog, city, onFound) {
    this.dialog = dialog;
    this.city = city;
    this.onFound = onFound;
    this.input = dialog.querySelector('input');
    this.list = dialog.querySelector('ul');
    this.input.addEventListener('input', () => this.#fill());
    dialog.querySelector('form').addEventListener('submit', (event) => {
      event.preventDefault();
      this.list.querySelector('button')?.click();
    });
  }

  open() {
    this.input.value = '';
    this.#fill();
    this.dialog.showModal();
    this.input.focus();
  }

  #fill() {
    const wanted = this.input.value.toLowerCase().split(/\s+/).filter(Boolean);
    const rows = [];
    for (const [id, { record, block }] of this.city.buildings) {
      const text = `${nameOf(record)} · Block ${block.block}, lot ${record.lot}`;
      if (wanted.every((word) => text.toLowerCase().includes(word))) rows.push([id, text]);
    }
    this.list.replaceChildren(...rows.slice(0, MOST).map(([id, text]) => this.#row(id, text)));
    this.dialog.querySelector('p').textContent = rows.length
      ? `${rows.length} of ${this.city.buildings.size} buildings`
      : 'No building answers to that.';
  }

  #row(id, text) {
    const button = document.createElement('button');
    button.type = 'button';
    button.dir = 'auto';
    button.textContent = text;
    button.addEventListener('click', () => {
      this.dialog.close();
      this.onFound(id);
    });
    const item = document.createElement('li');
    item.append(button);
    return item;
  }
}
