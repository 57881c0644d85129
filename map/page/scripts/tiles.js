// What does not move is drawn once, in square tiles, a few milliseconds a frame; while it is, what
// was drawn before is shown at another size. So moving costs the same on a map of any size.

const TILE = 256;          // pixels of the page
const BUDGET_MS = 4;       // for new tiles in one frame
const REST_MS = 120;       // without a change of scale, until tiles of the new scale are drawn
const MOST_TILES = 300;    // kept of one scale

/** @param paint a generator (ctx, box, scale, ratio) that draws the box and yields now and then */
function makeTiles(paint) {
  return {paint, current: null, previous: null, home: null, job: null, changed: 0};
}

function makeSheet(scale, ratio) {
  return {scale, ratio, tiles: new Map()};
}

/** Forgets everything, as when a layer is switched. */
function dropTiles(tiles) {
  tiles.current = tiles.previous = tiles.home = tiles.job = null;
}

/** Keys of the tiles that a view shows, nearest to its middle first. */
function tilesInView(view, scale) {
  const size = TILE / scale, wide = view.width / view.scale / 2, high = view.height / view.scale / 2, keys = [];
  for (let j = Math.floor((view.y - high) / size); j <= Math.floor((view.y + high) / size); ++j) {
    for (let i = Math.floor((view.x - wide) / size); i <= Math.floor((view.x + wide) / size); ++i) {
      keys.push([i, j, Math.hypot((i + 0.5) * size - view.x, (j + 0.5) * size - view.y)]);
    }
  }
  return keys.sort((a, b) => a[2] - b[2]).map(([i, j]) => [i, j]);
}

function nameOfTile([i, j]) {
  return i + "," + j;
}

function boxOfTile([i, j], scale) {
  const size = TILE / scale;
  return [i * size, j * size, (i + 1) * size, (j + 1) * size];
}

function blankCanvas(pixels) {
  if (typeof OffscreenCanvas === "function") return new OffscreenCanvas(pixels, pixels);
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = pixels;
  return canvas;
}

function startTile(tiles, sheet, key) {
  const canvas = blankCanvas(Math.ceil(TILE * sheet.ratio)), ctx = canvas.getContext("2d");
  const steps = tiles.paint(ctx, boxOfTile(key, sheet.scale), sheet.scale, canvas.width / TILE);
  tiles.job = {sheet, key, canvas, steps};
}

/** The finished picture; as a bitmap, so that drawing it later does not draw it anew. */
function finishTile(tiles) {
  const {sheet, key, canvas} = tiles.job;
  sheet.tiles.set(nameOfTile(key), canvas.transferToImageBitmap ? canvas.transferToImageBitmap() : canvas);
  tiles.job = null;
}

/** The next tile to draw: of the view; then, once, of the whole map. */
function nextTile(tiles, view, homeView) {
  const {current, home} = tiles;
  const missing = (sheet, shown) => tilesInView(shown, sheet.scale).find((key) => !sheet.tiles.has(nameOfTile(key)));
  const key = missing(current, view);
  if (key) return [current, key];
  const far = home && missing(home, homeView);
  return far ? [home, far] : null;
}

/** Draws tiles until the time is up. Returns whether some are missing still. */
function drawSomeTiles(tiles, view, homeView, now = () => performance.now()) {
  const end = now() + BUDGET_MS;
  while (now() < end) {
    if (!tiles.job) {
      const next = nextTile(tiles, view, homeView);
      if (!next) return false;
      startTile(tiles, ...next);
    }
    if (tiles.job.steps.next().done) finishTile(tiles);
  }
  return true;
}

/** Chooses the scale that tiles are drawn at: the view's, as soon as it rests. */
function choosePass(tiles, view, homeView, ratio, now) {
  if (!tiles.home) tiles.home = makeSheet(homeView.scale, ratio);
  if (!tiles.current) tiles.current = tiles.home.scale === view.scale ? tiles.home : makeSheet(view.scale, ratio);
  const {current} = tiles;
  if (current.scale === view.scale && current.ratio === ratio) return false;
  if (now - tiles.changed < REST_MS) return true;  // not yet
  if (current !== tiles.home && current.tiles.size > 0) tiles.previous = current;
  tiles.current = tiles.home.scale === view.scale ? tiles.home : makeSheet(view.scale, ratio);
  tiles.job = null;
  return false;
}

function forgetFarTiles(tiles, view) {
  const {current} = tiles;
  if (current === tiles.home || current.tiles.size <= MOST_TILES || !isShown(current, view)) return;
  const kept = new Set(tilesInView(view, current.scale).map(nameOfTile));
  for (const name of current.tiles.keys()) if (!kept.has(name)) current.tiles.delete(name);
}

/** Of another scale, pixels are repeated: that is fast, and soon over. */
function showSheet(ctx, sheet, view) {
  ctx.imageSmoothingEnabled = sheet.scale === view.scale;
  for (const key of tilesInView(view, sheet.scale)) {
    const picture = sheet.tiles.get(nameOfTile(key));
    if (!picture) continue;
    const [x0, y0, x1, y1] = boxOfTile(key, sheet.scale);
    const [left, top] = toScreen(view, [x0, y1]), [right, bottom] = toScreen(view, [x1, y0]);
    // Whole pixels of the page, so that tiles have no seams.
    const snap = (pixel) => Math.round(pixel * sheet.ratio) / sheet.ratio;
    ctx.drawImage(picture, snap(left), snap(top), snap(right) - snap(left), snap(bottom) - snap(top));
  }
}

function hasAll(sheet, view) {
  return tilesInView(view, sheet.scale).every((key) => sheet.tiles.has(nameOfTile(key)));
}

/** A sheet so much finer than the view that it would take hundreds of pictures is not shown. */
function isShown(sheet, view) {
  return sheet && sheet.tiles.size > 0 && sheet.scale < 6 * view.scale;
}

/** Shows what there is, the finest on top. */
function showTiles(tiles, ctx, view) {
  const {current, previous, home} = tiles, whole = current && isShown(current, view) && hasAll(current, view);
  const before = !whole && isShown(previous, view), wholeBefore = before && hasAll(previous, view);
  if (!whole && !wholeBefore && isShown(home, view)) showSheet(ctx, home, view);
  if (before) showSheet(ctx, previous, view);
  if (current && isShown(current, view)) showSheet(ctx, current, view);
}
