// The city: its records (site.json) and its models (3D Tiles), in one level frame.
//
// The frame is the first block's: x east, y up, z south, in metres.

import { Group, Matrix4, OrthographicCamera, Sphere, Vector3 } from 'three';
import { TilesRenderer } from '3d-tiles-renderer';
import { GLTFExtensionsPlugin } from '3d-tiles-renderer/plugins';
import { MeshBVH } from 'three-mesh-bvh';

import { bound } from './budget.js';
import { keysOf } from './evidence.js';
import { reader, united } from './model.js';
import { EvidenceVariant, surface, unlock } from './paint.js';
import { survey } from './survey.js';

const Y_UP_FROM_Z_UP = new Matrix4().makeRotationX(-Math.PI / 2);
const NEAR_M = 90; // blocks this close are loaded, whichever way the walker looks

export class City {
  /** @param record site.json; @param tiles the running TilesRenderer */
  constructor(record, tiles) {
    this.record = record;
    this.tiles = tiles;
    this.keys = keysOf(record.legend); // colours of the evidence images' codes
    unlock(this.keys);
    this.group = new Group();
    this.group.add(tiles.group);
    this.frames = new Map(); // block name -> Matrix4, city_from_block (y up)
    this.walls = new Set(); // meshes that can be walked into and clicked
    this.buildings = new Map(); // building id -> { record, block, shape }
    this.errors = [];
    this.onBlock = () => {};
    this.onGone = () => {};
    this.standing = new Map(); // block -> its meshes that are loaded
    this.extents = []; // of blocks, on the ground, for `near`
    this.nearby = new OrthographicCamera(-NEAR_M, NEAR_M, NEAR_M, -NEAR_M, 1, 2000);
    for (const block of record.blocks) {
      for (const building of block.buildings) {
        this.buildings.set(String(building.id), { record: building, block, shape: null, detail: 0 });
      }
    }
    this.camera = null; // whose view is loaded, see `all`
    tiles.loadAncestors = tiles.loadSiblings = false; // at first only what one stands before
    tiles.setCamera(this.nearby);
    tiles.setResolution(this.nearby, 512, 512);
    tiles.addEventListener('load-model', ({ scene, tile }) => this.#enter(scene, tile));
    tiles.addEventListener('dispose-model', ({ scene }) => this.#leave(scene));
    this.onError = () => {};
    tiles.addEventListener('load-error', ({ error }) => {
      this.errors.push(String(error));
      this.onError(error);
    });
  }

  /** From now on also loads what `camera` sees, the coarse before the fine. */
  all(camera, renderer) {
    const { tiles } = this;
    tiles.loadAncestors = tiles.loadSiblings = true;
    this.camera = camera;
    tiles.setCamera(camera);
    this.resize(renderer);
  }

  resize(renderer) {
    if (this.camera) this.tiles.setResolutionFromRenderer(this.camera, renderer);
  }

  /** What paves the blocks whose outlines are told, near a place and far from it: names and rows of [x, z]. */
  ground({ x, z }, reach) {
    const [near, far] = [[], []];
    for (const { block, low, high } of this.extents) {
      if (!block.outline_m?.length) continue;
      const close = x > low[0] - reach && x < high[0] + reach && z > low[1] - reach && z < high[1] + reach;
      (close ? near : far).push([block.name, block.outline_m.map((ring) => this.placed(block, ring))]);
    }
    return { near, far };
  }

  /** Keeps the models near `at` and in `camera`'s view loaded. */
  update(at) {
    this.nearby.position.set(at.x, 1000, at.z);
    this.nearby.up.set(0, 0, -1);
    this.nearby.lookAt(at.x, 0, at.z);
    this.nearby.updateMatrixWorld();
    this.tiles.update();
  }

  get loaded() {
    return this.tiles.stats.loaded ?? 0;
  }

  /** Lays the city's frame into the first block, once the tileset is known. */
  arrange(root) {
    const content = new Map();
    collect(root, new Matrix4(), content);
    const [known] = this.record.blocks.map(({ frame }) => frame);
    if (known) {
      this.#arrangeBy(known, root);
      return;
    }
    const worlds = this.record.blocks.map((block) => content.get(block.uri)); // none in a nested tileset
    const first = worlds.find(Boolean) ?? new Matrix4();
    const city = Y_UP_FROM_Z_UP.clone().multiply(first.clone().invert());
    city.decompose(this.tiles.group.position, this.tiles.group.quaternion, this.tiles.group.scale);
    this.group.updateMatrixWorld(true);
    const zUpFromYUp = Y_UP_FROM_Z_UP.clone().invert();
    this.record.blocks.forEach((block, i) => {
      if (!worlds[i]) return;
      this.#frame(block, city.clone().multiply(worlds[i]).multiply(zUpFromYUp));
    });
  }

  /** Lays the city by the frames that its record gives: city_from_block, column by column, z up. */
  #arrangeBy(first, root) {
    const level = Y_UP_FROM_Z_UP.clone().multiply(new Matrix4().fromArray(first).invert());
    const rooted = new Matrix4().fromArray(root.transform ?? new Matrix4().elements).invert();
    level.clone().multiply(rooted)
      .decompose(this.tiles.group.position, this.tiles.group.quaternion, this.tiles.group.scale);
    this.group.updateMatrixWorld(true);
    const zUpFromYUp = Y_UP_FROM_Z_UP.clone().invert();
    for (const block of this.record.blocks) {
      if (block.frame) this.#frame(block, level.clone().multiply(new Matrix4().fromArray(block.frame)).multiply(zUpFromYUp));
    }
  }

  /** Keeps where a block lies. */
  #frame(block, matrix) {
    this.frames.set(block.name, matrix);
    const outlines = (block.outline_m ?? []).filter((outline) => outline.length);
    const [xs, zs] = [0, 1].map((i) => outlines.flatMap((one) => this.placed(block, one).map((p) => p[i])));
    this.extents.push({
      block, low: [Math.min(...xs), Math.min(...zs)], high: [Math.max(...xs), Math.max(...zs)],
    });
  }

