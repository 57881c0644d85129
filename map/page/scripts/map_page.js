// Starts the page: one map, one stage, and what is selected.

const LAYERS = {lanes: "Lanes", markings: "Markings", arrows: "Driving directions", areas: "Areas", objects: "Objects",
                stopLines: "Stop lines", signals: "Signals", remarks: "Findings", names: "Names"};

/** Everything that is drawn into tiles is drawn anew. */
function repaint(page) {
  dropTiles(page.tiles);
  redraw(page.stage);
}

function setColours(page, key) {
  page.map.colouring = classify(page.map, key);
  element("colours").value = key;
  showLegend(page);
  repaint(page);
}

function showLegend(page) {
  const {keys, names, counts} = page.map.colouring, list = element("legend");
  list.replaceChildren();
  keys.forEach((key, k) => {
    if (counts[k] === 0) return;
    const item = addText(list, "li", "", names[key]);
    item.style.setProperty("--swatch", `var(--lane-${key})`);
  });
}

function showLayer(page, key, shown) {
  page.layers[key] = shown;
  element("layer_" + key).checked = shown;
  repaint(page);
}

function addCheck(list, id, text, checked, change) {
  const label = addText(list, "label", "", ""), box = document.createElement("input");
  box.type = "checkbox";
  box.id = id;
  box.checked = checked;
  box.addEventListener("change", () => change(box.checked));
  label.append(box, text);
  return label;
}

function listLayers(page) {
  const list = element("layers");
  for (const [key, text] of Object.entries(LAYERS)) {
    addCheck(list, "layer_" + key, key === "remarks" ? page.map.remarksTitle : text, true, (shown) => {
      showLayer(page, key, shown);
      noteLink(page);
    });
  }
  page.map.overlays.forEach((overlay, n) => {
    const label = addCheck(list, "overlay_" + n, "", true, (shown) => {
      overlay.shown = shown;
      repaint(page);
    });
    addText(label, "i", "swatch", "").style.background = `var(--over-${overlay.kind})`;
    addText(label, "span", "", overlay.name);
    if (overlay.text) addText(label, "span", "note", overlay.text);
    addButton(label, "Show", "small", () => visit(page, {kind: "overlays", index: n})).setAttribute("aria-label", `Show ${overlay.name}`);
  });
}

/** Selects a thing. */
function select(page, selection) {
  page.selection = selection;
  if (page.mode === "select") say(page, "");
  showSelection(page);
  noteLink(page);
  redraw(page.stage);
}

/** What to show of a thing: its lanes, or all of an overlay; null if it is but a place. */
function boxToVisit(map, target) {
  if (target.kind === "overlays") return boxOfOverlay(map, map.overlays[target.index]);
  const {boxes} = map.lanes;
  return boxOf(lanesOf(map, target).slice(0, 500).flatMap((i) => [boxes.subarray(4 * i, 4 * i + 2), boxes.subarray(4 * i + 2, 4 * i + 4)]));
}

/** Selects a thing and shows it. */
function visit(page, target) {
  const {map, stage} = page, {view} = stage, place = placeOf(map, target), box = boxToVisit(map, target);
  if (box) fitBox(view, box, (target.kind === "overlays" ? 0.06 : 0.25) * Math.min(view.width, view.height));
  else if (place) [view.x, view.y, view.scale] = [...place, Math.max(view.scale, 6)];
  view.scale = Math.min(view.scale, 20);
  stage.fitted &&= !(box || place);
  select(page, target.kind === "lane" && place ? {...target, place} : target);
  if (!box && !place) say(page, `${nameOf(map, target)} has no place`);
}

/** Selects the lane at a place, and shows it. */
function visitPlace(page, place) {
  const {view} = page.stage;
  [view.x, view.y, view.scale] = [...place, Math.max(view.scale, 6)];
  page.stage.fitted = false;
  selectPlace(page, place);
}

/** Selects the lane that `roadbed locate` names first. */
function selectPlace(page, place) {
  const at = locate(page.map, place);
  if (!at) return say(page, "no lane is within 50 km");
  select(page, {kind: "lane", index: at.lane, place, distance: at.distance});
}

/** The icon under a pixel; null if there is none, or icons are not drawn. */
function iconAt(page, [x, y]) {
  const {map, stage, layers} = page, reach = 7 / stage.view.scale, box = [x - reach, y - reach, x + reach, y + reach];
  if (stage.view.scale < MARKINGS) return null;
  const near = (kind, things) => thingsIn(map, things, box)
      .filter((index) => map[things][index].at && Math.hypot(map[things][index].at[0] - x, map[things][index].at[1] - y) < reach)
      .map((index) => ({kind, index}));
  const points = () => near("objects", "objects").filter(({index}) => map.objects[index].points.length < 3);
  const found = [...(layers.remarks ? near("remark", "remarks").filter(({index}) => !map.hiddenRules.has(map.remarks[index].rule)) : []),
                 ...(layers.signals ? near("signals", "signals") : []), ...(layers.objects ? points() : [])];
  return found[0] ?? null;
}

