// What is selected, in words: every text of the map is set as text, never as markup.

const PARTICIPANTS = ["pedestrian", "bicycle", "motorcycle", "car", "taxi", "bus", "truck", "emergency", "tram", "train"];

function addText(parent, tag, css, text) {
  const made = document.createElement(tag);
  if (css) made.className = css;
  made.textContent = text;
  parent.append(made);
  return made;
}

function addButton(parent, text, css, act) {
  const button = addText(parent, "button", css, text);
  button.type = "button";
  button.addEventListener("click", act);
  return button;
}

/** A row of the table; `value` is a text or what fills the cell. */
function addRow(table, name, value) {
  if (value === "" || value === null || value === undefined) return;
  const row = table.insertRow();
  addText(row, "th", "", name).scope = "row";
  const cell = row.insertCell();
  if (typeof value === "function") value(cell); else cell.textContent = value;
}

function rawOf(map, [x, y]) {
  return [map.origin[0] + x, map.origin[1] + y];
}

function fromRaw(map, [x, y]) {
  return [x - map.origin[0], y - map.origin[1]];
}

function coordinatesText(map, place) {
  return rawOf(map, place).map((value) => value.toFixed(3)).join(", ");
}

function lonLatText(map, place) {
  const found = lonLatOf(map.lonLat, place);
  return found && `${found[1].toFixed(8)}, ${found[0].toFixed(8)}`;
}

function wordOf(kind) {
  const words = {signals: "signal", objects: "object", stopLines: "stop line", areas: "area", regulations: "regulation",
                 overlays: "overlay"};
  return words[kind] ?? kind;
}

/** "lane 12/0/-1", as findings, links and the list of hits name things. */
function nameOf(map, {kind, index}) {
  if (kind === "lane") return `lane ${map.lanes.names[index]}`;
  if (kind === "road") return `road ${map.roads.ids[index]}`;
  if (kind === "junction") return `junction ${map.junctions[index].id}`;
  if (kind === "remark") return `${map.remarks[index].severity}: ${map.remarks[index].rule}`;
  if (kind === "overlays") return map.overlays[index].name;
  return `${wordOf(kind)} ${map[kind][index].id}`;
}

/** Buttons that select things, with what is said of each. */
function linksTo(page, targets) {
  return (cell) => {
    if (targets.length === 0) cell.textContent = "–";
    for (const {target, note} of targets) {
      addButton(cell, nameOf(page.map, target).replace(/^lane /, ""), "link", () => visit(page, target));
      if (note) addText(cell, "span", "note", note);
    }
  };
}

function lanesAsTargets(indices, note = () => "") {
  return indices.map((index) => ({target: {kind: "lane", index}, note: note(index)}));
}

function speedText(limit) {
  if (limit === null) return "not known";
  return limit === Infinity ? "none" : `${(3.6 * limit).toFixed(0)} km/h (${limit.toFixed(2)} m/s)`;
}

function speedsText(lanes, i) {
  const limits = speedsOf(lanes, i);
  if (limits.length === 0) return "not known";
  return limits.map(([from, limit], n) => (n === 0 && limits.length === 1 ? "" : `from ${from.toFixed(1)} m: `) + speedText(limit)).join("; ");
}

function participantsText(bits) {
  return PARTICIPANTS.filter((_, bit) => bits >> bit & 1).join(", ") || "nobody";
}

function addNeighbour(page, table, name, coded, lane) {
  const to = neighbourOf(coded, lane);
  if (!to) return addRow(table, name, "–");
  const note = (to.sameDirection ? "" : "oncoming, ") + (to.changeAllowed ? "may be changed to" : "no change");
  addRow(table, name, linksTo(page, lanesAsTargets([to.lane], () => note)));
}

/** What speaks to a lane: signals, stop lines, regulations. */
function rulesOf(map, lane) {
  const found = [];
  for (const kind of ["signals", "stopLines", "regulations"]) {
    map[kind].forEach((one, index) => {
      if (one.lanes.includes(lane)) found.push({target: {kind, index}, note: [one.type, one.value].filter((text) => text).join(" ")});
    });
  }
  return found;
}

/** How commands name a place of a lane. */
function laneArgument(lanes, i, s) {
  const clamped = Math.max(0, Math.min(s, Math.floor(lengthOf(lanes, i) * 100) / 100));
  return `lane:${lanes.names[i]}@${clamped.toFixed(2)}`;
}

