// How what moves looks. `pen` is {ctx, view, ink, scene, t, ghost, stage}; the context is set to
// metres, so that a width of w pixels is w / scale.

function pixels(pen, count) {
  return count / pen.view.scale;
}

function stroke(pen, path, colour, width, dash = []) {
  const {ctx} = pen;
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.setLineDash(dash);
  ctx.stroke(path);
}

function strokePoints(pen, points, colour, width, dash) {
  stroke(pen, pathOfLines([points]), colour, width, dash);
}

function drawDrive(pen) {
  const {scene} = pen;
  if (scene.drive.t.length === 0) return;
  stroke(pen, scene.drivePath, pen.ink("drive-ahead"), pixels(pen, 1.6));
  strokePoints(pen, pathBetween(scene.drive, scene.drive.t[0], pen.t), pen.ink("drive"),
               pixels(pen, 3));
}

function drawFootprints(pen) {
  stroke(pen, pen.scene.footprints, pen.ink("footprint"), pixels(pen, 1));
}

function drawPlan(pen) {
  const plan = planAt(pen.scene, pen.t);
  if (plan) strokePoints(pen, plan.path, pen.ink("plan"), pixels(pen, 4));
}

function drawCandidates(pen) {
  const plan = planAt(pen.scene, pen.t);
  const line = plan && pen.scene.lines[plan.line];
  if (!plan || !plan.grid || !line || line.points.length < 2) return;
  for (const {cause, points} of shownCandidates(line, plan)) {
    strokePoints(pen, points, pen.ink(causeInk(cause).slice(2)), pixels(pen, cause === 0 ? 1.2 : 0.6));
  }
}

/** Where everything that moves will be in 1, 2 and 3 s. */
function drawAhead(pen) {
  for (const {motion, length, width} of pen.scene.obstacles.filter((one) => one.motion.t.length > 1)) {
    for (const ahead of [1, 2, 3]) {
      const {x, y, h} = stateAt(motion, pen.t + ahead), path = new Path2D();
      addRing(path, rectangle(x, y, h, -length / 2, length / 2, width));
      stroke(pen, path, pen.ink("moving"), pixels(pen, 1));
    }
  }
}

/** What the planner foresees, the fainter the less likely; only where it does not know the future. */
function drawForeseen(pen) {
  for (const {points, probability} of planAt(pen.scene, pen.t)?.foreseen ?? []) {
    pen.ctx.globalAlpha = Math.max(0.25, probability);
    strokePoints(pen, points, pen.ink("foreseen"), pixels(pen, 2), [pixels(pen, 6), pixels(pen, 3)]);
    pen.ctx.globalAlpha = 1;
  }
}

/** Their probabilities, where they are not the only ones. */
function drawProbabilities(pen) {
  for (const {points, probability} of planAt(pen.scene, pen.t)?.foreseen ?? []) {
    if (probability < 0.995 && points.length > 0) {
      drawBeside(pen, `${Math.round(100 * probability)} %`, toScreen(pen.view, points.at(-1)), 5);
    }
  }
}

function fillRing(pen, corners, fill, edge) {
  const path = new Path2D();
  addRing(path, corners);
  pen.ctx.fillStyle = fill;
  pen.ctx.fill(path);
  stroke(pen, path, edge, pixels(pen, 1.4));
}

/** Chevron at the front of a body, so that its direction shows. */
function drawNose(pen, state, front, width, colour) {
  const reach = Math.min(0.3 * front, 0.35 * width);
  const tip = rectangle(state.x, state.y, state.h, front - 2.2 * reach, front - reach, 0.6 * width);
  const [nose] = rectangle(state.x, state.y, state.h, front - 1.2 * reach, front - 1.2 * reach, 0);
  strokePoints(pen, [tip[0], nose, tip[3]], colour, pixels(pen, 1.6));
}

function moves(obstacle) {
  return obstacle.motion.t.length > 1;
}

/** Whether the obstacle's motion is known at the time; a standing one is known for ever. */
function knownAt(obstacle, t) {
  const times = obstacle.motion.t;
  return !moves(obstacle) || (t >= times[0] - 0.051 && t <= times[times.length - 1] + 0.051);
}

function drawObstacle(pen, obstacle) {
  const state = stateAt(obstacle.motion, pen.t), half = obstacle.length / 2;
  const kind = moves(obstacle) ? "moving" : "standing";
  pen.ctx.globalAlpha = knownAt(obstacle, pen.t) ? 1 : 0.25;
  if (moves(obstacle)) {
    strokePoints(pen, pathBetween(obstacle.motion, pen.t, pen.t + 3), pen.ink("moving"),
                 pixels(pen, 2), [pixels(pen, 3), pixels(pen, 3)]);
  }
  fillRing(pen, rectangle(state.x, state.y, state.h, -half, half, obstacle.width),
           pen.ink(kind), pen.ink("edge"));
  if (moves(obstacle)) drawNose(pen, state, half, obstacle.width, pen.ink("edge"));
  pen.ctx.globalAlpha = 1;
}

function drawObstacles(pen) {
  for (const obstacle of pen.scene.obstacles) drawObstacle(pen, obstacle);
}

function drawWheel(pen, state, along, across, steering, radius) {
  const c = Math.cos(state.h), s = Math.sin(state.h);
  const x = state.x + c * along - s * across, y = state.y + s * along + c * across;
  fillRing(pen, rectangle(x, y, state.h + steering, -radius, radius, 0.5 * radius),
           pen.ink("edge"), pen.ink("edge"));
}

