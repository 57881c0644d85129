// What stands beside lanes: areas, objects, stop lines, signals, findings.

function boxOfThing(thing) {
  return boxOf(thing.points && thing.points.length > 0 ? thing.points : thing.at ? [thing.at] : (thing.rings ?? []).flat());
}

/** A grid over things with places; of those without one, nothing is found. */
function gridOfThings(things) {
  const boxes = new Float64Array(4 * things.length);
  things.forEach((thing, i) => boxes.set(boxOfThing(thing) ?? [Infinity, Infinity, -Infinity, -Infinity], 4 * i));
  const placed = things.every((thing) => boxOfThing(thing));
  if (placed) return makeGrid(boxes, things.length);
  const kept = things.map((_, i) => i).filter((i) => boxOfThing(things[i]));
  const dense = new Float64Array(4 * kept.length);
  kept.forEach((i, k) => dense.set(boxes.subarray(4 * i, 4 * i + 4), 4 * k));
  return {...makeGrid(dense, kept.length), kept};
}

/** Numbers of the things of a kind whose boxes meet a box. */
function thingsIn(map, kind, box) {
  map.grids ??= {};
  map.grids[kind] ??= gridOfThings(map[kind]);
  const grid = map.grids[kind], found = inBox(grid, box);
  return grid.kept ? found.map((k) => grid.kept[k]) : found;
}

function* paintAreas(pen, map, box) {
  for (const i of thingsIn(map, "areas", box)) {
    fillPoints(pen, map.areas[i].rings, pen.ink(map.areas[i].isRoad ? "lane-drive" : "area"));
    yield;
  }
}

const PAINTED = new Set(["crosswalk", "parkingSpace", "roadMark"]);  // on the road, not beside it

function* paintObjects(pen, map, box) {
  const rings = thingsIn(map, "objects", box).map((i) => map.objects[i])
      .filter((one) => one.points.length > 2 && !PAINTED.has(one.type)).map((one) => one.points);
  for (let from = 0; from < rings.length; from += BATCH) {
    for (const ring of rings.slice(from, from + BATCH)) fillPoints(pen, [ring], pen.ink("object"));
    yield;
  }
}

function paintPainted(pen, map, box) {
  const {ctx} = pen;
  ctx.lineWidth = pen.ratio;
  ctx.strokeStyle = pen.ink("mark-white");
  for (const i of thingsIn(map, "objects", box)) {
    const {points, type} = map.objects[i];
    if (points.length < 3 || !PAINTED.has(type)) continue;
    ctx.globalAlpha = 0.25;
    fillPoints(pen, [points], pen.ink("mark-white"));
    ctx.globalAlpha = 1;
    ctx.beginPath();
    addPoints(pen, ctx, points, true);
    ctx.stroke();
  }
}

function paintStopLines(pen, map, box) {
  const {ctx} = pen;
  ctx.beginPath();
  for (const i of thingsIn(map, "stopLines", box)) addPoints(pen, ctx, map.stopLines[i].points, false);
  ctx.strokeStyle = pen.ink("stop");
  ctx.lineWidth = Math.max(0.4 * pen.k, 1.5 * pen.ratio);
  ctx.stroke();
}

function dot(pen, [x, y], radius, fill, square) {
  const {ctx} = pen, size = radius * pen.ratio;
  ctx.beginPath();
  if (square) ctx.rect(px(pen, x) - size, py(pen, y) - size, 2 * size, 2 * size);
  else ctx.arc(px(pen, x), py(pen, y), size, 0, 2 * Math.PI);
  ctx.fillStyle = fill;
  ctx.fill();
  if (radius < 2) return;
  ctx.strokeStyle = pen.ink("halo");
  ctx.lineWidth = pen.ratio;
  ctx.stroke();
}

/** Signs are round, what changes is square. */
function paintSignals(pen, map, box) {
  const radius = Math.min(5, 2 + pen.scale);
  for (const i of thingsIn(map, "signals", box)) {
    const signal = map.signals[i];
    dot(pen, signal.at, radius, pen.ink(signal.dynamic ? "light" : "sign"), signal.dynamic);
  }
}

function paintPoints(pen, map, box) {
  for (const i of thingsIn(map, "objects", box)) {
    if (map.objects[i].points.length < 3) dot(pen, map.objects[i].at, 2, pen.ink("object"), false);
  }
}

/** The gravest on top; far away small, and mere notes only from near. */
function paintRemarks(pen, map, box) {
  const far = pen.scale < ICONS, found = thingsIn(map, "remarks", box).map((i) => map.remarks[i]);
  for (const severity of [...SEVERITIES].reverse()) {
    if (severity === "info" && pen.scale < MARKINGS) continue;
    for (const one of found) {
      const shown = one.severity === severity && !map.hiddenRules.has(one.rule);
      if (shown) dot(pen, one.at, far ? 1.8 : Math.min(4, 2 + pen.scale / 2), pen.ink(severity), severity !== "error");
    }
  }
}

const SEVERITIES = ["error", "removed", "warning", "changed", "added", "info"];  // from the gravest

function* paintThings(pen, map, box, layers) {
  if (layers.objects && pen.scale >= ICONS) paintPainted(pen, map, box);
  yield;
  if (layers.stopLines && pen.scale >= ICONS) paintStopLines(pen, map, box);
  if (layers.objects && pen.scale >= 2) paintPoints(pen, map, box);
  yield;
  if (layers.signals && pen.scale >= ICONS) paintSignals(pen, map, box);
  yield;
  if (layers.remarks) paintRemarks(pen, map, box);
}
