// The drive on its map: what stands still is drawn as on the page of a map, in tiles, and what moves on top.

const HOME_MARGIN = 52;  // pixels: room for flags and the boxes above the map
const STILL_LAYERS = {lanes: "Lanes", markings: "Markings", arrows: "Driving directions", areas: "Areas", objects: "Objects",
                      stopLines: "Stop lines", signals: "Signals"};

function makeMap(scene, clock) {
  const map = {scene, clock, ghost: null, follow: false, layers: Object.fromEntries(Object.keys(STILL_LAYERS).map((key) => [key, true]))};
  map.tiles = makeTiles((ctx, box, scale, ratio) => {
    const [x, y] = scene.shift, moved = [box[0] + x, box[1] + y, box[2] + x, box[3] + y];
    return paintMap(scene.map, map.layers, makePen(ctx, moved, scale, ratio, (name) => inkOf(map.stage, name)));
  });
  map.stage = makeStage(element("map"), scene.home, HOME_MARGIN, {
    draw: (stage, ctx, ratio) => draw(map, stage, ctx, ratio),
    fit: (view) => fitDrive(map, view),
    moved: () => (map.tiles.changed = performance.now()),
    panned: () => setFollow(map, false),
    hovered: (place) => showPlace(map, place),
    recoloured: () => repaint(map),
  });
  resizeStage(map.stage);
  watchButtons(map);
  listLayers(map);
  clock.listeners.push(() => redraw(map.stage));
  return map;
}

/** What stands still is drawn anew. */
function repaint(map) {
  dropTiles(map.tiles);
  redraw(map.stage);
}

function draw(map, stage, ctx, ratio) {
  const {scene} = map, {view} = stage;
  const pen = {ctx, view, scene, t: map.clock.t, ghost: map.ghost, stage, ink: (name) => inkOf(stage, name)};
  if (map.follow) [view.x, view.y] = centreOfVehicle(pen);
  drawTiles(stage, map.tiles, ctx, ratio);
  ctx.lineJoin = ctx.lineCap = "round";
  ctx.save();
  toMetres(ctx, view, ratio);
  for (const layer of LAYERS) if (layer.shown && !layer.pixels) layer.draw(pen);
  ctx.restore();
  for (const layer of LAYERS) if (layer.shown && layer.pixels) layer.draw(pen);
  drawScaleBar(stage, ctx);
}

/** Shows the whole drive, below the buttons; in a high frame also below the box that stands in its upper corner. */
function fitDrive({scene}, view) {
  const isHigh = view.height > 0.6 * view.width, above = Math.max(element("fit").offsetHeight, isHigh ? element("hud").offsetHeight : 0);
  const lower = {...view, height: view.height - above};
  fitBox(lower, scene.home, HOME_MARGIN);
  Object.assign(view, {x: lower.x, y: lower.y + above / 2 / lower.scale, scale: lower.scale});
}

function setFollow(map, follow) {
  const {stage} = map;
  map.follow = follow && map.scene.drive.t.length > 0;
  element("follow").setAttribute("aria-pressed", String(map.follow));
  if (map.follow) {
    stage.fitted = false;
    stage.view.scale = Math.max(stage.view.scale, 8);
  }
  redraw(stage);
}

function watchButtons(map) {
  const {stage} = map;
  const acts = {fit: () => goHome(stage), follow: () => setFollow(map, !map.follow), zoom_in: () => zoomStage(stage, 1.5),
                zoom_out: () => zoomStage(stage, 1 / 1.5)};
  for (const [id, act] of Object.entries(acts)) element(id).addEventListener("click", act);
}

function showPlace({scene}, place) {
  if (!place) return void (element("place").textContent = "");
  const [x0, y0] = scene.origin, [under] = lanesNear(scene.map, place.map((value, axis) => value + scene.shift[axis]), 0);
  const at = `x ${(x0 + place[0]).toFixed(2)}  y ${(y0 + place[1]).toFixed(2)} m`;
  element("place").textContent = under ? `${at} · lane ${shortened(scene.map.lanes.names[under.lane], 40)}` : at;
}

function addLayer(key, text, shown, change) {
  const label = document.createElement("label"), box = document.createElement("input"), mark = document.createElement("i");
  box.type = "checkbox";
  box.checked = shown;
  box.addEventListener("change", () => change(box.checked));
  mark.className = "swatch swatch-" + key;
  label.append(box, mark, text);
  element("layer_list").append(label);
}

/** Only what there is. */
function listLayers(map) {
  const {scene, layers} = map, {plans, obstacles, drive} = scene;
  const empty = {candidates: !plans.some((plan) => plan.grid), foreseen: !foresees(scene), hidden: !foresees(scene),
                 ahead: !obstacles.some(moves), obstacles: obstacles.length === 0, plan: plans.length === 0,
                 drive: drive.t.length === 0, footprints: drive.t.length === 0, vehicle: drive.t.length === 0};
  const isThere = (key) => (scene.map[key === "markings" || key === "arrows" ? "lanes" : key].count ?? scene.map[key].length) > 0;
  for (const [key, text] of Object.entries(STILL_LAYERS).filter(([one]) => isThere(one))) {
    addLayer(key, text, true, (shown) => {
      layers[key] = shown;
      repaint(map);
    });
  }
  for (const overlay of scene.map.overlays.filter((one) => one.lines.length + one.boxes.length > 0)) {
    addLayer(overlay.kind, overlay.name, true, (shown) => {
      overlay.shown = shown;
      repaint(map);
    });
  }
  for (const layer of LAYERS.filter((one) => one.label !== "" && !empty[one.key])) {
    addLayer(layer.key, layer.label, layer.shown, (shown) => {
      layer.shown = shown;
      redraw(map.stage);
    });
  }
}
