// Where the walker stands, as text in the address bar, so that a view can be shared.
//
// Metres east and south of the city's origin, height of the eyes, yaw and pitch in
// degrees; yaw 0 looks north and grows to the left, as three.js turns.

const FIELDS = ['x', 'y', 'z', 'yaw', 'pitch'];
const LIMIT = 1e6;

/** `#at=12.3,1.5,-4.0,90.0,0.0&building=993-11`: what `fromHash` reads back. */
export function toHash({ pose, building = null, then = null, evidence = false, bird = false }) {
  const at = FIELDS.map((name) => pose[name].toFixed(name === 'y' ? 2 : 1)).join(',');
  const parts = [`at=${at}`];
  if (building) parts.push(`building=${encodeURIComponent(building)}`);
  if (then) parts.push(`then=${encodeURIComponent(then)}`);
  if (evidence) parts.push('evidence');
  if (bird) parts.push('bird');
  return `#${parts.join('&')}`;
}

/** The view that a hash names; whatever is missing or malformed is null or false. */
export function fromHash(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ''));
  return {
    pose: poseFrom(query.get('at')),
    building: query.get('building'),
    then: query.get('then'), // the key of a photograph
    evidence: query.has('evidence'),
    bird: query.has('bird'),
  };
}

function poseFrom(text) {
  const numbers = (text ?? '').split(',').map((part) => (part.trim() ? Number(part) : NaN));
  const sound = numbers.length === FIELDS.length
    && numbers.every((n) => Number.isFinite(n) && Math.abs(n) < LIMIT);
  return sound ? Object.fromEntries(FIELDS.map((name, i) => [name, numbers[i]])) : null;
}
