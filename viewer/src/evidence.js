// What each texel of the model rests on: the codes of nostalgin_core/evidence.py, with
// the colours in which key E shows them (Okabe and Ito's, apart for colour-blind eyes).

export const NOTHING = 0;
export const ASSUMED = 6;

export const KINDS = [
  { code: 1, name: 'Photographed', color: null },
  { code: 2, name: 'Photographed, at a soft edge', color: '#f0e442', strength: 0.42 },
  { code: 3, name: 'Hidden in the photograph, painted in', color: '#e69f00' },
  { code: 4, name: 'Beyond the photograph’s frame, painted in', color: '#d55e00' },
  { code: 5, name: 'Copied from another side', color: '#56b4e9' },
  { code: 6, name: 'Assumed: no photograph', color: '#b48bd0' },
];

// The colours that stand for codes 0 to 6 in the model's own evidence image: those of
// nostalgin_core/picture.py.
const KEYS = [
  [0, 0, 0], [255, 255, 255], [255, 244, 190], [255, 150, 70], [235, 90, 120], [90, 170, 255], [170, 140, 230],
];

/** The image's colours, each from 0 to 1. */
export const keys = () => KEYS.map((row) => row.map((value) => value / 255));

/** The code that a colour of the image (0 to 255) stands for: the nearest one's. */
export function codeOf(red, green, blue) {
  const far = KEYS.map(([r, g, b]) => (r - red) ** 2 + (g - green) ** 2 + (b - blue) ** 2);
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
