// What others hide from the vehicle, as the planner looks past them (planning/obstacles/visibility).

const SIGHT_M = 120;  // shadows are drawn so far

/** Where its two mirrors are. */
function eyesOf(pen) {
  const {vehicle, drive} = pen.scene;
  const along = vehicle.back + 0.75 * (vehicle.front - vehicle.back);
  return placed(stateAt(drive, pen.t), [[along, vehicle.width / 2], [along, -vehicle.width / 2]]);
}

/** Counter-clockwise, so that shadows on one another fill. */
function turnedLeft(ring) {
  let area = 0;
  ring.forEach(([x, y], i) => {
    const [nextX, nextY] = ring[(i + 1) % ring.length];
    area += x * nextY - nextX * y;
  });
  return area < 0 ? ring.reverse() : ring;
}

/** From the two corners that bound a body, as it is seen from an eye, as far as is drawn. */
function shadowOf(corners, [x, y]) {
  const middle = Math.atan2(corners[0][1] + corners[2][1] - 2 * y, corners[0][0] + corners[2][0] - 2 * x);
  const aside = corners.map((corner) => {
    const angle = Math.atan2(corner[1] - y, corner[0] - x) - middle;
    return {corner, angle: Math.atan2(Math.sin(angle), Math.cos(angle))};
  }).sort((a, b) => a.angle - b.angle);
  const [first, last] = [aside[0], aside.at(-1)];
  const far = [0, 0.25, 0.5, 0.75, 1].map((share) => {
    const angle = middle + last.angle + share * (first.angle - last.angle);
    return [x + SIGHT_M * Math.cos(angle), y + SIGHT_M * Math.sin(angle)];
  });
  return turnedLeft([first.corner, last.corner, ...far]);
}

/** Whether the planner knows of others only what it sees. */
function foresees(scene) {
  return scene.plans.some((plan) => plan.foreseen.length > 0);
}

function shadowsFrom(eye, bodies) {
  const path = new Path2D();
  for (const corners of bodies) addRing(path, shadowOf(corners, eye));
  return path;
}

/** Hidden is what neither of the mirrors sees. */
function drawHidden(pen) {
  const {ctx, scene} = pen;
  if (!foresees(scene)) return;
  const bodies = scene.obstacles.filter((one) => knownAt(one, pen.t)).map((one) => {
    const {x, y, h} = stateAt(one.motion, pen.t);
    return rectangle(x, y, h, -one.length / 2, one.length / 2, one.width);
  });
  const [left, right] = eyesOf(pen);
  ctx.save();
  ctx.clip(shadowsFrom(left, bodies));
  ctx.fillStyle = pen.ink("hidden");
  ctx.fill(shadowsFrom(right, bodies));
  ctx.restore();
}
