// The data block, decoded once: everything in metres from the origin and seconds.

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
          hypotheses: coded.hypotheses.map((one) => ({...one, st: one.st && decodeSt(one.st)})),
          foreseen: coded.foreseen.map((one) => ({...one, points: decodeLine(one.points)})),
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

/** Lines of an overlay of the map, in the scene's coordinates. */
function linesOfOverlay({overlays}, kind, [x0, y0]) {
  return overlays.filter((one) => one.kind === kind).flatMap((one) => one.lines).map((line) => line.map(([x, y]) => [x - x0, y - y0]));
}

/** What is shown at first: the drive, else the route, else the whole map. */
function homeOf(drivePoints, routeLines, box, [x0, y0]) {
  return boxOf(drivePoints) ?? boxOf(routeLines.flat()) ?? [box[0] - x0, box[1] - y0, box[2] - x0, box[3] - y0];
}

/** @param mapData of the page of a map, in its own coordinates: those of the scene and `shift` */
function decodeScene(data, mapData) {
  const map = decodeMap(mapData), shift = data.origin.map((value, axis) => value - map.origin[axis]);
  map.colouring = classify(map, "type");
  const drive = decodeMotion(data.drive), drivePoints = drive.x.map((x, i) => [x, drive.y[i]]);
  const plans = data.plans.map(decodePlan), goal = data.goal ? decodeLine(data.goal)[0] : null;
  return {
    map, shift, origin: data.origin, vehicle: data.vehicle, drive, drivePoints, goal,
    lines: linesOfOverlay(map, "reference", shift).map((points) => ({points, stations: stationsOf(points)})),
    drivePath: pathOfLines([drivePoints]), footprints: footprintsOf(drive, data.vehicle),
    obstacles: data.obstacles.map(decodeObstacle),
    plans, planTimes: plans.map((plan) => plan.t),
    home: homeOf(drivePoints.concat(goal ? [goal] : []), linesOfOverlay(map, "route", shift), map.box, shift),
  };
}