function drawWheels(pen, state) {
  const {wheelbase, width} = pen.scene.vehicle, track = width / 2 - 0.15;
  for (const side of [-track, track]) {
    drawWheel(pen, state, 0, side, 0, 0.32);
    drawWheel(pen, state, wheelbase, side, state.steering, 0.32);
  }
}

function drawVehicleAt(pen, t, ghost) {
  const {vehicle, drive} = pen.scene, state = stateAt(drive, t);
  pen.ctx.globalAlpha = ghost ? 0.45 : 1;
  fillRing(pen, rectangle(state.x, state.y, state.h, vehicle.back, vehicle.front, vehicle.width),
           pen.ink("ego"), pen.ink("edge"));
  for (const part of vehicle.parts) fillRing(pen, placed(state, part), pen.ink("ego"), pen.ink("edge"));
  if (pen.view.scale > 8) drawWheels(pen, state);
  drawNose(pen, state, vehicle.front, vehicle.width, pen.ink("edge"));
  pen.ctx.globalAlpha = 1;
}

function drawVehicle(pen) {
  if (pen.scene.drive.t.length === 0) return;
  if (pen.ghost !== null) drawVehicleAt(pen, pen.ghost, true);
  drawVehicleAt(pen, pen.t, false);
}

// Drawn in pixels, above everything.

/** Text beside a point, on its left where there is no room on its right. */
function drawBeside(pen, text, [x, y], gap) {
  pen.ctx.font = "12px system-ui, sans-serif";
  const wide = pen.ctx.measureText(text).width, fits = x + gap + wide < pen.view.width - 4;
  drawLabel(pen.stage, pen.ctx, text, [fits ? x + gap : x - gap - wide, y]);
}

/** A ring where the vehicle is, so that it is found on a map of a whole town. */
function drawBeacon(pen) {
  const {ctx, scene, view} = pen;
  if (scene.drive.t.length === 0 || view.scale * scene.vehicle.front > 14) return;
  const [x, y] = toScreen(view, centreOfVehicle(pen));
  ctx.beginPath();
  ctx.arc(x, y, 11, 0, 2 * Math.PI);
  ctx.setLineDash([]);
  ctx.lineWidth = 2.5;
  ctx.strokeStyle = pen.ink("ego");
  ctx.stroke();
}

function centreOfVehicle(pen) {
  const state = stateAt(pen.scene.drive, pen.t);
  const ahead = (pen.scene.vehicle.back + pen.scene.vehicle.front) / 2;
  return [state.x + ahead * Math.cos(state.h), state.y + ahead * Math.sin(state.h)];
}

function drawLabels(pen) {
  for (const obstacle of pen.scene.obstacles) {
    if (obstacle.id === "" || !knownAt(obstacle, pen.t)) continue;
    const state = stateAt(obstacle.motion, pen.t);
    const [x, y] = toScreen(pen.view, [state.x, state.y]);
    const clear = (obstacle.width / 2) * pen.view.scale + 8;
    drawBeside(pen, shortened(obstacle.id, 24), [x, y - clear], 6);
  }
}

function shortened(text, most) {
  const letters = [...text];
  return letters.length <= most ? text : letters.slice(0, most - 1).join("") + "…";
}

function drawFlag(pen, point, text, colour) {
  const {ctx} = pen, [x, y] = toScreen(pen.view, point);
  ctx.fillStyle = colour;
  ctx.strokeStyle = pen.ink("halo");
  ctx.setLineDash([]);
  ctx.lineWidth = 2;
  ctx.beginPath();
  ctx.moveTo(x, y);
  ctx.arc(x, y - 14, 7, 0.75 * Math.PI, 2.25 * Math.PI);
  ctx.closePath();
  ctx.fill();
  ctx.stroke();
  drawBeside(pen, text, [x, y - 12], 11);
}

function drawEnds(pen) {
  if (pen.scene.drivePoints.length > 0) {
    drawFlag(pen, pen.scene.drivePoints[0], "start", pen.ink("start"));
  }
  if (pen.scene.goal) drawFlag(pen, pen.scene.goal, "goal", pen.ink("goal"));
}

// From the ground up. `pixels`: drawn in pixels, after all others.
const LAYERS = [
  {key: "hidden", label: "Hidden by others", shown: true, draw: drawHidden},
  {key: "footprints", label: "Footprints (1 s)", shown: false, draw: drawFootprints},
  {key: "drive", label: "Drive", shown: true, draw: drawDrive},
  {key: "candidates", label: "Candidates", shown: true, draw: drawCandidates},
  {key: "ahead", label: "Others in 1, 2, 3 s", shown: false, draw: drawAhead},
  {key: "foreseen", label: "Foreseen by the planner", shown: true, draw: drawForeseen},
  {key: "plan", label: "Plan", shown: true, draw: drawPlan},
  {key: "obstacles", label: "Obstacles", shown: true, draw: drawObstacles},
  {key: "vehicle", label: "Vehicle", shown: true, draw: drawVehicle},
  {key: "beacon", label: "", shown: true, pixels: true, draw: drawBeacon},
  {key: "ends", label: "Start and goal", shown: true, pixels: true, draw: drawEnds},
  {key: "probabilities", label: "", shown: true, pixels: true, draw: drawProbabilities},
  {key: "labels", label: "Labels", shown: true, pixels: true, draw: drawLabels},
];
