// Draws the map into a tile. `pen` has the context and how metres become pixels; lines of a colour
// are gathered into one path, which is what a browser draws fastest.

const COARSE = 0.6;    // pixels per metre below which a lane is a line
const BORDERS = 1.2;   // from here on borders show
const MARKINGS = 3.5;  // from here on markings show as they are painted
const ARROWS = 3;
const ICONS = 0.9;     // signals, objects
const BATCH = 250;     // lanes drawn between two looks at the time

const SOLID = new Set([1, 3, 4, 5]), BROKEN = new Set([2, 6, 7]), BUILT = new Set([8, 10]);  // map::MarkType

function makePen(ctx, box, scale, ratio, ink) {
  return {ctx, box, scale, ratio, ink, k: scale * ratio, x0: box[0], y1: box[3], seen: new Map()};
}

function px(pen, x) {
  return (x - pen.x0) * pen.k;
}

function py(pen, y) {
  return (pen.y1 - y) * pen.k;
}

/** Adds points from..to (exclusive) of flat coordinates, without those less than a pixel on. */
function addFlat(pen, path, xy, from, to, starts) {
  const least = 0.7 * 0.7;
  let lastX = NaN, lastY = NaN;
  const step = from < to ? 2 : -2, end = from < to ? to - 2 : to + 2;
  for (let k = from; step > 0 ? k <= end : k >= end; k += step) {
    const x = px(pen, xy[k]), y = py(pen, xy[k + 1]);
    if (k === from && starts) {
      path.moveTo(x, y);
    } else {
      if (k !== end && (x - lastX) ** 2 + (y - lastY) ** 2 < least) continue;
      path.lineTo(x, y);
    }
    lastX = x;
    lastY = y;
  }
}

function addRingOf(pen, path, lanes, i) {
  const {xy} = lanes.lines;
  if (lanes.ringOf[i] >= 0) {
    const ring = ringOf(lanes, i);
    addFlat(pen, path, ring, 0, ring.length, true);
  } else {
    const [l0, l1] = rangeOfLine(lanes, i, LEFT), [r0, r1] = rangeOfLine(lanes, i, RIGHT);
    addFlat(pen, path, xy, r0, r1, true);
    addFlat(pen, path, xy, l1 - 2, l0 - 2, false);
  }
  path.closePath();
}

/** Calls `draw` with each class and its lanes, those that nobody drives on first. */
function* eachClass(pen, map, ids, draw) {
  const {classes, keys} = map.colouring, groups = new Map();
  for (const i of ids) {
    const group = classes[i] * 2 + map.lanes.drivable[i];
    if (!groups.has(group)) groups.set(group, []);
    groups.get(group).push(i);
  }
  for (const group of [...groups.keys()].sort((a, b) => (a & 1) - (b & 1) || a - b)) {
    const all = groups.get(group);
    for (let from = 0; from < all.length; from += BATCH) {
      draw(pen.ink("lane-" + keys[group >> 1]), all.slice(from, from + BATCH));
      yield;
    }
  }
}

/** Whether a lane of a few pixels looks like one that the tile has in this colour already. */
function isRepeated(pen, lanes, colour, i) {
  const {xy} = lanes.lines, [from, to] = rangeOfLine(lanes, i, CENTRE), {seen} = pen;
  const [x0, y0, x1, y1] = [px(pen, xy[from]), py(pen, xy[from + 1]), px(pen, xy[to - 2]), py(pen, xy[to - 1])].map(Math.round);
  const [left, low, right, high] = lanes.boxes.subarray(4 * i, 4 * i + 4);
  if ((right - left) * pen.k > 6 || (high - low) * pen.k > 6) return false;
  if (!seen.has(colour)) seen.set(colour, new Set());
  const key = ((x0 * 2048 + y0) * 16 + (x1 - x0)) * 16 + (y1 - y0), known = seen.get(colour).has(key);
  seen.get(colour).add(key);
  return known;
}

