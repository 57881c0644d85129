// A canvas that shows part of the plane and moves with mouse, fingers and keys. Who uses it draws.

const CLICK_PX = 5;     // less movement than this is a click
const NUDGE_PX = 80;    // of an arrow key

function element(id) {
  return document.getElementById(id);
}

/**
 * @param home  the box that is shown at first
 * @param hooks draw(stage, ctx, ratio); optional moved(), panned(), clicked(place, pixel), hovered(place, pixel),
 *              recoloured(), and fit(view), which shows what is home in another way
 */
function makeStage(canvas, home, margin, hooks) {
  const stage = {canvas, ctx: canvas.getContext("2d", {alpha: false}), view: makeView(), home, margin, hooks, fitted: true,
                 waiting: false, inks: new Map(), fingers: new Map(), dragged: false};
  new ResizeObserver(() => resizeStage(stage)).observe(canvas);
  watchFingers(stage);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    stage.inks.clear();
    hooks.recoloured?.();
    redraw(stage);
  });
  return stage;
}

/** A colour of the style sheet by its name. */
function inkOf(stage, name) {
  if (!stage.inks.has(name)) {
    stage.inks.set(name, getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim() || "#888");
  }
  return stage.inks.get(name);
}

/** Draws soon, and only once however often it is asked before. */
function redraw(stage) {
  if (stage.waiting) return;
  stage.waiting = true;
  requestAnimationFrame(() => {
    stage.waiting = false;
    drawStage(stage);
  });
}

function drawStage(stage) {
  const ratio = window.devicePixelRatio || 1, {ctx, view} = stage;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.fillStyle = inkOf(stage, "ground");
  ctx.fillRect(0, 0, view.width, view.height);
  stage.hooks.draw(stage, ctx, ratio);
}

function fitHome(stage, view) {
  if (stage.hooks.fit) stage.hooks.fit(view);
  else fitBox(view, stage.home, stage.margin);
}

function homeView(stage) {
  const view = {...stage.view};
  fitHome(stage, view);
  return view;
}

function goHome(stage) {
  fitHome(stage, stage.view);
  stage.fitted = true;
  stage.hooks.panned?.();
  viewMoved(stage);
}

function viewMoved(stage) {
  stage.hooks.moved?.();
  redraw(stage);
}

function resizeStage(stage) {
  if (matchMedia("print").matches) return;  // printed as it was drawn for the screen
  const ratio = window.devicePixelRatio || 1, {clientWidth, clientHeight} = stage.canvas;
  stage.canvas.width = Math.round(clientWidth * ratio);
  stage.canvas.height = Math.round(clientHeight * ratio);
  stage.view.width = Math.max(1, clientWidth);
  stage.view.height = Math.max(1, clientHeight);
  if (stage.fitted) fitHome(stage, stage.view);
  drawStage(stage);
}

function zoomStage(stage, factor, pixel = [stage.view.width / 2, stage.view.height / 2]) {
  zoomAt(stage.view, pixel, factor);
  stage.fitted = false;
  viewMoved(stage);
}

function panStage(stage, dx, dy) {
  panBy(stage.view, dx, dy);
  stage.fitted = false;
  stage.hooks.panned?.();
  viewMoved(stage);
}

/** Two fingers keep the places under them. */
function pinch(stage, event) {
  const [a, b] = [...stage.fingers.values()], before = Math.hypot(a[0] - b[0], a[1] - b[1]);
  const middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  stage.fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
  const [c, d] = [...stage.fingers.values()], after = Math.hypot(c[0] - d[0], c[1] - d[1]);
  panBy(stage.view, (c[0] + d[0]) / 2 - middle[0], (c[1] + d[1]) / 2 - middle[1]);
  zoomStage(stage, after / Math.max(before, 1), [(c[0] + d[0]) / 2, (c[1] + d[1]) / 2]);
}

function watchFingers(stage) {
  const {canvas, fingers, hooks} = stage;
  canvas.addEventListener("pointerdown", (event) => {
    if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    stage.dragged = fingers.size > 1;
    stage.from = [event.offsetX, event.offsetY];
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId), now = [event.offsetX, event.offsetY];
    if (fingers.size === 2 && last) return pinch(stage, event);
    if (last) {
      stage.dragged ||= Math.hypot(now[0] - stage.from[0], now[1] - stage.from[1]) > CLICK_PX;
      if (!stage.dragged) return;
      panStage(stage, now[0] - last[0], now[1] - last[1]);
      fingers.set(event.pointerId, now);
      return;
    }
    hooks.hovered?.(toWorld(stage.view, now), now);
  });
  const lift = (event) => {
    const down = fingers.delete(event.pointerId);
    if (down && event.type === "pointerup" && !stage.dragged) {
      hooks.clicked?.(toWorld(stage.view, [event.offsetX, event.offsetY]), [event.offsetX, event.offsetY]);
    }
  };
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, lift);
  canvas.addEventListener("pointerleave", () => hooks.hovered?.(null, null));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoomStage(stage, Math.exp(-0.0015 * event.deltaY), [event.offsetX, event.offsetY]);
  }, {passive: false});
}

/** Does what a key asks of the view; false if it is none of these keys. */
function keyOfStage(stage, key) {
  const moves = {ArrowLeft: [NUDGE_PX, 0], ArrowRight: [-NUDGE_PX, 0], ArrowUp: [0, NUDGE_PX], ArrowDown: [0, -NUDGE_PX]};
  if (moves[key]) panStage(stage, ...moves[key]);
  else if (key === "+" || key === "=") zoomStage(stage, 1.5);
  else if (key === "-" || key === "−") zoomStage(stage, 1 / 1.5);
  else if (key === "0") goHome(stage);
  else return false;
  return true;
}

/** Shows what is drawn in tiles, and draws some that are missing, for a few milliseconds. Returns whether there are more. */
function drawTiles(stage, tiles, ctx, ratio) {
  const home = homeView(stage), waits = choosePass(tiles, stage.view, home, ratio, performance.now());
  const missing = waits || drawSomeTiles(tiles, stage.view, home);
  forgetFarTiles(tiles, stage.view);
  showTiles(tiles, ctx, stage.view);
  if (missing) redraw(stage);
  return missing;
}

/** Sets the context to metres. */
function toMetres(ctx, view, ratio) {
  const k = ratio * view.scale, [x, y] = toScreen(view, [0, 0]);
  ctx.setTransform(k, 0, 0, -k, ratio * x, ratio * y);
}

/** Text with a halo, in pixels. */
function drawLabel(stage, ctx, text, [x, y], colour = inkOf(stage, "text")) {
  ctx.font = "12px system-ui, sans-serif";
  ctx.lineJoin = "round";
  ctx.lineWidth = 3;
  ctx.setLineDash([]);
  ctx.strokeStyle = inkOf(stage, "halo");
  ctx.strokeText(text, x, y);
  ctx.fillStyle = colour;
  ctx.fillText(text, x, y);
}

function drawScaleBar(stage, ctx) {
  const {view} = stage, length = scaleBarLength(view, 140), width = length * view.scale;
  const x = view.width - 16 - width, y = view.height - 16;
  ctx.strokeStyle = inkOf(stage, "text");
  ctx.setLineDash([]);
  ctx.lineWidth = 1.5;
  ctx.beginPath();
  for (const [px, py] of [[x, y - 5], [x, y], [x + width, y], [x + width, y - 5]]) ctx.lineTo(px, py);
  ctx.stroke();
  drawLabel(stage, ctx, length >= 1000 ? `${length / 1000} km` : `${length} m`, [x + 4, y - 6]);
}
