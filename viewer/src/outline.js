// Closed outlines on the ground: rows of [x, y], first point not repeated.

/** Twice the enclosed area; positive when the outline runs anticlockwise (y up). */
export function signedArea2(outline) {
  let sum = 0;
  outline.forEach(([x, y], i) => {
    const [u, v] = outline[(i + 1) % outline.length];
    sum += x * v - u * y;
  });
  return sum;
}

/** The same outline, anticlockwise, without points that repeat their neighbour. */
export function anticlockwise(outline, tolerance = 1e-6) {
  const kept = outline.filter(([x, y], i) => {
    const [u, v] = outline[(i + 1) % outline.length];
    return Math.hypot(x - u, y - v) > tolerance;
  });
  return signedArea2(kept) < 0 ? kept.reverse() : kept;
}

/** Each edge moved outwards by `distance`, corners mitred (blunt where very sharp). */
export function widened(outline, distance, miterLimit = 2.5) {
  const points = anticlockwise(outline);
  const n = points.length;
  return points.map((here, i) => {
    const before = outwards(points[(i + n - 1) % n], here);
    const after = outwards(here, points[(i + 1) % n]);
    const sum = [before[0] + after[0], before[1] + after[1]];
    const square = sum[0] ** 2 + sum[1] ** 2;
    if (square < 1e-9) return [here[0] + before[0] * distance, here[1] + before[1] * distance];
    const stretch = Math.min(2 / square, miterLimit / Math.sqrt(square));
    return [here[0] + sum[0] * stretch * distance, here[1] + sum[1] * stretch * distance];
  });
}

/** The unit vector that points out of an anticlockwise outline at edge a to b. */
export function outwards([ax, ay], [bx, by]) {
  const length = Math.hypot(bx - ax, by - ay) || 1;
  return [(by - ay) / length, (ax - bx) / length];
}

/** The smallest convex outline round the points, anticlockwise (monotone chain). */
export function hull(points) {
  const sorted = [...points].sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const half = (run) => {
    const chain = [];
    for (const p of run) {
      while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), p) <= 0) chain.pop();
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

const turn = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

/** Whether the point lies inside the outline (even-odd rule). */
export function contains(outline, [x, y]) {
  let inside = false;
  outline.forEach(([ax, ay], i) => {
    const [bx, by] = outline[(i + 1) % outline.length];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  });
  return inside;
}