function strokeLanes(pen, lanes, colour, ids) {
  const {ctx} = pen, byWidth = new Map();
  for (const i of ids) {
    const width = Math.max(1, Math.round(lanes.width[i] * pen.scale));
    if (!byWidth.has(width)) byWidth.set(width, []);
    byWidth.get(width).push(i);
  }
  ctx.strokeStyle = colour;
  for (const [width, those] of byWidth) {
    ctx.lineWidth = width * pen.ratio;
    ctx.beginPath();
    for (const i of those) {
      if (!isRepeated(pen, lanes, colour, i)) addFlat(pen, ctx, lanes.lines.xy, ...rangeOfLine(lanes, i, CENTRE), true);
    }
    ctx.stroke();
  }
}

function fillLanes(pen, lanes, colour, ids) {
  const {ctx} = pen;
  ctx.beginPath();
  for (const i of ids) addRingOf(pen, ctx, lanes, i);
  ctx.fillStyle = colour;
  ctx.fill();
  ctx.strokeStyle = colour;  // hides the seams between lanes
  ctx.lineWidth = 0.6 * pen.ratio;
  ctx.stroke();
}

function strokeBorders(pen, lanes, ids) {
  const {ctx} = pen;
  ctx.beginPath();
  for (const i of ids) {
    addFlat(pen, ctx, lanes.lines.xy, ...rangeOfLine(lanes, i, LEFT), true);
    addFlat(pen, ctx, lanes.lines.xy, ...rangeOfLine(lanes, i, RIGHT), true);
  }
  ctx.strokeStyle = pen.ink("border");
  ctx.lineWidth = Math.min(1, 0.4 * pen.scale) * pen.ratio;
  ctx.stroke();
}

/** The part of a lane's line between two stations of the lane, as pixels. */
function stretchOf(pen, lanes, i, line, from, to, length) {
  const stations = stationsOfLine(lanes, i, line), {xy} = lanes.lines, [first] = rangeOfLine(lanes, i, line);
  const share = stations.at(-1) / Math.max(length, 1e-9), low = from * share, high = Math.min(to * share, stations.at(-1));
  const at = (s) => {
    const n = Math.min(Math.max(stations.findLastIndex((one) => one <= s), 0), stations.length - 2), k = first + 2 * n;
    const part = (s - stations[n]) / (stations[n + 1] - stations[n] || 1);
    return [px(pen, xy[k] + part * (xy[k + 2] - xy[k])), py(pen, xy[k + 1] + part * (xy[k + 3] - xy[k + 1]))];
  };
  const points = [at(low)];
  stations.forEach((s, n) => (s > low && s < high ? points.push([px(pen, xy[first + 2 * n]), py(pen, xy[first + 2 * n + 1])]) : null));
  points.push(at(high));
  return points;
}

function styleOfMark(type, yellow) {
  if (SOLID.has(type)) return yellow ? "solid yellow" : "solid white";
  if (BROKEN.has(type)) return yellow ? "broken yellow" : "broken white";
  return BUILT.has(type) ? "built" : "faint";
}

function strokeMarkings(pen, lanes, ids) {
  const {ctx} = pen, paths = new Map();
  const add = (style, points) => {
    if (!paths.has(style)) paths.set(style, new Path2D());
    points.forEach(([x, y], n) => (n === 0 ? paths.get(style).moveTo(x, y) : paths.get(style).lineTo(x, y)));
  };
  for (const i of ids) {
    const length = lengthOf(lanes, i);
    for (const isRight of [false, true]) {
      const marks = marksOf(lanes, i, isRight), line = isRight ? RIGHT : LEFT;
      if (marks.length === 0) add("faint", stretchOf(pen, lanes, i, line, 0, length, length));
      marks.forEach(([from, type, yellow], n) =>
          add(styleOfMark(type, yellow), stretchOf(pen, lanes, i, line, from, marks[n + 1]?.[0] ?? length, length)));
    }
  }
  for (const [style, path] of paths) {
    const [kind, colour] = style.split(" "), metres = pen.k;
    ctx.setLineDash(kind === "broken" ? [3 * metres, 6 * metres] : []);
    ctx.strokeStyle = pen.ink(kind === "faint" ? "border" : kind === "built" ? "kerb" : "mark-" + colour);
    ctx.lineWidth = kind === "faint" ? pen.ratio : Math.max(0.13 * pen.k, pen.ratio);
    ctx.stroke(path);
  }
  ctx.setLineDash([]);
}

