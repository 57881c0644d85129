// The data block, decoded once: everything in metres from the origin and seconds.

function decodeLane(coded) {
  const lane = {name: coded.name, look: coded.look,
                left: decodeLine(coded.left), centre: decodeLine(coded.centre),
                right: decodeLine(coded.right)};
  lane.area = new Path2D();
  addRing(lane.area, [...lane.right, ...lane.left.slice().reverse()]);
  return lane;
}

function addLine(path, points) {
  points.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
}

function addRing(path, points) {
  addLine(path, points);
  path.closePath();
}

function pathOfLines(lines) {
  const path = new Path2D();
  for (const line of lines) addLine(path, line);
  return path;
}

function pathOfBoxes(boxes) {
  const path = new Path2D();
  for (const [[x0, y0], [x1, y1]] of boxes) path.rect(x0, y0, x1 - x0, y1 - y0);
  return path;
}

/** One area per look, so that neighbours have no seam. */
function areasByLook(lanes) {
  const areas = new Map();
  for (const lane of lanes) {
    if (!areas.has(lane.look)) areas.set(lane.look, new Path2D());
    areas.get(lane.look).addPath(lane.area);
  }
  return areas;
}

function decodeObstacle(coded) {
  return {id: coded.id, kind: coded.kind, length: coded.length, width: coded.width,
          motion: decodeMotion(coded.motion)};
}

function decodePlan(coded) {
  const [s, d, slope, curvature] = coded.start;
  const costs = (one) => one && {...one, costs: one.costs.map((cost) => cost / 1000)};
  return {t: coded.t, line: coded.line, note: coded.note, reason: coded.reason,
          path: decodeLine(coded.path),
          start: {s: s / 1e3, d: d / 1e3, slope: slope / 1e5, curvature: curvature / 1e6},
          chosen: costs(coded.chosen), runner: costs(coded.runner),
          grid: coded.grid && {...coded.grid, causes: decodeRuns(coded.grid.runs)}};
}

/** The plan in force at a time; null before the first. */
function planAt(scene, t) {
  return scene.plans[lastAtOrBefore(scene.planTimes, t + 1e-9)] ?? null;
}

/** Outlines of the vehicle once a second. */
function footprintsOf(drive, vehicle) {
  const path = new Path2D();
  if (drive.t.length === 0) return path;
  for (let t = drive.t[0]; t <= drive.t[drive.t.length - 1]; t += 1) {
    const state = stateAt(drive, t);
    addRing(path, rectangle(state.x, state.y, state.h, vehicle.back, vehicle.front, vehicle.width));
    for (const part of vehicle.parts) addRing(path, placed(state, part));
  }
  return path;
}

/** What the map shows at first: the drive, else the route, else all lanes. */
function homeOf(drivePoints, routeLines, lanes) {
  return boxOf(drivePoints) ?? boxOf(routeLines.flat()) ?? boxOf(lanes.flatMap((l) => l.centre)) ??
      [-10, -10, 10, 10];
}

function decodeScene(data) {
  const lanes = data.lanes.map(decodeLane), drive = decodeMotion(data.drive);
  const drivePoints = drive.x.map((x, i) => [x, drive.y[i]]);
  const routeLines = data.route.map(decodeLine), references = data.references.map(decodeLine);
  const plans = data.plans.map(decodePlan), goal = data.goal ? decodeLine(data.goal)[0] : null;
  return {
    origin: data.origin, vehicle: data.vehicle, lanes, drive, drivePoints,
    goal,
    areas: areasByLook(lanes),
    borders: pathOfLines(lanes.flatMap((lane) => [lane.left, lane.right])),
    centres: pathOfLines(lanes.map((lane) => lane.centre)),
    route: pathOfLines(routeLines), reference: pathOfLines(references),
    lines: references.map((points) => ({points, stations: stationsOf(points)})),
    occupied: pathOfBoxes(data.occupied.map(decodeLine)),
    drivePath: pathOfLines([drivePoints]), footprints: footprintsOf(drive, data.vehicle),
    obstacles: data.obstacles.map(decodeObstacle),
    plans, planTimes: plans.map((plan) => plan.t),
    home: homeOf(drivePoints.concat(goal ? [goal] : []), routeLines, lanes),
  };
}
