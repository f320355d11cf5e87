// What is known of one building, beside its photograph. Text goes in as text, never as
// markup: catalogues hold whatever people typed.

import { link } from './credit.js';
import { metres, nameOf, percent } from './words.js';

const MISSING = 'The photograph is not part of this site. Put the photographs back where the '
  + 'manifest names them, and run “nostalgin build” again.';

export class Panel {
  constructor(element, { onClose, onVisit, onThen }) {
    this.element = element;
    this.onClose = onClose;
    this.onVisit = onVisit;
    this.onThen = onThen;
    this.before = null; // what had the focus
  }

  get open() {
    return !this.element.hidden;
  }

  /** `here` names what the very spot rests on that was clicked. */
  show({ record, block, shape }, here = null) {
    if (!this.open) this.before = document.activeElement;
    const name = nameOf(record);
    const heading = make('h2', { id: 'panel-name', textContent: name, dir: 'auto' });
    const where = [record.block_title ?? `Block ${block.block}`, record.lot && `Lot ${record.lot}`];
    const close = make('button', { className: 'close', title: 'Close (Esc)', textContent: '×' });
    close.setAttribute('aria-label', 'Close');
    close.addEventListener('click', () => this.close());
    const visit = make('button', { className: 'visit', textContent: 'Stand before it' });
    visit.disabled = !shape && !record.footprint_m;
    visit.addEventListener('click', () => this.onVisit(record));
    this.element.replaceChildren(
      close,
      heading,
      make('p', { className: 'where', textContent: where.filter(Boolean).join(' · ') }),
      ...photographs(record, name, (key) => this.onThen(record, key)),
      facts(record, here),
      ...unused(record),
      visit,
    );
    this.element.hidden = false;
    this.element.scrollTop = 0;
    close.focus({ preventScroll: true });
  }

  close() {
    if (!this.open) return;
    this.element.hidden = true;
    this.before?.focus?.({ preventScroll: true });
    this.onClose();
  }
}

function make(tag, properties = {}, children = []) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

function photographs(record, name, onThen) {
  if (!record.photos?.length) {
    const why = record.assumed
      ? 'No photograph of this lot could be used. The plain volume is assumed.'
      : 'This site names no photograph of this lot.';
    return [make('p', { className: 'none', textContent: why })];
  }
  return record.photos.map((photo) => figure(photo, name, onThen));
}

function figure({ key, file, credit, caption, date, rights, license, source_url: source, used, lent, camera, watermark }, name, onThen) {
  const image = make('img', { alt: `Photograph of ${name}`, decoding: 'async' });
  const whole = make('a', { target: '_blank', rel: 'noopener', title: 'Open the photograph' }, [image]);
  const holder = make('figure', {}, [whole]);
  const absent = () => whole.replaceWith(make('p', { className: 'none', textContent: MISSING }));
  if (local(file)) {
    image.addEventListener('error', absent);
    image.src = whole.href = file;
    if (camera) {
      const button = make('button', { className: 'visit', textContent: 'Stand where the photographer stood' });
      button.addEventListener('click', () => onThen(key));
      holder.append(button);
    }
  } else absent();
  const other = used === false ? 'Not the one on the model.' : null;
  const neighbours = lent ? 'Taken of a neighbour; it shows this front too.' : null;
  const cleared = watermark ? `The wall’s texture is without the archive’s watermark (${watermark}).` : null;
  const words = [[caption, date].filter(Boolean).join(', '), neighbours, other, cleared, rights, license].filter(Boolean);
  const lines = words.map((text) => make('span', { textContent: text, dir: 'auto' })); // each its own way
  if (credit) lines.push(make('cite', { textContent: credit, dir: 'auto' }));
  if (source) lines.push(link('The archive’s record', source));
  if (lines.length) holder.append(make('figcaption', {}, lines));
  return holder;
}

/** Only files of this site are shown: no address that a catalogue might have smuggled in. */
export function local(file) {
  return typeof file === 'string' && /^photos\/[\w.-]+$/.test(file) && !file.includes('..');
}

function facts(record, here) {
  const rows = [
    ['Seen by a camera', share(record)],
    ['Where you clicked', here],
    ['Street', record.street],
    ['Built', record.year],
    ['Width', metres(record.width_m, record.width_sd_m)],
    ['Height', height(record)],
    ['By its storeys', record.height_by_storeys_m && metres(record.height_by_storeys_m)],
    ['By its width', record.height_by_width_m && metres(record.height_by_width_m)],
    ['By the list', record.height_by_list_m && metres(record.height_by_list_m)],
    ['Contradicting', (record.height_contradicted_by ?? []).map((one) => `its ${one}`).join(', ')],
  ];
  const list = make('dl');
  for (const [term, value] of rows) {
    if (value === undefined || value === null || value === '') continue;
    const definition = make('dd');
    definition.append(value);
    list.append(make('dt', { textContent: term }), definition);
  }
  return list;
}

/** A height is stated as surely as it is known. */
export function height(record) {
  const { height_m: known, height_low_m: low, height_high_m: high } = record;
  if (!Number.isFinite(known)) return null;
  if (!Number.isFinite(low) || !Number.isFinite(high)) return `${metres(known)}, assumed`;
  const between = `${low.toFixed(0)} to ${high.toFixed(0)} m in nine of ten cases`;
  return `${metres(known)}, ${between}${record.height_assumed ? '; nothing supports it' : ''}`;
}

function share(record) {
  const known = record.assumed ? 0 : record.photographed_share;
  if (!Number.isFinite(known)) return null;
  const meter = make('meter', { min: 0, max: 1, value: known });
  meter.setAttribute('aria-label', 'share of the front that a camera saw');
  const words = record.assumed ? 'none of it' : `${percent(known)} of the front`;
  return make('span', {}, [words, meter]);
}

function unused(record) {
  const rejections = record.rejections ?? [];
  if (!rejections.length) return [];
  const items = rejections.map(({ stage, reason, detail }) =>
    make('li', { textContent: [`${stage}: ${reason}`, detail].filter(Boolean).join('. ') }));
  const title = `${rejections.length} not used`;
  return [make('details', {}, [make('summary', { textContent: title }), make('ul', {}, items)])];
}
