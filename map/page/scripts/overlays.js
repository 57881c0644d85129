// Routes, drives, occupied cells: drawn anew in each frame over the tiles, in metres.

const WIDTHS = {route: [2, 5], drive: [0.4, 2.5], reference: [0.2, 1.5], before: [0.15, 1.5]};  // metres, pixels

function pathOfPieces(map, pieces) {
  const path = new Path2D();
  for (const {lane, from, to} of pieces) {
    const points = pieceOfLane(map.lanes, lane, from, to);
    points.forEach(([x, y], n) => (n === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  }
  return path;
}

/** Points of a lane's centreline between two stations. */
function pieceOfLane(lanes, lane, from, to) {
  const stations = stationsOfLine(lanes, lane, CENTRE), line = pointsAt(lanes.lines, 3 * lane + CENTRE);
  return [pointOnLane(lanes, lane, from), ...line.filter((_, n) => stations[n] > from && stations[n] < to),
          pointOnLane(lanes, lane, to)];
}

function pathOfOverlay(map, overlay) {
  const path = pathOfPieces(map, overlay.pieces ?? []);
  for (const line of overlay.lines) line.forEach(([x, y], n) => (n === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  return path;
}

function areaOfOverlay(overlay) {
  const area = new Path2D();
  for (const ring of overlay.rings) {
    ring.forEach(([x, y], n) => (n === 0 ? area.moveTo(x, y) : area.lineTo(x, y)));
    area.closePath();
  }
  for (const [[x0, y0], [x1, y1]] of overlay.boxes) area.rect(x0, y0, x1 - x0, y1 - y0);
  return area;
}

/** Sets the context to metres of the map. */
function toMetres(ctx, view, ratio) {
  const k = ratio * view.scale, [x, y] = toScreen(view, [0, 0]);
  ctx.setTransform(k, 0, 0, -k, ratio * x, ratio * y);
}

function drawOverlays(map, ctx, view, ink) {
  for (const overlay of map.overlays) {
    if (!overlay.shown) continue;
    overlay.path ??= pathOfOverlay(map, overlay);
    overlay.area ??= areaOfOverlay(overlay);
    const colour = ink("over-" + overlay.kind), [metres, pixels] = WIDTHS[overlay.kind] ?? [0.2, 2];
    ctx.globalAlpha = overlay.kind === "route" ? 0.75 : 1;
    ctx.fillStyle = colour;
    ctx.fill(overlay.area);
    ctx.strokeStyle = colour;
    ctx.lineWidth = Math.max(metres, pixels / view.scale);
    ctx.setLineDash(overlay.isAlternative ? [6 / view.scale, 4 / view.scale] : []);
    ctx.stroke(overlay.path);
    ctx.setLineDash([]);
    ctx.globalAlpha = 1;
  }
}
