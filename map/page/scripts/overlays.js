// Routes, drives, occupied cells: painted into the tiles, over the lanes and under the signs.

const WIDTHS = {route: [2, 5], drive: [0.4, 2.5], reference: [0.2, 1.5], before: [0.15, 1.5], reach: [2, 3]};  // metres, pixels

/** Points of a lane's centreline between two stations. */
function pieceOfLane(lanes, {lane, from, to}) {
  const stations = stationsOfLine(lanes, lane, CENTRE), line = pointsAt(lanes.lines, 3 * lane + CENTRE);
  return [pointOnLane(lanes, lane, from), ...line.filter((_, n) => stations[n] > from && stations[n] < to),
          pointOnLane(lanes, lane, to)];
}

/** Shapes with a grid over them, to find those that a tile shows. */
function withGrid(shapes) {
  const boxes = new Float64Array(4 * shapes.length);
  shapes.forEach((points, i) => boxes.set(boxOf(points) ?? [Infinity, Infinity, -Infinity, -Infinity], 4 * i));
  return {shapes, grid: makeGrid(boxes, shapes.length)};
}

/** The lines and areas of an overlay, made when they are first asked for. */
function shapesOf(map, overlay) {
  const corners = ([[x0, y0], [x1, y1]]) => [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
  overlay.made ??= {
    strokes: withGrid([...overlay.pieces.map((piece) => pieceOfLane(map.lanes, piece)), ...overlay.lines]),
    areas: withGrid([...overlay.rings, ...overlay.boxes.map(corners)]),
  };
  return overlay.made;
}

/** The box of everything that is drawn of an overlay; null if that is nothing. */
function boxOfOverlay(map, overlay) {
  const {strokes, areas} = shapesOf(map, overlay);
  return boxOf([...strokes.shapes, ...areas.shapes].flat());
}

/** Puts shapes into the path, as many as may be drawn at once, and lets them be drawn. */
function* batchesOf(pen, {shapes, grid}, box, close) {
  const found = inBox(grid, box);
  for (let from = 0; from < found.length; from += 4 * BATCH) {
    pen.ctx.beginPath();
    for (const i of found.slice(from, from + 4 * BATCH)) addPoints(pen, pen.ctx, shapes[i], close);
    yield;
  }
}

function* paintOverlays(pen, map, box) {
  const {ctx} = pen;
  for (const overlay of map.overlays.filter(({shown}) => shown)) {
    const {strokes, areas} = shapesOf(map, overlay), [metres, pixels] = WIDTHS[overlay.kind] ?? [0.2, 2];
    ctx.fillStyle = ctx.strokeStyle = pen.ink("over-" + overlay.kind);
    ctx.lineWidth = pen.ratio;
    for (const _ of batchesOf(pen, areas, box, true)) {
      ctx.fill();
      if (overlay.kind === "occupied") ctx.stroke();  // cells smaller than a pixel are seen, too
      yield;
    }
    ctx.globalAlpha = overlay.kind === "route" ? 0.75 : 1;
    ctx.lineWidth = Math.max(metres * pen.k, pixels * pen.ratio);
    ctx.setLineDash(overlay.isAlternative ? [6 * pen.ratio, 4 * pen.ratio] : []);
    for (const _ of batchesOf(pen, strokes, box, false)) {
      ctx.stroke();
      yield;
    }
    ctx.setLineDash([]);
    ctx.globalAlpha = 1;
  }
}