/** A second click at a place selects what else is there; false if there is nothing, or it is the first. */
function nextAt(page, place) {
  const {selection, stage} = page, first = selection?.place;
  if (!first || stage.view.scale * Math.hypot(place[0] - first[0], place[1] - first[1]) > CLICK_PX) return false;
  const all = thingsAt(page, first), now = all.findIndex((one) => isSame(one, selection));
  if (all.length < 2) return false;
  select(page, all[(now + 1) % all.length]);
  return true;
}

function clicked(page, place) {
  // To the millimetre that is shown, so that `locate --at` with these numbers names the same lane.
  const rounded = fromRaw(page.map, rawOf(page.map, place).map((value) => Number(value.toFixed(3))));
  if (page.mode === "measure") return measureTo(page, rounded);
  if (page.mode === "route") return routeTo(page, rounded);
  const icon = iconAt(page, place);
  if (icon) return select(page, icon);
  if (nextAt(page, place)) return;
  selectPlace(page, rounded);
}

/** The lane under the pointer, and the place; looked up once a frame at most. */
function hovered(page, place) {
  page.hover = place;
  if (page.hovering) return;
  page.hovering = true;
  requestAnimationFrame(() => {
    page.hovering = false;
    showHover(page);
  });
}

function showHover(page) {
  const {map, hover} = page, output = element("place");
  if (!hover) return void (output.textContent = "");
  const [under] = lanesNear(map, hover, 0), geographic = lonLatText(map, hover);
  const lane = under ? ` · lane ${map.lanes.names[under.lane]} · s ${under.s.toFixed(1)} m, d ${under.d.toFixed(2)} m` : "";
  const icon = iconAt(page, hover), thing = icon ? ` · ${nameOf(map, icon)}` : "";
  output.textContent = `x, y ${coordinatesText(map, hover)}${geographic ? ` · lat, lon ${geographic}` : ""}${lane}${thing}`;
  const index = under?.lane ?? -1;
  if (index !== page.hoveredLane) {
    page.hoveredLane = index;
    redraw(page.stage);
  }
}

function pathOfLanes(map, indices) {
  const path = new Path2D();
  for (const i of indices) {
    const ring = ringOf(map.lanes, i);
    for (let k = 0; k < ring.length; k += 2) (k === 0 ? path.moveTo(ring[k], ring[k + 1]) : path.lineTo(ring[k], ring[k + 1]));
    path.closePath();
  }
  return path;
}

function drawSelected(page, ctx) {
  const {map, stage, selection, hoveredLane} = page, px = 1 / stage.view.scale;
  if (hoveredLane >= 0) {
    ctx.strokeStyle = inkOf(stage, "accent");
    ctx.lineWidth = px;
    ctx.stroke(pathOfLanes(map, [hoveredLane]));
  }
  if (!selection) return;
  page.selectedPath ??= {};
  if (page.selectedPath.of !== selection) page.selectedPath = {of: selection, path: pathOfLanes(map, lanesOf(map, selection).slice(0, 2000))};
  ctx.fillStyle = inkOf(stage, "selected-fill");
  ctx.fill(page.selectedPath.path);
  ctx.strokeStyle = inkOf(stage, "selected");
  ctx.lineWidth = 2.5 * px;
  ctx.stroke(page.selectedPath.path);
  const thing = selection.kind === "remark" ? map.remarks[selection.index] : map[selection.kind]?.[selection.index], place = selection.place ?? thing?.at;
  if (thing?.points?.length > 1) ctx.stroke(pathOfPoints(thing.points));
  if (!place) return;
  ctx.beginPath();
  ctx.arc(...place, 7 * px, 0, 2 * Math.PI);
  ctx.stroke();
}