/** Chevrons along drivable lanes, where traffic goes. */
function strokeArrows(pen, lanes, ids) {
  const {ctx} = pen, reach = Math.min(1.2, 14 / pen.scale), spacing = Math.max(30, 160 / pen.scale);
  ctx.beginPath();
  for (const i of ids) {
    if (!lanes.drivable[i]) continue;
    const length = lengthOf(lanes, i);
    if (length < 3 * reach) continue;
    const count = Math.max(1, Math.floor(length / spacing));
    for (let n = 0; n < count; ++n) {
      const s = (n + 0.5) * length / count;
      const [tip, left, right] = [[s + reach, 0], [s, 0.5 * reach], [s, -0.5 * reach]].map(([along, d]) => pointOnLane(lanes, i, along, d));
      ctx.moveTo(px(pen, left[0]), py(pen, left[1]));
      ctx.lineTo(px(pen, tip[0]), py(pen, tip[1]));
      ctx.lineTo(px(pen, right[0]), py(pen, right[1]));
    }
  }
  ctx.strokeStyle = pen.ink("arrow");
  ctx.lineWidth = 1.4 * pen.ratio;
  ctx.stroke();
}

function addPoints(pen, path, points, close) {
  points.forEach(([x, y], n) => (n === 0 ? path.moveTo(px(pen, x), py(pen, y)) : path.lineTo(px(pen, x), py(pen, y))));
  if (close) path.closePath();
}

function fillPoints(pen, rings, colour) {
  const {ctx} = pen;
  ctx.beginPath();
  for (const ring of rings) addPoints(pen, ctx, ring, true);
  ctx.fillStyle = colour;
  ctx.fill("evenodd");
}

function* paintLanes(pen, map, ids, layers) {
  const {lanes} = map, coarse = pen.scale < COARSE;
  yield* eachClass(pen, map, ids, (colour, some) => (coarse ? strokeLanes : fillLanes)(pen, lanes, colour, some));
  if (pen.scale < BORDERS) return;
  for (let from = 0; from < ids.length; from += BATCH) {
    const some = ids.slice(from, from + BATCH);
    if (layers.markings && pen.scale >= MARKINGS) strokeMarkings(pen, lanes, some);
    else strokeBorders(pen, lanes, some);
    if (layers.arrows && pen.scale >= ARROWS) strokeArrows(pen, lanes, some);
    yield;
  }
}

/** Everything of a map that does not move. */
function* paintMap(map, layers, pen) {
  const {box, ctx} = pen, margin = 12 / pen.scale;
  const around = [box[0] - margin, box[1] - margin, box[2] + margin, box[3] + margin];
  ctx.lineJoin = "round";
  ctx.fillStyle = pen.ink("ground");
  ctx.fillRect(0, 0, TILE * pen.ratio + 1, TILE * pen.ratio + 1);
  if (layers.areas) yield* paintAreas(pen, map, around);
  if (layers.objects) yield* paintObjects(pen, map, around);
  if (layers.lanes) {
    const ids = inBox(map.grid, around), levels = new Set(ids.map((i) => map.lanes.level[i]));
    for (const level of [...levels].sort((a, b) => a - b)) {
      yield* paintLanes(pen, map, ids.filter((i) => map.lanes.level[i] === level), layers);
    }
  }
  yield* paintOverlays(pen, map, around);
  yield* paintThings(pen, map, around, layers);
}
