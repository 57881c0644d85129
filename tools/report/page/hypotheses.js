// What the planner considered in a cycle: a table with why each lost, and the s–t picture of one of them.

const ST_STEP = 0.5;         // s, between the times of a picture: planning::StPicture::kStep_s
const SAME_PART = 15;        // metres that a part may have moved on between two of them
const ST_MARGINS = {left: 44, right: 10, top: 8, bottom: 30};  // pixels, for the axes

function decodeSt({drive, parts}) {
  const decoded = {drive: drive.map((cm) => cm / 100), parts: []};
  for (let i = 0; i + 3 < parts.length; i += 4) {
    decoded.parts.push({obstacle: parts[i], step: parts[i + 1], from: parts[i + 2] / 100, to: parts[i + 3] / 100});
  }
  return decoded;
}

/** Parts of one obstacle at neighbouring times as one ring of [time, distance]; a part that is alone lasts for half a step. */
function ringsOfParts(parts) {
  const rings = [], open = new Map();
  for (const {obstacle, step, from, to} of parts) {
    const before = (open.get(obstacle) ?? []).find((one) => one.last === step - 1 && !one.continued && from < one.to + SAME_PART && to > one.from - SAME_PART);
    const ring = before ? before.ring : {obstacle, low: [], high: []};
    if (before) before.continued = true;
    else rings.push(ring);
    ring.low.push([ST_STEP * step, from]);
    ring.high.push([ST_STEP * step, to]);
    if (!open.has(obstacle)) open.set(obstacle, []);
    open.get(obstacle).push({ring, last: step, from, to, continued: false});
  }
  return rings.map(({obstacle, low, high}) => {
    if (low.length === 1) {
      const [t] = low[0], half = ST_STEP / 4;
      return {obstacle, points: [[t - half, low[0][1]], [t + half, low[0][1]], [t + half, high[0][1]], [t - half, high[0][1]]]};
    }
    return {obstacle, points: [...low, ...high.toReversed()]};
  });
}

/** Times and distances that a picture shows. */
function rangesOfSt({drive, parts}) {
  const end = Math.max(...drive), last = ST_STEP * (drive.length - 1);
  const shown = parts.filter((part) => part.from < end + 25 && part.to > -10);
  const high = Math.max(end + 5, ...shown.map((part) => Math.min(part.to, end + 25)), 10);
  return {t: [0, Math.max(last, 1)], s: [Math.min(-5, ...shown.map((part) => Math.max(part.from, -10))), high]};
}

function axesOfSt(width, height, ranges) {
  const {left, right, top, bottom} = ST_MARGINS, wide = width - left - right, high = height - top - bottom;
  return {
    x: (t) => left + wide * (t - ranges.t[0]) / (ranges.t[1] - ranges.t[0]),
    y: (s) => top + high * (ranges.s[1] - s) / (ranges.s[1] - ranges.s[0]),
    box: [left, top, wide, high], least: ranges.s[0],
  };
}

function lineOfSt(ctx, axes, points) {
  ctx.beginPath();
  points.forEach(([t, s], i) => (i === 0 ? ctx.moveTo(axes.x(t), axes.y(s)) : ctx.lineTo(axes.x(t), axes.y(s))));
}

function drawAxesOfSt(ctx, axes, ranges, ink) {
  ctx.strokeStyle = ink("grid");
  ctx.fillStyle = ink("quiet");
  ctx.lineWidth = 1;
  const [left, top, wide, high] = axes.box, step = tickStep(2 * (ranges.s[1] - ranges.s[0]));
  ctx.textAlign = "right";
  for (let s = Math.ceil(ranges.s[0] / step) * step; s <= ranges.s[1]; s += step) {
    lineOfSt(ctx, axes, [[ranges.t[0], s], [ranges.t[1], s]]);
    ctx.stroke();
    ctx.fillText(String(round(s)), left - 5, axes.y(s) + 4);
  }
  ctx.textAlign = "center";
  for (let t = 0; t <= ranges.t[1] + 1e-9; t += ranges.t[1] > 6 ? 2 : 1) {
    lineOfSt(ctx, axes, [[t, ranges.s[0]], [t, ranges.s[1]]]);
    ctx.stroke();
    ctx.fillText(String(t), axes.x(t), top + high + 13);
  }
  ctx.fillText("s from now", left + wide / 2, top + high + 26);
  ctx.save();
  ctx.translate(11, top + high / 2);
  ctx.rotate(-Math.PI / 2);
  ctx.fillText("m along the path", 0, 0);
  ctx.restore();
}

