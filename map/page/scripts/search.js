// Things by id or name, places by coordinates.

const MOST_HITS = 30;

/** What a finding or a search names: "lane 12/0/-1", "road 12", "lanelet 4"; null if nothing does. */
function findElement(map, text) {
  const overlay = map.overlays.findIndex(({name}) => name === text);
  if (overlay >= 0) return {kind: "overlays", index: overlay};
  const [, word, id] = /^(\S+)\s+(.+)$/.exec(text.replace(/^stop line /, "stop_line ")) ?? [];
  if (!word) return null;
  if (["lane", "lanelet"].includes(word)) return map.laneNumbers.has(id) ? {kind: "lane", index: map.laneNumbers.get(id)} : null;
  const lists = {road: ["road", map.roads.ids], junction: ["junction", map.junctions.map((one) => one.id)],
                 signal: ["signals", map.signals.map((one) => one.id)], object: ["objects", map.objects.map((one) => one.id)],
                 area: ["areas", map.areas.map((one) => one.id)], "stop_line": ["stopLines", map.stopLines.map((one) => one.id)],
                 regulation: ["regulations", map.regulations.map((one) => one.id)]};
  const [kind, ids] = lists[word] ?? [];
  const index = kind ? ids.indexOf(id) : -1;
  return index < 0 ? null : {kind, index};
}

/** Two numbers as a place of the map: raw coordinates, or latitude and longitude where these are meant. */
function findPlace(map, text) {
  const found = /^\s*(-?\d+(?:\.\d+)?)\s*[,; ]\s*(-?\d+(?:\.\d+)?)\s*$/.exec(text);
  if (!found) return null;
  const numbers = [Number(found[1]), Number(found[2])], raw = fromRaw(map, numbers), [x0, y0, x1, y1] = map.box;
  const isInside = raw[0] >= x0 - 100 && raw[0] <= x1 + 100 && raw[1] >= y0 - 100 && raw[1] <= y1 + 100;
  return (isInside ? null : placeOfLonLat(map.lonLat, [numbers[1], numbers[0]])) ?? raw;
}

/** How well a text fits what is looked for: 0 the same, 1 begins with it, 2 holds it, else 9. */
function fitOf(text, wanted) {
  const low = text.toLowerCase();
  return low === wanted ? 0 : low.startsWith(wanted) ? 1 : low.includes(wanted) ? 2 : 9;
}

/** @returns [{target or place, text}, …], the best first */
function findAll(map, text) {
  const wanted = text.trim().toLowerCase(), hits = [];
  if (wanted === "") return hits;
  const place = findPlace(map, text);
  if (place) hits.push({fit: -1, place, text: `place ${coordinatesText(map, place)}`});
  const exact = findElement(map, text.trim());
  if (exact) hits.push({fit: -1, target: exact, text: nameOf(map, exact)});
  const look = (kind, index, names) => {
    const fit = Math.min(...names.map((name) => fitOf(name ?? "", wanted)));
    if (fit < 9) hits.push({fit, target: {kind, index}, text: [nameOf(map, {kind, index}), names[1]].filter((one) => one).join(" · ")});
  };
  map.roads.ids.forEach((id, i) => look("road", i, [id, map.roads.names[i]]));
  map.junctions.forEach((one, i) => look("junction", i, [one.id, one.name]));
  map.lanes.names.forEach((name, i) => (fitOf(name, wanted) < 9 ? look("lane", i, [name]) : null));
  map.signals.forEach((one, i) => look("signals", i, [one.id, one.name, one.type]));
  map.objects.forEach((one, i) => look("objects", i, [one.id, one.name, one.type]));
  return hits.sort((a, b) => a.fit - b.fit).slice(0, MOST_HITS);
}

function showHits(page, text) {
  const list = element("hits"), hits = findAll(page.map, text);
  list.replaceChildren();
  list.hidden = text.trim() === "";
  for (const hit of hits) {
    const item = addText(list, "li", "", "");
    addButton(item, hit.text, "link", () => openHit(page, hit));
  }
  if (hits.length === 0) addText(list, "li", "quiet", "Nothing is called so.");
  return hits;
}

function openHit(page, hit) {
  element("hits").hidden = true;
  if (hit.target) visit(page, hit.target); else visitPlace(page, hit.place);
}

function watchSearch(page) {
  const box = element("search");
  box.addEventListener("input", () => showHits(page, box.value));
  element("search_form").addEventListener("submit", (event) => {
    event.preventDefault();
    const [first] = showHits(page, box.value);
    if (first) openHit(page, first); else say(page, `nothing is called "${box.value}"`);
  });
}