  /** The buildings of blocks that reach within `reach` metres of [x, z]. */
  near([x, z], reach) {
    const within = ({ low, high }) => !(x < low[0] - reach || x > high[0] + reach
      || z < low[1] - reach || z > high[1] + reach);
    return this.extents.filter((one) => within(one))
      .flatMap(({ block }) => block.buildings.map(({ id }) => this.buildings.get(String(id))));
  }

  /** A building's front by its footprint alone, as `survey` tells walls; null where nothing is known. */
  wallOf({ record, block }) {
    if (!record.footprint_m || !this.frames.has(block.name)) return null;
    const [a, b] = this.placed(block, record.footprint_m);
    const [dx, dz] = [b[0] - a[0], b[1] - a[1]];
    const length = Math.hypot(dx, dz) || 1;
    return { a, b, out: [-dz / length, dx / length], bottom: 0, top: record.height_m ?? 14, kind: 'plain' };
  }

  /** Where a building stands, [x, z], as far as that is known; or null. */
  placeOf(found) {
    const wall = this.wallOf(found);
    if (wall) return [(wall.a[0] + wall.b[0]) / 2, (wall.a[1] + wall.b[1]) / 2];
    const { block } = found;
    const known = this.frames.has(block.name) && block.outline_m?.length;
    return known ? this.placed(block, block.outline_m[0])[0] : null;
  }

  /** The middle of the first block, as far as the tileset tells it. */
  middle() {
    const sphere = new Sphere();
    this.tiles.getBoundingSphere(sphere);
    sphere.applyMatrix4(this.tiles.group.matrixWorld);
    const first = this.record.blocks.find((block) => this.frames.has(block.name) && block.outline_m?.length);
    if (!first) return sphere.center;
    const [x, z] = this.placed(first, first.outline_m[0])[0];
    return new Vector3(x, 0, z);
  }

