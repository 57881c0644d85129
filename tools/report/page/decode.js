// The data block stores numbers as differences of integers; these functions undo that.

/** Running sums of `codes` times `scale`; null is a gap and does not change the sum. */
function decodeSeries(coded) {
  let sum = 0;
  return coded.v.map((step) => (step === null ? null : (sum += step) * coded.scale));
}

/** Points [[x, y], …] in metres from the origin, out of [x0, y0, dx1, dy1, …] in millimetres. */
function decodeLine(codes) {
  const points = [];
  let x = 0, y = 0;
  for (let i = 0; i + 1 < codes.length; i += 2) {
    x += codes[i];
    y += codes[i + 1];
    points.push([x / 1000, y / 1000]);
  }
  return points;
}

/** Every field of a motion as an array of its own: {t, x, y, h, …}. */
function decodeMotion(coded) {
  const motion = {};
  for (const field of Object.keys(coded)) motion[field] = decodeSeries(coded[field]);
  return motion;
}
