// Numbers and places as a reader wants them.

/** `12.4 m ± 0.6`, or a dash where nothing is known. */
export function metres(value, sd = null) {
  if (!Number.isFinite(value)) return '—';
  const spread = Number.isFinite(sd) ? ` ± ${sd.toFixed(1)}` : '';
  return `${value.toFixed(1)}${spread} m (${feet(value)})`;
}

/** Feet and inches, as the catalogues of the time give them. */
export function feet(value) {
  const inches = Math.round(value / 0.0254);
  return `${Math.floor(inches / 12)}′ ${inches % 12}″`;
}

/** A share from 0 to 1 as a whole percentage that never rounds up to all or down to none. */
export function percent(share) {
  if (!Number.isFinite(share)) return '—';
  const whole = Math.round(share * 100);
  if (share > 0 && whole === 0) return 'under 1 %';
  if (share < 1 && whole === 100) return '99 %';
  return `${whole} %`;
}

/** What to call a building: its address, or else its lot. */
export function nameOf(building) {
  return building.address || `Lot ${building.lot ?? building.id}`;
}
