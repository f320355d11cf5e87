// What tests and scripts may ask of a page, as `window.nostalgin`.

/** `starting` is a promise of the page; until it holds, only `ready` is of use. */
export function api(starting) {
  let page = null;
  const ready = starting.then((started) => {
    page = started;
    return true;
  });
  ready.catch(() => {}); // the page itself has told what is wrong
  return {
    ready,
    get page() { return page; },
    get pose() { return page.walker.pose; },
    get stats() { return stats(page); },
    setPose(pose) {
      page.walker.pose = pose;
      page.aim();
    },
    hold(on = true) { page.held = on; },
    step(dt) {
      page.step(dt);
      page.city.update(page.walker.feet);
      page.draw();
    },
    pick: (x, y) => page.pick(x, y),
    select: (id) => page.select(id),
    setEvidence: (on) => page.setEvidence(on),
    setBird: (on) => page.setBird(on, true),
  };
}

function stats({ city, stage, height }) {
  const { calls, triangles } = stage.renderer.info.render;
  return {
    loaded: city.loaded,
    blocks: city.record.blocks.length,
    progress: city.tiles.loadProgress,
    errors: [...city.errors],
    walls: city.walls.size,
    calls,
    triangles,
    height,
  };
}