function quoted(text) {
  return /^[\w./:@,+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

function copyText(page, text) {
  const done = () => say(page, `copied: ${text}`);
  if (navigator.clipboard) return navigator.clipboard.writeText(text).then(done, () => say(page, text));
  say(page, text);
}

function addCopy(page, table, name, text) {
  addRow(table, name, (cell) => {
    addText(cell, "code", "", text);
    addButton(cell, "Copy", "small", () => copyText(page, text));
  });
}

function describeLane(page, table, {index, place}) {
  const {map} = page, {lanes} = map, at = placeOnLane(lanes, index, place);
  addRow(table, "type", lanes.types[lanes.type[index]] + (lanes.oneWay[index] ? "" : ", both directions"));
  if (lanes.road[index] >= 0) addRow(table, "road", linksTo(page, [{target: {kind: "road", index: lanes.road[index]}, note: map.roads.names[lanes.road[index]]}]));
  if (lanes.junction[index] >= 0) addRow(table, "junction", linksTo(page, [{target: {kind: "junction", index: lanes.junction[index]}}]));
  addRow(table, "length", `${lengthOf(lanes, index).toFixed(2)} m`);
  addRow(table, "s, d", `${at.s.toFixed(3)} m, ${at.d.toFixed(3)} m`);
  const onRoad = placeOnRoad(map, index, place);
  if (onRoad) addRow(table, "road s, t", `${onRoad.s.toFixed(3)} m, ${onRoad.t.toFixed(3)} m`);
  addRow(table, "width", `${widthAt(lanes, index, at.s).toFixed(2)} m`);
  addRow(table, "heading", `${at.heading.toFixed(4)} rad (${(at.heading * 180 / Math.PI).toFixed(1)}°)`);
  addRow(table, "speed limit", speedsText(lanes, index));
  addRow(table, "open to", participantsText(lanes.participants[index]));
  addRow(table, "steepest", `${(100 * steepest(lanes, index)).toFixed(1)} %`);
  addRow(table, "predecessors", linksTo(page, lanesAsTargets(predecessorsOf(lanes, index))));
  addRow(table, "successors", linksTo(page, lanesAsTargets(successorsOf(lanes, index))));
  addNeighbour(page, table, "left", lanes.left[index], index);
  addNeighbour(page, table, "right", lanes.right[index], index);
  const rules = rulesOf(map, index);
  if (rules.length > 0) addRow(table, "rules", linksTo(page, rules));
  addRow(table, "says", lanes.texts[lanes.attributes[index]]);
  addCopy(page, table, "argument", laneArgument(lanes, index, at.s));
}

function lanesWhere(lanes, fits) {
  const found = [];
  for (let i = 0; i < lanes.count; ++i) if (fits(i)) found.push(i);
  return found;
}

function describeRoad(page, table, {index}) {
  const {map} = page, {roads} = map;
  addRow(table, "name", roads.names[index]);
  addRow(table, "length", `${roads.lengths[index].toFixed(2)} m`);
  if (roads.junction[index] >= 0) addRow(table, "junction", linksTo(page, [{target: {kind: "junction", index: roads.junction[index]}}]));
  addRow(table, "lanes", linksTo(page, lanesAsTargets(lanesOf(map, {kind: "road", index}))));
}

function describeJunction(page, table, {index}) {
  const {map} = page, {junction} = map.roads;
  addRow(table, "name", map.junctions[index].name);
  addRow(table, "kind", map.junctions[index].type);
  const roads = [...junction.keys()].filter((road) => junction[road] === index);
  addRow(table, "roads", linksTo(page, roads.map((road) => ({target: {kind: "road", index: road}}))));
}

/** Signals, objects, stop lines, areas, regulations. */
function describeThing(page, table, {kind, index}) {
  const {map} = page, thing = map[kind][index];
  for (const [name, key] of [["name", "name"], ["type", "type"], ["subtype", "subtype"], ["country", "country"],
                             ["value", "value"], ["text", "text"]]) {
    addRow(table, name, thing[key] === "-1" ? "" : thing[key]);
  }
  if (thing.dynamic) addRow(table, "changes", "yes");
  if (Number.isInteger(thing.road)) addRow(table, "road", linksTo(page, [{target: {kind: "road", index: thing.road}}]));
  if (thing.on && Number.isInteger(thing.road)) addRow(table, "road s, t", thing.on.map((value) => `${value.toFixed(3)} m`).join(", "));
  if (thing.height) addRow(table, "height", `${thing.height.toFixed(2)} m`);
  if (thing.lanes) addRow(table, "lanes", linksTo(page, lanesAsTargets(thing.lanes)));
  for (const [role, id, lane] of thing.members ?? []) {
    addRow(table, role, lane === null ? id : linksTo(page, lanesAsTargets([lane])));
  }
  if (thing.signals?.length > 0) addRow(table, "signals", thing.signals.join(", "));
  addRow(table, "says", thing.attributes);
}

function describeRemark(page, table, {index}) {
  const {map} = page, remark = map.remarks[index], target = findElement(map, remark.element);
  addRow(table, "rule", remark.rule);
  addRow(table, "severity", remark.severity);
  addRow(table, "element", target ? linksTo(page, [{target}]) : remark.element);
  addRow(table, "line", remark.line > 0 ? String(remark.line) : "");
  addRow(table, "message", remark.message);
}

function describeOverlay(page, table, {index}) {
  const {pieces, lines, text} = page.map.overlays[index];
  addRow(table, "says", text);
  addRow(table, "length", pieces.length > 0 ? `${lengthOfPieces(pieces).toFixed(2)} m` : lines.length === 1 ? `${lengthOfPoints(lines[0]).toFixed(2)} m` : "");
  if (pieces.length > 0) addRow(table, "lanes", linksTo(page, lanesAsTargets([...new Set(pieces.map(({lane}) => lane))])));
}

const DESCRIBE = {lane: describeLane, road: describeRoad, junction: describeJunction, remark: describeRemark, overlays: describeOverlay};

/** The line of the source that a thing stands in; 0 if it is not known. */
function lineOf(map, selection) {
  return selection.kind === "lane" ? map.lanes.line[selection.index] : map.lines[nameOf(map, selection)] ?? 0;
}

/** Lanes that a selection stands for. */
function lanesOf(map, {kind, index}) {
  const {lanes} = map;
  if (kind === "lane") return [index];
  if (kind === "road") return lanesWhere(lanes, (i) => lanes.road[i] === index);
  if (kind === "junction") return lanesWhere(lanes, (i) => lanes.junction[i] === index);
  return map[kind]?.[index].lanes ?? [];
}

/** A place of a thing, to go there. */
function placeOf(map, selection) {
  if (selection.place) return selection.place;
  const {kind, index} = selection, thing = kind === "remark" ? map.remarks[index] : map[kind]?.[index];
  if (thing?.at) return thing.at;
  if (thing) {
    const box = boxOfThing(thing);
    if (box) return [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
  }
  const [lane] = lanesOf(map, selection);
  return lane === undefined ? null : pointOnLane(map.lanes, lane, lengthOf(map.lanes, lane) / 2);
}

function showSelection(page) {
  const {map, selection} = page, box = element("details");
  box.replaceChildren();
  element("selected").textContent = !selection ? "" :
      selection.kind === "lane" ? map.lanes.names[selection.index] : nameOf(map, selection);
  element("kind").textContent = !selection ? "Click on the map" : selection.kind === "remark" ?
      map.remarksTitle.toLowerCase().replace(/s$/, "") : wordOf(selection.kind);
  if (!selection) return;
  const table = document.createElement("table");
  (DESCRIBE[selection.kind] ?? describeThing)(page, table, selection);
  const line = lineOf(map, selection), place = placeOf(map, selection);
  if (line > 0) addRow(table, "source line", String(line));
  if (place) {
    addCopy(page, table, "x, y", coordinatesText(map, place));
    addRow(table, "lat, lon", lonLatText(map, place));
  }
  if (selection.distance > 0) addRow(table, "away", `${selection.distance.toFixed(3)} m`);
  box.append(table);
  showRouteEnds(page, box);
  showProfile(page, box);
  showAlsoHere(page, box);
}

/** Lanes and things at a place, as what is selected. */
function thingsAt(page, place) {
  const {map} = page, reach = 6 / page.stage.view.scale;
  const around = [place[0] - reach, place[1] - reach, place[0] + reach, place[1] + reach];
  const lanes = lanesNear(map, place, 0).map(({lane}) => ({kind: "lane", index: lane, place}));
  const things = ["signals", "objects", "stopLines", "areas"].flatMap((kind) => thingsIn(map, kind, around).map((index) => ({kind, index, place})));
  return [...lanes, ...things].slice(0, 12);
}

function isSame(a, b) {
  return a && b && a.kind === b.kind && a.index === b.index;
}

function showAlsoHere(page, box) {
  const {selection} = page;
  if (!selection.place) return;
  const others = thingsAt(page, selection.place).filter((one) => !isSame(one, selection));
  if (others.length === 0) return;
  addText(box, "h3", "", "Also here: click again, or");
  const list = addText(box, "p", "", "");
  for (const one of others) addButton(list, nameOf(page.map, one), "link", () => select(page, one));
}

function say(page, text) {
  element("message").textContent = text;
}
