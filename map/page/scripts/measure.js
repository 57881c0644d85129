// Modes of the pointer: select, measure a distance, name two places of a route.

function lengthOfPoints(points) {
  return points.reduce((sum, [x, y], n) => (n === 0 ? 0 : sum + Math.hypot(x - points[n - 1][0], y - points[n - 1][1])), 0);
}

function setMode(page, mode) {
  page.mode = page.mode === mode ? "select" : mode;
  page.measured = [];
  if (page.mode === "route") page.ends = {};
  for (const name of ["measure", "route"]) element(name).setAttribute("aria-pressed", String(page.mode === name));
  say(page, page.mode === "measure" ? "Click the places to measure between." :
            page.mode === "route" ? "Click where the route begins, then where it ends." : "");
  redraw(page.stage);
}

function measureTo(page, place) {
  page.measured.push(place);
  say(page, `${lengthOfPoints(page.measured).toFixed(3)} m over ${page.measured.length} places`);
  redraw(page.stage);
}

/** The place on a lane that a click means, for a route. */
function endAt(page, place) {
  const at = locate(page.map, place);
  return at && {...at, argument: laneArgument(page.map.lanes, at.lane, at.s)};
}

function routeCommand(page) {
  const {from, to} = page.ends;
  return from && to ? `roadbed route ${quoted(page.map.file)} --from ${quoted(from.argument)} --to ${quoted(to.argument)}` : "";
}

function setEnd(page, which, end) {
  page.ends[which] = end;
  const command = routeCommand(page);
  element("command").textContent = command;
  element("command_box").hidden = command === "";
  if (!command) say(page, `${which} ${end.argument}`);
  redraw(page.stage);
}

function routeTo(page, place) {
  const end = endAt(page, place);
  if (!end) return say(page, "no lane is near");
  if (page.ends.from && page.ends.to) page.ends = {};
  setEnd(page, page.ends.from ? "to" : "from", end);
}

function showRouteEnds(page, box) {
  const {selection} = page;
  if (selection.kind !== "lane" || !selection.place) return;
  const row = addText(box, "p", "buttons", "");
  for (const which of ["from", "to"]) {
    addButton(row, `Route ${which} here`, "", () => setEnd(page, which, endAt(page, selection.place)));
  }
}

function drawMeasured(page, ctx) {
  const {stage, measured} = page, ink = inkOf(stage, "accent");
  if (measured.length > 0) {
    ctx.strokeStyle = ctx.fillStyle = ink;
    ctx.lineWidth = 2;
    ctx.beginPath();
    for (const place of measured) ctx.lineTo(...toScreen(stage.view, place));
    ctx.stroke();
    for (const place of measured) {
      ctx.beginPath();
      ctx.arc(...toScreen(stage.view, place), 3.5, 0, 2 * Math.PI);
      ctx.fill();
    }
    const [x, y] = toScreen(stage.view, measured.at(-1));
    drawLabel(stage, ctx, `${lengthOfPoints(measured).toFixed(2)} m`, [x + 8, y - 8]);
  }
  for (const [which, end] of Object.entries(page.ends)) {
    const [x, y] = toScreen(stage.view, pointOnLane(page.map.lanes, end.lane, end.s, end.d));
    ctx.fillStyle = inkOf(stage, which === "from" ? "good" : "bad");
    ctx.beginPath();
    ctx.arc(x, y, 6, 0, 2 * Math.PI);
    ctx.fill();
    drawLabel(stage, ctx, which, [x + 9, y + 4]);
  }
}