  /** An outline of a block, as rows of [x, z] in the city's frame. */
  placed(block, outline) {
    const frame = this.frames.get(block.name);
    return outline.map(([east, north]) => {
      const p = new Vector3(east, 0, -north).applyMatrix4(frame);
      return [p.x, p.z];
    });
  }

  /** The building at one face of a mesh, or null. */
  buildingAt(mesh, face) {
    const feature = mesh.geometry.attributes._feature_id_0?.getX(face.a);
    const id = mesh.userData.ids[feature];
    return id === undefined ? null : this.buildings.get(id) ?? null;
  }

  #enter(scene, tile) {
    place(scene, this.tiles.group.matrixWorld);
    const assumed = (id) => Boolean(this.buildings.get(id)?.record.assumed);
    const mesh = united(scene, assumed);
    if (!mesh) {
      scene.traverse((one) => { // volumes that stand for what is far
        if (one.isMesh) one.material = surface(one);
      });
      return;
    }
    place(scene, this.tiles.group.matrixWorld);
    mesh.geometry.boundsTree = new MeshBVH(mesh.geometry);
    mesh.material = surface(mesh);
    this.walls.add(mesh);
    const detail = mesh.material.map?.image?.width ?? 0; // of several models of a building the finest counts
    for (const [feature, shape] of survey(mesh, reader(mesh, this.keys))) {
      const building = this.buildings.get(mesh.userData.ids[feature]);
      if (building && (building.shape === null || detail >= building.detail)) Object.assign(building, { shape, detail });
    }
    this.#welcome(mesh, scene, tile);
  }

  /** Tells of each block that a mesh holds buildings of; a coarse one may hold several. */
  #welcome(mesh, scene, tile) {
    const blocks = new Set(mesh.userData.ids.map((id) => this.buildings.get(id)?.block).filter(Boolean));
    for (const block of blocks) {
      if (!this.frames.has(block.name) && tile.content.uri.endsWith(block.uri)) {
        this.#frame(block, scene.matrixWorld.clone());
      }
      this.standing.set(block, (this.standing.get(block) ?? new Set()).add(mesh));
      if (this.frames.has(block.name)) this.onBlock(block);
    }
  }

  #leave(scene) {
    scene.traverse((mesh) => {
      if (!this.walls.delete(mesh)) return;
      for (const [block, meshes] of this.standing) {
        if (!meshes.delete(mesh) || meshes.size) continue;
        this.standing.delete(block);
        for (const { id } of block.buildings) Object.assign(this.buildings.get(String(id)), { shape: null, detail: 0 });
        this.onGone(block);
      }
      mesh.geometry.dispose();
      mesh.material.dispose();
      mesh.userData.evidence?.dispose();
      mesh.userData.evidence?.image.close?.();
    });
  }
}

/** Reads site.json and starts to load the tileset that it names, both beside the page. */
export async function open(base = '', tell = () => {}) {
  tell('the list of buildings');
  const response = await fetch(`${base}site.json`);
  if (!response.ok) throw new Error(`site.json: ${response.status}`);
  const record = await response.json();
  const tiles = new TilesRenderer(new URL(`${base}${record.tileset}`, location.href).href);
  tiles.registerPlugin(
    new GLTFExtensionsPlugin({ plugins: [(parser) => new EvidenceVariant(parser)] }),
  );
  bound(tiles);
  const city = new City(record, tiles);
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

/** Sets world matrices of a model that is loaded but not yet in the scene. */
function place(object, world) {
  if (object.matrixAutoUpdate) object.updateMatrix();
  object.matrixWorld.multiplyMatrices(world, object.matrix);
  for (const child of object.children) place(child, object.matrixWorld);
}

/** Every content address under a tile, with the transform that places it. */
function collect(tile, parent, found) {
  const world = parent.clone();
  if (tile.transform) world.multiply(new Matrix4().fromArray(tile.transform));
  if (tile.content?.uri) found.set(tile.content.uri, world);
  for (const child of tile.children ?? []) collect(child, world, found);
}
