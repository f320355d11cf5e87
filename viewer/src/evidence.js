// What each texel of the model rests on: the codes of nostalgin_core/rests.py, with
// the colours in which key E shows them (Okabe and Ito's, apart for colour-blind eyes).

export const NOTHING = 0;
export const ASSUMED = 6;

export const KINDS = [
  { code: 1, name: 'Photographed', color: null },
  { code: 2, name: 'Photographed, at a soft edge', color: '#f0e442', strength: 0.42 },
  { code: 3, name: 'Hidden in the photograph, painted in', color: '#e69f00' },
  { code: 4, name: 'Beyond the photograph’s frame, painted in', color: '#d55e00' },
  { code: 5, name: 'Copied from elsewhere on it', color: '#56b4e9' },
  { code: 7, name: 'Photographed in another picture', color: '#009e73', strength: 0.6 },
  { code: 6, name: 'Assumed: no photograph', color: '#b48bd0' },
];

/**
 * The colours (0 to 255) that stand for codes 0, 1, 2 ... in the models' own evidence
 * images, as the legend in site.json tells them.
 */
export function keysOf(legend) {
  const codes = Object.keys(legend ?? {}).map(Number).sort((a, b) => a - b);
  const whole = codes.length > ASSUMED && codes.every((code, place) => code === place);
  const keys = codes.map((code) => legend[code].tint);
  if (!whole || keys.some((key) => !isColour(key))) {
    throw new Error('its legend tells no colour for some code; build the city again');
  }
  return keys;
}

const isColour = (key) => Array.isArray(key) && key.length === 3 && key.every(Number.isFinite);

/** The code that a colour of the image (0 to 255) stands for: the nearest key's. */
export function codeOf(keys, red, green, blue) {
  const far = keys.map(([r, g, b]) => (r - red) ** 2 + (g - green) ** 2 + (b - blue) ** 2);
  return far.indexOf(Math.min(...far));
}

/** Red, green, blue and strength for codes 0 to 7, each from 0 to 1. */
export function palette() {
  const rows = Array.from({ length: 8 }, () => [0, 0, 0, 0]);
  for (const { code, color, strength = 1 } of KINDS) if (color) rows[code] = [...rgb(color), strength];
  rows[NOTHING] = rows[ASSUMED];
  return rows;
}

/** What a code means, in a reader's words; a plain surface is an assumption. */
export function nameOfCode(code) {
  return (KINDS.find((kind) => kind.code === code) ?? KINDS.at(-1)).name;
}

function rgb(hex) {
  const n = parseInt(hex.slice(1), 16);
  return [(n >> 16) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255];
}
