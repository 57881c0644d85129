// The canvas: draws the layers when something has changed, and moves with the mouse.

const HOME_MARGIN = 52;  // pixels: room for flags and the boxes above the map

function element(id) {
  return document.getElementById(id);
}

function makeMap(scene, clock) {
  const canvas = element("map");
  const map = {canvas, ctx: canvas.getContext("2d"), view: makeView(), scene, clock, ghost: null,
               follow: false, fitted: true, waiting: false, inks: new Map()};
  watchSize(map);
  watchPointer(map);
  watchButtons(map);
  listLayers(map);
  clock.listeners.push(() => redraw(map));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    map.inks.clear();
    redraw(map);
  });
  return map;
}

function inkOf(map, name) {
  if (!map.inks.has(name)) {
    const style = getComputedStyle(document.documentElement);
    map.inks.set(name, style.getPropertyValue("--" + name).trim());
  }
  return map.inks.get(name);
}

/** Draws soon, and only once however often it is asked before. */
function redraw(map) {
  if (map.waiting) return;
  map.waiting = true;
  requestAnimationFrame(() => {
    map.waiting = false;
    draw(map);
  });
}

function draw(map) {
  const {ctx, view, scene} = map, ratio = window.devicePixelRatio || 1;
  const pen = {ctx, view, scene, t: map.clock.t, ghost: map.ghost, ink: (name) => inkOf(map, name)};
  if (map.follow && scene.drive.t.length > 0) [view.x, view.y] = centreOfVehicle(pen);
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.fillStyle = pen.ink("ground");
  ctx.fillRect(0, 0, view.width, view.height);
  ctx.lineJoin = ctx.lineCap = "round";
  const k = ratio * view.scale, [x0, y0] = toScreen(view, [0, 0]);
  ctx.setTransform(k, 0, 0, -k, ratio * x0, ratio * y0);
  for (const layer of LAYERS) if (layer.shown && !layer.pixels) layer.draw(pen);
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  for (const layer of LAYERS) if (layer.shown && layer.pixels) layer.draw(pen);
}

/** Shows the whole drive; in a high frame, below the box that stands in its upper corner. */
function fitDrive({view, scene}) {
  const above = view.height > 0.6 * view.width ? element("hud").offsetHeight : 0;
  const lower = {...view, height: view.height - above};
  fitBox(lower, scene.home, HOME_MARGIN);
  Object.assign(view, {x: lower.x, y: lower.y + above / 2 / lower.scale, scale: lower.scale});
}

function fitHome(map) {
  setFollow(map, false);
  fitDrive(map);
  map.fitted = true;
  redraw(map);
}

function resize(map) {
  const ratio = window.devicePixelRatio || 1, {clientWidth, clientHeight} = map.canvas;
  map.canvas.width = Math.round(clientWidth * ratio);
  map.canvas.height = Math.round(clientHeight * ratio);
  map.view.width = Math.max(1, clientWidth);
  map.view.height = Math.max(1, clientHeight);
  if (map.fitted) fitDrive(map);
  draw(map);
}

function watchSize(map) {
  new ResizeObserver(() => resize(map)).observe(map.canvas);
}

function setFollow(map, follow) {
  map.follow = follow && map.scene.drive.t.length > 0;
  element("follow").setAttribute("aria-pressed", String(map.follow));
  if (map.follow) {
    map.fitted = false;
    map.view.scale = Math.max(map.view.scale, 8);
  }
  redraw(map);
}

function zoom(map, factor, pixel = [map.view.width / 2, map.view.height / 2]) {
  zoomAt(map.view, pixel, factor);
  map.fitted = false;
  redraw(map);
}

function drag(map, event) {
  if (map.follow) setFollow(map, false);
  panBy(map.view, event.movementX, event.movementY);
  map.fitted = false;
  redraw(map);
}

function watchPointer(map) {
  const {canvas} = map;
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons & 1) drag(map, event);
    showPlace(map, [event.offsetX, event.offsetY]);
  });
  canvas.addEventListener("pointerleave", () => (element("place").textContent = ""));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(map, Math.exp(-0.0015 * event.deltaY), [event.offsetX, event.offsetY]);
  }, {passive: false});
}

function watchButtons(map) {
  element("fit").addEventListener("click", () => fitHome(map));
  element("follow").addEventListener("click", () => setFollow(map, !map.follow));
  element("zoom_in").addEventListener("click", () => zoom(map, 1.5));
  element("zoom_out").addEventListener("click", () => zoom(map, 1 / 1.5));
}

function laneAt(map, [x, y]) {
  map.ctx.setTransform(1, 0, 0, 1, 0, 0);
  return map.scene.lanes.find((lane) => map.ctx.isPointInPath(lane.area, x, y)) ?? null;
}

function showPlace(map, pixel) {
  const place = toWorld(map.view, pixel), lane = laneAt(map, place), [x0, y0] = map.scene.origin;
  const at = `x ${(x0 + place[0]).toFixed(2)}  y ${(y0 + place[1]).toFixed(2)} m`;
  element("place").textContent = lane ? `${at} · lane ${shortened(lane.name, 40)}` : at;
}

function listLayers(map) {
  for (const layer of LAYERS.filter((one) => one.label !== "")) {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = layer.shown;
    box.addEventListener("change", () => {
      layer.shown = box.checked;
      redraw(map);
    });
    label.append(box, swatch(layer.key), layer.label);
    element("layer_list").append(label);
  }
}

function swatch(key) {
  const mark = document.createElement("i");
  mark.className = "swatch swatch-" + key;
  return mark;
}
