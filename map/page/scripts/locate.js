// Which lane is here, by the same order as `roadbed locate`: the distance from the lane's outline,
// then |d|, then the lane's number.

const ON_BORDER = 1e-18;  // squared metres

function squaredToSegment(ax, ay, bx, by, [px, py]) {
  const x = bx - ax, y = by - ay, squared = x * x + y * y;
  const share = squared > 0 ? Math.min(1, Math.max(0, ((px - ax) * x + (py - ay) * y) / squared)) : 0;
  return [(px - ax - share * x) ** 2 + (py - ay - share * y) ** 2, share];
}

/** 0 inside; else the squared distance from the ring. */
function squaredToRing(ring, point) {
  const [px, py] = point;
  let inside = false, least = Infinity;
  for (let k = 0, last = ring.length - 2; k < ring.length; last = k, k += 2) {
    const ax = ring[last], ay = ring[last + 1], bx = ring[k], by = ring[k + 1];
    if ((ay > py) !== (by > py) && px < ax + (py - ay) / (by - ay) * (bx - ax)) inside = !inside;
    least = Math.min(least, squaredToSegment(ax, ay, bx, by, point)[0]);
  }
  return inside || least <= ON_BORDER ? 0 : least;
}

/** The nearest place of a lane's centreline: s, and d to its left; with the heading there. */
function placeOnLane(lanes, i, point) {
  const {xy} = lanes.lines, [from, to] = rangeOfLine(lanes, i, CENTRE), stations = stationsOfLine(lanes, i, CENTRE);
  let best = Infinity, at = 0, share = 0;
  for (let k = from, n = 0; k + 3 < to; k += 2, ++n) {
    const [squared, along] = squaredToSegment(xy[k], xy[k + 1], xy[k + 2], xy[k + 3], point);
    if (squared < best) [best, at, share] = [squared, n, along];
  }
  const k = from + 2 * at, x = xy[k + 2] - xy[k], y = xy[k + 3] - xy[k + 1];
  const side = x * (point[1] - xy[k + 1]) - y * (point[0] - xy[k]) < 0 ? -1 : 1;
  return {lane: i, s: stations[at] + share * (stations[at + 1] - stations[at]), d: side * Math.sqrt(best),
          heading: Math.atan2(y, x)};
}

function isNearer(a, b) {
  if (a.distance !== b.distance) return a.distance < b.distance;
  return Math.abs(a.d) !== Math.abs(b.d) ? Math.abs(a.d) < Math.abs(b.d) : a.lane < b.lane;
}

/** Lanes within a radius, nearest first. */
function lanesNear(map, [x, y], radius) {
  const found = [];
  for (const i of inBox(map.grid, [x - radius, y - radius, x + radius, y + radius])) {
    if (distanceToBox(map.lanes.boxes, i, [x, y]) > radius) continue;
    const ring = ringOf(map.lanes, i);
    if (ring.length < 6) continue;
    const distance = Math.sqrt(squaredToRing(ring, [x, y]));
    if (distance <= radius) found.push({distance, ...placeOnLane(map.lanes, i, [x, y])});
  }
  return found.sort((a, b) => (isNearer(a, b) ? -1 : 1));
}

function distanceToBox(boxes, i, [x, y]) {
  return Math.hypot(Math.max(boxes[4 * i] - x, 0, x - boxes[4 * i + 2]), Math.max(boxes[4 * i + 1] - y, 0, y - boxes[4 * i + 3]));
}

/** How far the lane is away whose box is nearest: no farther lane can be the nearest one. */
function boundOf({lanes}, ids, point) {
  let nearest = ids[0], least = Infinity;
  for (const i of ids) {
    const distance = distanceToBox(lanes.boxes, i, point);
    if (distance < least) [nearest, least] = [i, distance];
  }
  return Math.sqrt(squaredToRing(ringOf(lanes, nearest), point));
}

/** The lane that `roadbed locate` names first; null if there is none within 50 km. */
function locate(map, point) {
  const [x, y] = point, {lanes} = map;
  for (let radius = 1; radius < 1e5; radius *= 2) {
    const ids = inBox(map.grid, [x - radius, y - radius, x + radius, y + radius]).filter((i) => ringOf(lanes, i).length >= 6);
    if (ids.length > 0) return lanesNear(map, point, boundOf(map, ids, point) + 1e-6)[0];
  }
  return null;
}

/** The point (s, d) of a lane. */
function pointOnLane(lanes, i, s, d = 0) {
  const {xy} = lanes.lines, [from] = rangeOfLine(lanes, i, CENTRE), stations = stationsOfLine(lanes, i, CENTRE);
  const n = Math.min(Math.max(stations.findLastIndex((one) => one <= s), 0), stations.length - 2), k = from + 2 * n;
  const length = stations[n + 1] - stations[n] || 1, share = Math.min(Math.max((s - stations[n]) / length, 0), 1);
  const ux = (xy[k + 2] - xy[k]) / length, uy = (xy[k + 3] - xy[k + 1]) / length;
  return [xy[k] + share * length * ux - d * uy, xy[k + 1] + share * length * uy + d * ux];
}

function distanceToLine(lanes, i, line, point) {
  const {xy} = lanes.lines, [from, to] = rangeOfLine(lanes, i, line);
  let least = Infinity;
  for (let k = from; k + 3 < to; k += 2) {
    least = Math.min(least, squaredToSegment(xy[k], xy[k + 1], xy[k + 2], xy[k + 3], point)[0]);
  }
  return Math.sqrt(least);
}

/** Between the borders, across the centreline. */
function widthAt(lanes, i, s) {
  const point = pointOnLane(lanes, i, s);
  return distanceToLine(lanes, i, LEFT, point) + distanceToLine(lanes, i, RIGHT, point);
}

/** OpenDRIVE's s and t: along the road's reference line, within the lane's section. */
function placeOnRoad(map, lane, [px, py]) {
  const road = map.lanes.road[lane];
  if (road < 0) return null;
  const {xy, starts} = map.roads.references, n = map.lanes.onRoad[lane];
  const [low, high] = [map.lanes.roadFrom[n], map.lanes.roadTo[n]].map((mm) => mm / 1000).sort((a, b) => a - b);
  let best = null;
  for (let k = starts[road]; k + 1 < starts[road + 1]; ++k) {
    const [ax, ay, bx, by] = xy.subarray(2 * k, 2 * k + 4), s0 = map.roads.roadS[k], s1 = map.roads.roadS[k + 1];
    if (s1 < low - 1e-3 || s0 > high + 1e-3) continue;
    const [squared, share] = squaredToSegment(ax, ay, bx, by, [px, py]);
    if (best && squared >= best.squared) continue;
    const side = (bx - ax) * (py - ay) - (by - ay) * (px - ax) < 0 ? -1 : 1;
    best = {squared, s: s0 + share * (s1 - s0), t: side * Math.sqrt(squared)};
  }
  return best && {s: best.s, t: best.t};
}
