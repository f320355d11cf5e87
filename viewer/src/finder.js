// Find a building by its address, lot or block, with keys alone. The lists to search in are
// fetched when they are asked for, one after another, and let go of when the finder is left.

import { readJson } from './records.js';
import { nameOf } from './words.js';

const MOST = 80;

export class Finder {
  /** @param record site.json */
  constructor(dialog, record, onFound) {
    this.dialog = dialog;
    this.lists = record.finder ?? [];
    this.titles = new Map(record.blocks.map(({ name, block }) => [name, block]));
    this.count = record.blocks.reduce((sum, { buildings }) => sum + buildings, 0);
    this.onFound = onFound;
    this.input = dialog.querySelector('input');
    this.list = dialog.querySelector('ul');
    this.words = dialog.querySelector('p');
    this.#forget();
    this.input.addEventListener('input', () => this.#fill());
    dialog.addEventListener('close', () => dialog.open || this.#forget()); // it comes late, perhaps to the next
    dialog.querySelector('form').addEventListener('submit', (event) => {
      event.preventDefault();
      this.#choose();
    });
  }

  open() {
    this.input.value = '';
    this.#forget();
    this.#fill();
    this.dialog.showModal();
    this.input.focus();
    this.#load();
  }

  #forget() {
    this.rows = []; // [id, what is shown of it, the same in small letters]
    this.found = [];
    this.left = this.lists.length;
    this.chosen = false; // somebody pressed Enter before anything was found
    this.turn = (this.turn ?? 0) + 1;
  }

  async #load() {
    const { turn } = this;
    for (const file of this.lists) {
      const list = await readJson('', file, 'which buildings there are').catch((error) => error);
      if (turn !== this.turn) return;
      if (list instanceof Error) {
        this.words.textContent = list.message;
        return;
      }
      this.left -= 1;
      const rows = list.flatMap(([block, own]) => own.map(([id, lot, address]) => {
        const text = `${nameOf({ id, lot, address })} · Block ${this.titles.get(block) ?? block}, lot ${lot}`;
        return [id, text, text.toLowerCase()];
      }));
      this.rows = this.rows.concat(rows);
      this.#fill(rows);
    }
  }

  /** Shows what answers to the words; of `more` rows, which have come now, what does so too. */
  #fill(more = null) {
    const wanted = this.input.value.toLowerCase().split(/\s+/).filter(Boolean);
    const answers = ([, , text]) => wanted.every((word) => text.includes(word));
    if (more) this.found = this.found.concat(more.filter(answers));
    else this.found = this.rows.filter(answers);
    this.list.replaceChildren(...this.found.slice(0, MOST).map(([id, text]) => this.#row(id, text)));
    const none = this.left ? 'Fetching the list of buildings …' : 'No building answers to that.';
    this.words.textContent = this.found.length ? `${this.found.length} of ${this.count} buildings` : none;
    if (this.chosen) this.#choose();
  }

  /** Goes to the first that was found, now or as soon as there is one. */
  #choose() {
    this.chosen = this.left > 0;
    this.list.querySelector('button')?.click();
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
