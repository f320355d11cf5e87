// Whose photographs these are, always on the page, with a way to the archive's own record.

/** An address that may be followed: a web page's, whatever a list has smuggled in. */
export function web(address) {
  try {
    const { protocol, href } = new URL(address);
    return protocol === 'https:' || protocol === 'http:' ? href : null;
  } catch {
    return null;
  }
}

/** A link that opens elsewhere, or the words alone where the address is no web page's. */
export function link(words, address) {
  const href = web(address);
  const element = document.createElement(href ? 'a' : 'span');
  if (href) Object.assign(element, { href, target: '_blank', rel: 'noopener noreferrer' });
  element.textContent = words;
  return element;
}

export class Credit {
  /** `all` who are credited most often in the city, as far as site.json names them. */
  constructor(element, all) {
    this.element = element;
    this.others = all.length > 2 ? `${all.slice(0, 2).join(', ')} and others` : all.join(', ');
    this.show(null);
  }

  /** Names the photographs of the city, or the one that a building wears. */
  show(record) {
    const photo = record?.photos?.find(({ used }) => used) ?? null;
    const state = photo?.key ?? '';
    if (state === this.state) return;
    this.state = state;
    const words = photo?.credit || this.others;
    const parts = [words && `Photographs: ${words}`, photo?.date].filter(Boolean).join(', ');
    this.element.replaceChildren(parts);
    if (web(photo?.source_url)) this.element.append(' · ', link('the archive’s record', photo.source_url));
    this.element.hidden = !this.element.textContent;
  }
}
