// The address of a view: #view=X,Y,SCALE&at=X,Y&lane=NAME&colour=speed&hide=signals,arrows

function readLink(fragment) {
  const link = {};
  for (const part of fragment.replace(/^#/, "").split("&")) {
    const cut = part.indexOf("=");
    if (cut > 0) link[part.slice(0, cut)] = decodeURIComponent(part.slice(cut + 1));
  }
  return link;
}

/** Numbers of "1,2.5"; null if there are not so many. */
function numbersIn(text, count) {
  const numbers = (text ?? "").split(",").map(Number);
  return numbers.length === count && text !== undefined && numbers.every(Number.isFinite) ? numbers : null;
}

function writeLink(link) {
  const parts = Object.entries(link).filter(([, value]) => value).map(([key, value]) =>
      `${key}=${encodeURIComponent(value).replaceAll("%2C", ",").replaceAll("%2F", "/")}`);
  return "#" + parts.join("&");
}

function linkOf(page) {
  const {stage, selection, map, layers} = page, {view} = stage, [x, y] = rawOf(map, [view.x, view.y]);
  const link = {};
  if (!stage.fitted) link.view = `${x.toFixed(2)},${y.toFixed(2)},${Number(view.scale.toPrecision(4))}`;
  if (selection?.place && selection.kind === "lane") link.at = coordinatesText(map, selection.place).replace(" ", "");
  else if (selection) link.find = nameOf(map, selection);
  if (map.colouring.key !== "type") link.colour = map.colouring.key;
  link.hide = Object.keys(layers).filter((key) => !layers[key]).join(",");
  return writeLink(link);
}

/** Keeps the address up to date, but not at every frame: browsers allow only so many. */
function noteLink(page) {
  clearTimeout(page.linking);
  page.linking = setTimeout(() => {
    page.ownLink = linkOf(page);
    history.replaceState(null, "", page.ownLink);
  }, 250);
}

/** Does what an address says. */
function followLink(page, fragment) {
  const link = readLink(fragment), {map, stage} = page, at = numbersIn(link.at, 2), view = numbersIn(link.view, 3);
  if (link.colour in SCHEMES) setColours(page, link.colour);
  if (link.hide !== undefined) for (const key of Object.keys(page.layers)) showLayer(page, key, !link.hide.split(",").includes(key));
  const target = link.find ? findElement(map, link.find) : link.lane ? findElement(map, "lane " + link.lane) : null;
  if (at) visitPlace(page, fromRaw(map, at));
  else if (target) visit(page, target);
  if (view) {
    [stage.view.x, stage.view.y] = fromRaw(map, view);
    stage.view.scale = view[2];
    stage.fitted = false;
    redraw(stage);
  }
}
