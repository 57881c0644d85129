// The part of the plane that the canvas shows: its centre [m], pixels per metre, size in pixels.

function makeView() {
  return {x: 0, y: 0, scale: 10, width: 1, height: 1};
}

function toScreen(view, [x, y]) {
  return [view.width / 2 + (x - view.x) * view.scale, view.height / 2 - (y - view.y) * view.scale];
}

function toWorld(view, [px, py]) {
  return [view.x + (px - view.width / 2) / view.scale, view.y - (py - view.height / 2) / view.scale];
}

/** Zooms so that the place under a pixel stays there. */
function zoomAt(view, pixel, factor) {
  const before = toWorld(view, pixel);
  view.scale = Math.min(400, Math.max(0.0005, view.scale * factor));
  const after = toWorld(view, pixel);
  view.x += before[0] - after[0];
  view.y += before[1] - after[1];
}

function panBy(view, dx, dy) {
  view.x -= dx / view.scale;
  view.y += dy / view.scale;
}

/** Smallest box around points; null if there are none. */
function boxOf(points) {
  if (points.length === 0) return null;
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of points) {
    box[0] = Math.min(box[0], x); box[1] = Math.min(box[1], y);
    box[2] = Math.max(box[2], x); box[3] = Math.max(box[3], y);
  }
  return box;
}

/** Shows the whole box with `margin` pixels around it. */
function fitBox(view, box, margin) {
  view.x = (box[0] + box[2]) / 2;
  view.y = (box[1] + box[3]) / 2;
  const wide = Math.max(view.width - 2 * margin, 20), high = Math.max(view.height - 2 * margin, 20);
  view.scale = Math.min(wide / Math.max(box[2] - box[0], 1), high / Math.max(box[3] - box[1], 1), 60);
}

/** The longest of 1, 2, 5 × 10ⁿ metres that is at most `longest` pixels. */
function scaleBarLength(view, longest) {
  const metres = longest / view.scale;
  const power = Math.pow(10, Math.floor(Math.log10(metres)));
  return [5, 2, 1].map((n) => n * power).find((length) => length <= metres);
}
