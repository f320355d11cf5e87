// What is being loaded, in words, until there is something to see.

const LATE_S = 8;
const LATE = 'This takes long. If you opened this page as a file, run “nostalgin view CITY” instead: '
  + 'browsers load models only from a web server.';

export class Loading {
  constructor(element) {
    this.element = element;
    this.late = setTimeout(() => element.append(paragraph(LATE)), LATE_S * 1000);
  }

  /** Says what is awaited. */
  tell(what) {
    this.element.replaceChildren(paragraph(`Loading ${what} …`));
  }

  /** Counts models until the first stands. */
  models(city) {
    const count = () => {
      if (document.body.classList.contains('running')) return;
      const { downloading, parsing } = city.tiles.stats;
      this.tell(`the first of ${city.record.blocks.length} blocks: ${
        parsing ? 'building it' : downloading ? 'fetching it' : 'choosing it'}`);
      setTimeout(count, 250);
    };
    count();
  }

  /** There is a city, or a reason why not. */
  end() {
    clearTimeout(this.late);
  }
}

function paragraph(text) {
  return Object.assign(document.createElement('p'), { textContent: text });
}
