// The city: its list of blocks (site.json), their records and models (3D Tiles), in one level frame.
//
// The frame is the first block's: x east, y up, z south, in metres.

import { Group, Matrix4, OrthographicCamera, Sphere, Vector3 } from 'three';
import { MeshBVH } from 'three-mesh-bvh';

import { keysOf } from './evidence.js';
import { reader, united } from './model.js';
import { surface, unlock } from './paint.js';
import { Records } from './records.js';
import { survey } from './survey.js';

const Y_UP_FROM_Z_UP = new Matrix4().makeRotationX(-Math.PI / 2);
const NEAR_M = 90; // blocks this close are loaded, whichever way the walker looks

export class City {
  /** @param record site.json; @param tiles the running TilesRenderer */
  constructor(record, tiles, base = '') {
    this.record = record;
    this.tiles = tiles;
    this.keys = keysOf(record.legend); // colours of the evidence images' codes
    unlock(this.keys);
    this.group = new Group();
    this.group.add(tiles.group);
    this.frames = new Map(); // block name -> Matrix4, city_from_block (y up)
    this.walls = new Set(); // meshes that can be walked into and clicked
    this.records = new Records(record.blocks, record.elsewhere, base);
    this.contents = new Map(record.blocks.flatMap((block) => [[block.uri, block], [block.coarse, block]]));
    this.entering = new WeakMap(); // a model that is not in the scene yet -> its block's buildings
    this.failed = new Set(); // blocks, and addresses of what else can't be had
    this.errors = [];
    this.onBlock = () => {};
    this.onGone = () => {};
    this.standing = new Map(); // block -> its meshes that are loaded
    this.extents = []; // of blocks, on the ground, for `near`
    this.nearby = new OrthographicCamera(-NEAR_M, NEAR_M, NEAR_M, -NEAR_M, 1, 2000);
    this.camera = null; // whose view is loaded, see `all`
    tiles.loadAncestors = tiles.loadSiblings = false; // at first only what one stands before
    tiles.setCamera(this.nearby);
    tiles.setResolution(this.nearby, 512, 512);
    tiles.addEventListener('load-model', ({ scene, tile }) => this.#enter(scene, tile));
    tiles.addEventListener('dispose-model', ({ scene }) => this.#leave(scene));
    this.onError = () => {};
    this.holds = () => []; // ids of buildings whose records stay
    tiles.addEventListener('load-error', ({ error, tile }) => {
      this.errors.push(String(error));
      this.failed.add(this.#blockOf(tile) ?? tile?.content?.uri);
      this.onError(error);
    });
    this.#accompany(tiles);
  }

  /** Sees to it that a block's records come with its model, and are there before it. */
  #accompany(tiles) {
    tiles.addEventListener('tile-download-start', ({ tile }) => {
      const block = this.#blockOf(tile);
      if (block) this.records.read(block).catch(() => {}); // the model's turn comes to say so
    });
    tiles.registerPlugin({
      name: 'NOSTALGIN_records',
      processTileModel: async (scene, tile) => {
        const block = this.#blockOf(tile);
        if (block) this.entering.set(scene, await this.records.read(block));
      },
    });
  }

  /** The block that a tile shows; none of a district's volumes. */
  #blockOf(tile) {
    return this.contents.get(tile?.content?.uri?.split('/').slice(-2).join('/'));
  }

  /** The buildings whose records are here, by their ids. */
  get buildings() {
    return this.records.buildings;
  }

  /** The building of an id, once it is known; null where the city has none. */
  async find(id) {
    const found = await this.records.find(id);
    this.tidy();
    return found;
  }

  /** Lets go of what is known of blocks long left. */
  tidy() {
    const held = new Set(this.holds().map((id) => this.buildings.get(id)?.block));
    this.records.prune((block) => this.standing.has(block) || held.has(block));
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

  /** The blocks that reach within `reach` metres of [x, z]. */
  about([x, z], reach) {
    const within = ({ low, high }) => !(x < low[0] - reach || x > high[0] + reach
      || z < low[1] - reach || z > high[1] + reach);
    return this.extents.filter((one) => within(one)).map(({ block }) => block);
  }

  /** Their buildings, as far as these are known by now. */
  near(at, reach) {
    return this.about(at, reach).flatMap((block) => this.records.of(block));
  }

  /** A building's front by its footprint alone, as `survey` tells walls; null where nothing is known. */
  wallOf({ record, block }) {
    if (!record.footprint_m || !this.frames.has(block.name)) return null;
    const [a, b] = this.placed(block, record.footprint_m);
    const [dx, dz] = [b[0] - a[0], b[1] - a[1]];
    const length = Math.hypot(dx, dz) || 1;
    return { a, b, out: [-dz / length, dx / length], bottom: 0, top: record.height_m ?? 14, kind: 'plain' };
  }

  /** Where a stop of the city's tour is, [x, z]; or null. */
  placeOf({ block, at_m: at }) {
    return this.frames.has(block) ? this.placed({ name: block }, [at])[0] : null;
  }

  /** The middle of the first block that can be had, as far as the tileset tells it. */
  middle() {
    const sphere = new Sphere();
    this.tiles.getBoundingSphere(sphere);
    sphere.applyMatrix4(this.tiles.group.matrixWorld);
    const first = this.record.blocks.find((block) => this.frames.has(block.name) && block.outline_m?.length
      && !this.failed.has(block));
    const { center } = sphere;
    const [x, z] = first ? this.placed(first, first.outline_m[0])[0] : [center.x, center.z];
    return { x, z };
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
    if (this.entering.has(scene)) this.records.keep(this.#blockOf(tile), this.entering.get(scene));
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
        for (const found of this.records.of(block)) Object.assign(found, { shape: null, detail: 0 });
        this.onGone(block);
        this.tidy();
      }
      mesh.geometry.dispose();
      mesh.material.dispose();
      mesh.userData.evidence?.dispose();
      mesh.userData.evidence?.image.close?.();
    });
  }
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
