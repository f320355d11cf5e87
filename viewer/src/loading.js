// What is being loaded, in words, until there is something to see.

const LATE_S = 8;
const LATE = 'This takes long. If you opened this page as a file, run “nostalgin view CITY” instead: '
  + 'browsers load models only from a web server.';

export class Loading {
  constructor(element) {
    this.element = element;
    this.ended = false;
    this.notes = []; // what stays beneath, whatever is awaited
    this.late = setTimeout(() => {
      this.notes = [paragraph(LATE)];
      element.append(...this.notes);
    }, LATE_S * 1000);
  }

  /** Says what is awaited. */
  tell(what) {
    this.element.replaceChildren(paragraph(`Loading ${what} …`), ...this.notes);
  }

  /** Counts models until the first stands. */
  models(city) {
    if (this.ended) return;
    const { downloading, parsing } = city.tiles.stats;
    this.tell(`the first of ${city.record.blocks.length} blocks: ${
      parsing ? 'building it' : downloading ? 'fetching it' : 'choosing it'}`);
    setTimeout(() => this.models(city), 250);
  }

  /** There is a city, or a reason why not, which stays. */
  end() {
    this.ended = true;
    clearTimeout(this.late);
  }
}

function paragraph(text) {
  return Object.assign(document.createElement('p'), { textContent: text });
}
