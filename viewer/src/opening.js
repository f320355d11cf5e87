// Opens a city: its list of blocks, and the tileset that it names.

import { TilesRenderer } from '3d-tiles-renderer';
import { GLTFExtensionsPlugin } from '3d-tiles-renderer/plugins';

import { bound } from './budget.js';
import { City } from './city.js';
import { EvidenceVariant } from './paint.js';
import { Unreadable } from './records.js';

const EARLIER = 'An earlier version of nostalgin wrote this city. Run “nostalgin build CITY” again.';

/** Reads site.json and starts to load the tileset that it names, both beside the page. */
export async function open(base = '', tell = () => {}) {
  tell('the list of blocks');
  const response = await fetch(`${base}site.json`);
  if (!response.ok) throw new Error(`site.json: ${response.status}`);
  const record = await response.json();
  if (record.blocks.some((block) => !block.record)) throw new Unreadable(EARLIER);
  const tiles = new TilesRenderer(new URL(`${base}${record.tileset}`, location.href).href);
  tiles.registerPlugin(
    new GLTFExtensionsPlugin({ plugins: [(parser) => new EvidenceVariant(parser)] }),
  );
  bound(tiles);
  const city = new City(record, tiles, base);
  const rooted = new Promise((resolve, reject) => {
    tiles.addEventListener('load-root-tileset', resolve, { once: true });
    tiles.addEventListener('load-error', ({ error, tile }) => tile || reject(error));
  });
  tell('the plan of the city');
  tiles.update();
  await rooted;
  city.arrange(tiles.rootTileset.root);
  return city;
}
