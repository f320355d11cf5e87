// What is known of buildings: read a block at a time, when it is needed, and let go.

const KEPT = 96; // blocks of which no model stands, those used last

/** Why what is known of a block can't be told. */
export class Unreadable extends Error {}

export class Records {
  /** @param blocks their headers in site.json; @param odd block names of buildings whose ids do not tell it */
  constructor(blocks, odd = {}, base = '') {
    this.base = base;
    this.odd = odd;
    this.named = new Map(blocks.map((block) => [block.name, block]));
    this.here = new Map(); // block -> its buildings, `{ record, block, shape, detail }`, the longest unused first
    this.coming = new Map(); // block -> a promise of them
    this.buildings = new Map(); // the same by their ids
  }

  /** The buildings of a block, as far as they are here. */
  of(block) {
    return this.here.get(block) ?? [];
  }

  /** The buildings of a block, once they are here. */
  async read(block) {
    if (this.here.has(block)) return this.keep(block, this.here.get(block));
    if (!this.coming.has(block)) {
      const end = () => this.coming.delete(block);
      this.coming.set(block, this.#fetched(block).finally(end));
    }
    return this.keep(block, await this.coming.get(block));
  }

  /** Puts a block's buildings in their place, where they were let go; they are used now. */
  keep(block, own) {
    const known = this.here.get(block) ?? own;
    this.here.delete(block);
    this.here.set(block, known);
    for (const one of known) this.buildings.set(String(one.record.id), one);
    return known;
  }

  /** The building of an id, once it is here; null where the city has none. */
  async find(id) {
    for (const block of this.#may(id)) {
      await this.read(block);
      if (this.buildings.get(id)?.block === block) return this.buildings.get(id);
    }
    return null;
  }

  /** Lets go of the blocks used longest ago, but for those that are `needed`. */
  prune(needed) {
    const idle = [...this.here.keys()].filter((block) => !needed(block));
    for (const block of idle.slice(0, Math.max(0, idle.length - KEPT))) {
      for (const { record } of this.here.get(block)) this.buildings.delete(String(record.id));
      this.here.delete(block);
    }
  }

  /** The blocks that an id may be of: their names and a dash begin it. */
  #may(id) {
    const dashes = [...id.matchAll(/-/g)].map(({ index }) => id.slice(0, index));
    const names = Object.hasOwn(this.odd, id) ? [this.odd[id]] : dashes.reverse();
    return names.map((name) => this.named.get(name)).filter(Boolean);
  }

  async #fetched(block) {
    const told = await readJson(this.base, block.record, `what is known of block ${block.block ?? block.name}`);
    if (told?.buildings?.length !== block.buildings) {
      throw new Unreadable(wordsOf(`what is known of block ${block.block ?? block.name}`, `${block.record} is damaged`));
    }
    return told.buildings.map((record) => ({ record, block, shape: null, detail: 0 }));
  }
}

/** Reads a file of the site; where it is gone or damaged, says of what it told. */
export async function readJson(base, file, what) {
  let why = 'it can’t be reached';
  try {
    const response = await fetch(`${base}${file}`);
    if (response.ok) return await response.json();
    why = response.status;
  } catch (error) {
    if (error instanceof SyntaxError) why = 'it is damaged';
  }
  throw new Unreadable(wordsOf(what, `${file}: ${why}`));
}

const wordsOf = (what, why) => `There is no telling ${what} (${why}). If the city is yours, run “nostalgin build” again.`;
