import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Matrix4, PerspectiveCamera, Vector3 } from 'three';

import { even, fitted, holding, mixed, seenAt, through } from '../src/lens.js';
import { photoOf, stationOf, told } from '../src/then.js';
import { Flight, between, show, shownBy } from '../src/view.js';

const SCREEN = { width: 1280, height: 800 };
const PHOTO = { size_px: [560, 840], focal_px: 700, centre_px: [281.5, 402.25] };
const SHOT = { // ten metres south of the block's origin, eyes at 1.6 m, looking north and upwards
  ...PHOTO,
  position_m: [2, -10, 1.6],
  position_sd_m: 0.8,
  roof_m: 12,
  block_from_camera: [[1, 0, 0], [0, 0.2, Math.sqrt(0.96)], [0, -Math.sqrt(0.96), 0.2]],
};

const near = (a, b, off = 1e-6) => a.forEach((v, i) => assert.ok(Math.abs(v - b[i]) < off, `${a} is not ${b}`));

test('a picture lies whole in its room, as large as it allows', () => {
  const box = fitted([560, 840], { x: 10, y: 20, width: 1000, height: 420 });
  near([box.height, box.width, box.y, box.x + box.width / 2], [420, 280, 20, 510]);
});

test('what a camera saw at a pixel of its photograph lies at that pixel of the photograph on the screen', () => {
  const box = fitted(PHOTO.size_px, { x: 12, y: 12, width: 1256, height: 600 });
  const frustum = through(PHOTO, box, SCREEN);
  for (const [x, y] of [[0, 0], [559, 0], [120, 700], [281.5, 402.25]]) {
    const ray = [(x - PHOTO.centre_px[0]) / PHOTO.focal_px, (y - PHOTO.centre_px[1]) / PHOTO.focal_px, 1];
    const at = seenAt(ray.map((v) => v * 7.3), frustum, SCREEN);
    near(at, [box.x + (x + 0.5) * box.scale, box.y + (y + 0.5) * box.scale]);
  }
});

test('a camera that shows a frustum projects as the frustum does, and shows itself again', () => {
  const camera = new PerspectiveCamera(62, 1.6, 0.12, 800);
  const frustum = through(PHOTO, fitted(PHOTO.size_px, { x: 0, y: 0, ...SCREEN }), SCREEN);
  const station = stationOf(SHOT, new Matrix4());
  show(camera, { ...station, frustum });
  const point = new Vector3(5, 9, -3);
  const inCamera = point.clone().applyMatrix4(camera.matrixWorldInverse);
  const ndc = point.clone().project(camera);
  const at = seenAt([inCamera.x, -inCamera.y, -inCamera.z], frustum, SCREEN);
  near(at, [((ndc.x + 1) / 2) * SCREEN.width, ((1 - ndc.y) / 2) * SCREEN.height], 1e-3);
  const { frustum: again } = shownBy(camera);
  near(Object.values(again), [frustum.left, frustum.right, frustum.top, frustum.bottom], 1e-5);
});

test('a point behind the camera is nowhere', () => {
  assert.equal(seenAt([0, 0, -1], even(60, 1), SCREEN), null);
});

test('the photographer looks where the record says, in whatever frame the block lies', () => {
  const turned = new Matrix4().makeRotationY(0.7).setPosition(100, 0, -40);
  for (const frame of [new Matrix4(), turned]) {
    const { position, quaternion } = stationOf(SHOT, frame);
    near(position.toArray(), new Vector3(2, 1.6, 10).applyMatrix4(frame).toArray());
    const ahead = new Vector3(0, 0, -1).applyQuaternion(quaternion);
    const expected = new Vector3(0, 0.2, -Math.sqrt(0.96)).transformDirection(frame);
    near(ahead.toArray(), expected.toArray());
    const right = new Vector3(1, 0, 0).applyQuaternion(quaternion);
    near(right.toArray(), new Vector3(1, 0, 0).transformDirection(frame).toArray());
  }
});

test('a building is seen through the photograph named, else through its first that tells', () => {
  const photos = [
    { key: 'a', file: 'photos/a.webp' },
    { key: 'b', file: 'photos/b.webp', camera: SHOT },
    { key: 'c', file: 'photos/c.webp', camera: SHOT },
    { key: 'd', file: 'https://elsewhere/d.webp', camera: SHOT },
  ];
  const building = { record: { photos } };
  assert.equal(photoOf(building).key, 'b');
  assert.equal(photoOf(building, 'c').key, 'c');
  for (const key of ['a', 'd', 'e']) assert.equal(photoOf(building, key), null);
  assert.equal(photoOf({ record: {} }), null);
});

test('the stated error is told, and what disagrees', () => {
  assert.match(told(SHOT, { height_m: 12.4 }), /give or take 0\.8 m; the camera 1\.6 m/);
  assert.doesNotMatch(told(SHOT, { height_m: 12.4 }), /the model has it/);
  assert.match(told(SHOT, { height_m: 17 }), /12 m high, the model has it 17 m/);
  assert.match(told({ ...SHOT, position_m: [2, -10, -0.6] }, { height_m: 12 }), /not known/);
});

test('a view that holds a front holds its four corners', () => {
  for (const [width, top, distance, aspect] of [[18, 60, 14, 1.6], [60, 9, 20, 1.6], [8, 12, 30, 0.5]]) {
    const { fov, tilt } = holding({ width, top }, distance, 1.62, aspect);
    const camera = new PerspectiveCamera(fov + 0.01, aspect, 0.1, 500);
    camera.position.set(0, 1.62, distance);
    camera.rotation.set((tilt * Math.PI) / 180, 0, 0);
    camera.updateMatrixWorld();
    for (const [x, y] of [[-1, 0], [1, 0], [1, 1], [-1, 1]]) {
      const at = new Vector3((x * width) / 2, y * top, 0).project(camera);
      assert.ok(Math.max(Math.abs(at.x), Math.abs(at.y)) <= 1, `${width} x ${top}: ${at.toArray()}`);
    }
  }
});

test('a flight begins at the one view and ends at the other', () => {
  const a = { ...stationOf(SHOT, new Matrix4()), frustum: even(50, 1) };
  const b = { ...stationOf({ ...SHOT, position_m: [90, 4, 1.6] }, new Matrix4()), frustum: even(70, 1) };
  near(between(a, b, 0, 30).position.toArray(), a.position.toArray());
  near(between(a, b, 1, 30).position.toArray(), b.position.toArray());
  assert.ok(between(a, b, 0.5, 30).position.y > 30);
  near(Object.values(mixed(a.frustum, b.frustum, 1)), Object.values(b.frustum));
  const flight = new Flight();
  let there = false;
  flight.depart(a, 2, () => { there = true; });
  near(flight.over(b).position.toArray(), a.position.toArray());
  flight.step(1.9);
  assert.equal(there, false);
  flight.step(0.2);
  assert.ok(there && flight.over(b) === b);
});

test('who wants less motion is there at once', () => {
  const flight = new Flight();
  let there = false;
  flight.depart({}, 0, () => { there = true; });
  assert.ok(there && !flight.on);
});
