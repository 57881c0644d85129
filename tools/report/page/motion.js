// Where things are at a time.

/** Index of the last entry of the increasing `times` that is at most `t`; −1 if there is none. */
function lastAtOrBefore(times, t) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle + 1; else high = middle;
  }
  return low - 1;
}

/** Index of the entry of the increasing `times` nearest to `t`; the earlier of two equally near. */
function nearestTo(times, t) {
  const i = lastAtOrBefore(times, t);
  if (i < 0) return times.length > 0 ? 0 : -1;
  return i + 1 < times.length && times[i + 1] - t < t - times[i] ? i + 1 : i;
}

/** State of a motion at `t`, every field linear between rows and clamped to the ends. */
function stateAt(motion, t) {
  const i = lastAtOrBefore(motion.t, t), last = motion.t.length - 1;
  const a = Math.max(i, 0), b = Math.min(a + (i < 0 ? 0 : 1), last);
  const span = motion.t[b] - motion.t[a];
  const share = span > 0 ? (t - motion.t[a]) / span : 0;
  const state = {};
  for (const field of Object.keys(motion)) {
    state[field] = motion[field][a] + share * (motion[field][b] - motion[field][a]);
  }
  return state;
}

/** Corners of a rectangle from `back` to `front` along a heading, `width` across it. */
function rectangle(x, y, heading, back, front, width) {
  const c = Math.cos(heading), s = Math.sin(heading), half = width / 2;
  return [[back, -half], [front, -half], [front, half], [back, half]]
      .map(([along, across]) => [x + c * along - s * across, y + s * along + c * across]);
}

/** Points of a vehicle's frame, where it stands in a state. */
function placed(state, points) {
  const c = Math.cos(state.h), s = Math.sin(state.h);
  return points.map(([along, across]) =>
      [state.x + c * along - s * across, state.y + s * along + c * across]);
}

/** Points of a motion between two times, both ends interpolated. */
function pathBetween(motion, from, to) {
  const points = [];
  const add = (state) => points.push([state.x, state.y]);
  if (motion.t.length === 0 || to < from) return points;
  add(stateAt(motion, from));
  for (let i = lastAtOrBefore(motion.t, from) + 1; i < motion.t.length && motion.t[i] < to; ++i) {
    points.push([motion.x[i], motion.y[i]]);
  }
  add(stateAt(motion, to));
  return points;
}