function pathOfPoints(points) {
  const path = new Path2D();
  points.forEach(([x, y], n) => (n === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  return path;
}

const LETTER_PX = 7, LABEL_PX = 14;

/** Names of the lanes in view that are long enough for them, in pixels; none on another. */
function drawNames(page, ctx) {
  const {map, stage} = page, {view} = stage;
  if (!page.layers.names || view.scale < 5) return;
  const wide = view.width / view.scale / 2, high = view.height / view.scale / 2, taken = [];
  for (const i of inBox(map.grid, [view.x - wide, view.y - high, view.x + wide, view.y + high]).slice(0, 150)) {
    const length = lengthOf(map.lanes, i);
    if (length * view.scale < 120 || map.lanes.width[i] * view.scale < 14) continue;
    const [x, y] = toScreen(view, pointOnLane(map.lanes, i, length / 3));
    const name = map.lanes.names[i], right = x + LETTER_PX * name.length;
    if (taken.some((one) => x < one.right && right > one.x && Math.abs(y - one.y) < LABEL_PX)) continue;
    taken.push({x, y, right});
    drawLabel(stage, ctx, name, [x - 12, y + 4]);
  }
}

function drawPage(page, stage, ctx, ratio) {
  const missing = drawTiles(stage, page.tiles, ctx, ratio);
  ctx.save();
  toMetres(ctx, stage.view, ratio);
  drawSelected(page, ctx);
  ctx.restore();
  drawNames(page, ctx);
  drawMeasured(page, ctx);
  drawScaleBar(stage, ctx);
  if (stage.canvas.matches(":focus-visible")) drawCross(stage, ctx);
  document.documentElement.dataset.drawn = missing ? "part" : "all";
}

/** Where Enter selects. */
function drawCross(stage, ctx) {
  const {width, height} = stage.view;
  ctx.strokeStyle = inkOf(stage, "text");
  ctx.lineWidth = 1.5;
  ctx.setLineDash([]);
  ctx.beginPath();
  for (const [dx, dy] of [[10, 0], [0, 10]]) {
    ctx.moveTo(width / 2 - dx, height / 2 - dy);
    ctx.lineTo(width / 2 + dx, height / 2 + dy);
  }
  ctx.stroke();
}

function watchKeys(page) {
  const {canvas} = page.stage;
  for (const name of ["focus", "blur"]) canvas.addEventListener(name, () => redraw(page.stage));
  canvas.addEventListener("keydown", (event) => {
    if (event.key === "Enter") clicked(page, [page.stage.view.x, page.stage.view.y]);
  });
  const acts = {n: () => nextRemark(page, 1), p: () => nextRemark(page, -1), m: () => setMode(page, "measure"), r: () => setMode(page, "route"),
                c: () => setColours(page, Object.keys(SCHEMES)[(Object.keys(SCHEMES).indexOf(page.map.colouring.key) + 1) % 4]),
                "/": () => element("search").focus(), Escape: () => clearAll(page)};
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== "checkbox";
    if (typing && event.key === "Escape") {
      element("hits").hidden = true;
      return event.target.blur();
    }
    if (typing) return;
    if (keyOfStage(page.stage, event.key) || acts[event.key]) event.preventDefault();
    acts[event.key]?.();
  });
}

function clearAll(page) {
  if (page.mode !== "select") setMode(page, page.mode);
  page.ends = {};
  element("command_box").hidden = true;
  element("hits").hidden = true;
  select(page, null);
}

function watchButtons(page) {
  const {stage} = page;
  for (const [id, act] of [["fit", () => goHome(stage)], ["zoom_in", () => zoomStage(stage, 1.5)], ["zoom_out", () => zoomStage(stage, 1 / 1.5)],
                           ["measure", () => setMode(page, "measure")], ["route", () => setMode(page, "route")],
                           ["link", () => copyText(page, location.href.replace(/#.*/, "") + linkOf(page))],
                           ["copy_command", () => copyText(page, element("command").textContent)]]) {
    element(id).addEventListener("click", act);
  }
  element("colours").addEventListener("change", (event) => {
    setColours(page, event.target.value);
    noteLink(page);
  });
}

function start() {
  const map = decodeMap(JSON.parse(element("data").textContent));
  const page = {map, mode: "select", measured: [], ends: {}, selection: null, hoveredLane: -1,
                layers: Object.fromEntries(Object.keys(LAYERS).map((key) => [key, true]))};
  map.colouring = classify(map, "type");
  page.tiles = makeTiles((ctx, box, scale, ratio) =>
      paintMap(map, page.layers, makePen(ctx, box, scale, ratio, (name) => inkOf(page.stage, name))));
  page.stage = makeStage(element("map"), map.box, 24, {
    draw: (stage, ctx, ratio) => drawPage(page, stage, ctx, ratio),
    moved: () => {
      page.tiles.changed = performance.now();
      noteLink(page);
    },
    clicked: (place) => clicked(page, place),
    hovered: (place) => hovered(page, place),
    recoloured: () => repaint(page),
  });
  resizeStage(page.stage);
  listLayers(page);
  makeFindings(page);
  showLegend(page);
  watchSearch(page);
  watchButtons(page);
  watchKeys(page);
  showSelection(page);
  followLink(page, location.hash);
  addEventListener("hashchange", () => location.hash !== page.ownLink && followLink(page, location.hash));
  document.documentElement.dataset.ready = "yes";
}
