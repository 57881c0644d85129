// Longitude and latitude, by the polynomials of map/page/lon_lat_fit.h.

function chebyshev(u, terms) {
  const values = [1, u];
  while (values.length < terms) values.push(2 * u * values.at(-1) - values.at(-2));
  return values;
}

/** [longitude, latitude] in degrees of a place in the map; null where the system is not known. */
function lonLatOf(fit, [x, y]) {
  if (!fit) return null;
  const [x0, y0, x1, y1] = fit.box, {terms} = fit;
  const u = chebyshev((2 * x - x0 - x1) / (x1 - x0), terms), v = chebyshev((2 * y - y0 - y1) / (y1 - y0), terms);
  let longitude = 0, latitude = 0;
  for (let i = 0; i < terms; ++i) {
    for (let j = 0; j < terms; ++j) {
      longitude += fit.longitude[i * terms + j] * u[i] * v[j];
      latitude += fit.latitude[i * terms + j] * u[i] * v[j];
    }
  }
  return [longitude, latitude];
}

/** The place in the map of a longitude and latitude, by Newton's method; null if it is far outside. */
function placeOfLonLat(fit, [longitude, latitude]) {
  if (!fit) return null;
  const [x0, y0, x1, y1] = fit.box, step = 1;
  let x = (x0 + x1) / 2, y = (y0 + y1) / 2;
  for (let round = 0; round < 30; ++round) {
    const [lon, lat] = lonLatOf(fit, [x, y]), [lonX, latX] = lonLatOf(fit, [x + step, y]);
    const [lonY, latY] = lonLatOf(fit, [x, y + step]), a = lonX - lon, b = lonY - lon, c = latX - lat, d = latY - lat;
    const det = a * d - b * c, east = longitude - lon, north = latitude - lat;
    const dx = (d * east - b * north) / det, dy = (a * north - c * east) / det;
    x += dx;
    y += dy;
    if (!(Math.abs(x - x0) < 5 * (x1 - x0) && Math.abs(y - y0) < 5 * (y1 - y0))) return null;
    if (Math.hypot(dx, dy) < 1e-7) break;
  }
  return x >= x0 && x <= x1 && y >= y0 && y <= y1 ? [x, y] : null;
}
