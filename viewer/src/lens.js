// A view's edges as tangents of the angles from its axis, so that a photograph's own
// off-centre frustum and the walker's even one are of one kind.

/** An even frustum. */
export function even(fovDeg, aspect) {
  const up = Math.tan((fovDeg * Math.PI) / 360);
  return { left: -up * aspect, right: up * aspect, top: up, bottom: -up };
}

/** Where a picture of `[width, height]` lies on the screen, whole and as large as `room` allows. */
export function fitted([width, height], room) {
  const scale = Math.min(room.width / width, room.height / height);
  return {
    x: room.x + (room.width - width * scale) / 2,
    y: room.y + (room.height - height * scale) / 2,
    width: width * scale,
    height: height * scale,
    scale,
  };
}

/**
 * The frustum in which what a photo's camera saw falls on the photo, laid at `box` on a screen.
 *
 * `focal_px` and `centre_px` are in the photo's pixels, whose centres lie at whole numbers.
 */
export function through({ focal_px: focal, centre_px: [x, y] }, box, screen) {
  const at = [box.x + (x + 0.5) * box.scale, box.y + (y + 0.5) * box.scale]; // the axis, on the screen
  const unit = focal * box.scale;
  return {
    left: -at[0] / unit,
    right: (screen.width - at[0]) / unit,
    top: at[1] / unit,
    bottom: -(screen.height - at[1]) / unit,
  };
}

/** Between two frusta, `t` from 0 to 1. */
export function mixed(a, b, t) {
  return Object.fromEntries(Object.keys(a).map((edge) => [edge, a[edge] + (b[edge] - a[edge]) * t]));
}

/** Where a point in camera axes (right, down, ahead) falls on the screen, in its pixels; null behind. */
export function seenAt([right, down, ahead], frustum, screen) {
  if (ahead <= 0) return null;
  const { left, right: far, top, bottom } = frustum;
  return [
    ((right / ahead - left) / (far - left)) * screen.width,
    ((top + down / ahead) / (top - bottom)) * screen.height,
  ];
}

/** How wide a view has to be, in degrees, to hold a front from `distance` metres, and its tilt. */
export function holding({ width, top }, distance, eye, aspect) {
  const [up, down] = [Math.atan2(top - eye, distance), Math.atan2(-eye, distance)];
  const tilt = (up + down) / 2;
  // the farthest corner aside is the nearest along the tilted axis
  const near = Math.min(...[top - eye, -eye].map((y) => distance * Math.cos(tilt) + y * Math.sin(tilt)));
  const aside = near > 0 ? width / 2 / near / aspect : Infinity;
  const half = Math.max(Math.tan((up - down) / 2), aside);
  return { fov: (Math.atan(half) * 360) / Math.PI, tilt: (tilt * 180) / Math.PI };
}