function drawBlockedParts(ctx, axes, st, nameOf, ink) {
  for (const {obstacle, points} of ringsOfParts(st.parts)) {
    lineOfSt(ctx, axes, points);
    ctx.closePath();
    ctx.fillStyle = ink(obstacle < 0 ? "bad" : "moving");
    ctx.globalAlpha = 0.45;
    ctx.fill();
    ctx.globalAlpha = 1;
    ctx.strokeStyle = ctx.fillStyle;
    ctx.stroke();
    const [t, s] = points[0];
    ctx.textAlign = "left";
    ctx.fillStyle = ink("text");
    ctx.strokeStyle = ink("card");
    ctx.lineWidth = 3;
    const at = [axes.x(t) + 4, Math.min(axes.y(Math.max(s, axes.least)) - 5, axes.box[1] + axes.box[3] - 5)];
    ctx.strokeText(shortened(nameOf(obstacle), 18), ...at);
    ctx.fillText(shortened(nameOf(obstacle), 18), ...at);
    ctx.lineWidth = 1;
  }
}

/** Distance over time: what is in the way when, and what is driven. */
function drawSt(canvas, st, nameOf, ink) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth || 426, height = canvas.clientHeight || 240;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const ctx = canvas.getContext("2d"), ranges = rangesOfSt(st), axes = axesOfSt(width, height, ranges);
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.font = "11px system-ui, sans-serif";
  drawAxesOfSt(ctx, axes, ranges, ink);
  ctx.save();
  ctx.beginPath();
  ctx.rect(...axes.box);
  ctx.clip();
  drawBlockedParts(ctx, axes, st, nameOf, ink);
  ctx.strokeStyle = ink("plan");
  ctx.lineWidth = 2.5;
  lineOfSt(ctx, axes, st.drive.map((s, i) => [ST_STEP * i, s]));
  ctx.stroke();
  ctx.restore();
}

function costText(cost) {
  return cost === null ? "" : cost.toFixed(3);
}

function addHypothesis(rows, one, choose) {
  const row = rows.insertRow(), button = document.createElement("button");
  row.insertCell().append(button);
  button.type = "button";
  button.textContent = one.maneuver;
  button.disabled = !one.st;
  button.addEventListener("click", () => choose(one, button, true));
  const end = one.d === null ? (one.st ? "on the path that is kept" : "no path") : `d ${one.d.toFixed(1)} m, l ${one.l.toFixed(1)} m`;
  addText(row, "td", "", end);
  for (const cost of [one.path, one.drive]) addText(row, "td", "number", costText(cost));
  addText(row, "td", one.driven ? "passed" : "", one.driven ? "✔ driven" : one.reason);
  return button;
}

/** The table of a plan's hypotheses; a click on one shows its s–t picture. */
function hypothesesBox(page, plan) {
  const {scene, stage} = page.map, box = document.createElement("div"), table = document.createElement("table"), buttons = [];
  const figure = document.createElement("figure"), canvas = document.createElement("canvas"), caption = addText(figure, "figcaption", "", "");
  box.className = "hypotheses";
  canvas.className = "st";
  const nameOf = (obstacle) => (obstacle < 0 ? "light or stop" : scene.obstacles[obstacle]?.id || "obstacle");
  const choose = (one, button, isWanted) => {
    if (isWanted) page.wantedManeuver = one.driven ? null : one.maneuver;
    buttons.forEach((each) => each.setAttribute("aria-pressed", String(each === button)));
    const lights = one.st.parts.some(({obstacle}) => obstacle < 0) ? ", lights and stops in red" : "";
    caption.textContent = `${one.maneuver}: what is in the way when, in orange${lights}, and its drive, in green`;
    drawSt(canvas, one.st, nameOf, (name) => inkOf(stage, name));
  };
  const head = table.createTHead().insertRow();
  for (const [text, kind] of [["hypothesis", ""], ["path ends at", ""], ["path cost", "number"], ["drive cost", "number"], ["what became of it", ""]]) {
    addText(head, "th", kind, text);
  }
  const rows = table.createTBody();
  for (const one of plan.hypotheses) buttons.push(addHypothesis(rows, one, choose));
  box.append(table);
  const find = (wanted) => plan.hypotheses.findIndex((one) => one.st && wanted(one));
  const shown = [(one) => one.maneuver === page.wantedManeuver, (one) => one.driven, () => true].map(find).find((index) => index >= 0) ?? -1;
  if (shown < 0) return [box];
  figure.prepend(canvas);
  return [box, figure, () => choose(plan.hypotheses[shown], buttons[shown])];
}
