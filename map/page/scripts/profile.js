// Heights along a lane, or along the lanes of a route.

/** [[s, z], …] along pieces of lanes that follow each other. */
function profileOf(lanes, pieces) {
  const points = [];
  let before = 0;
  for (const {lane, from, to} of pieces) {
    const stations = stationsOfLine(lanes, lane, CENTRE), heights = heightsOf(lanes, lane);
    const heightAt = (s) => {
      const n = Math.min(Math.max(stations.findLastIndex((one) => one <= s), 0), stations.length - 2);
      const share = (s - stations[n]) / (stations[n + 1] - stations[n] || 1);
      return heights[n] + Math.min(Math.max(share, 0), 1) * (heights[n + 1] - heights[n]);
    };
    for (const s of [from, ...stations.filter((s) => s > from && s < to), to]) points.push([before + s - from, heightAt(s)]);
    before += to - from;
  }
  return points;
}

function svgElement(parent, tag, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  parent.append(made);
  return made;
}

function drawProfile(box, points, title) {
  const [wide, high, left, top, bottom] = [320, 110, 44, 8, 20], length = points.at(-1)[0];
  const zs = points.map(([, z]) => z), low = Math.min(...zs), rise = Math.max(Math.max(...zs) - low, 1);
  const x = (s) => left + (wide - left - 8) * s / Math.max(length, 1e-9), y = (z) => high - bottom - (high - top - bottom) * (z - low) / rise;
  const figure = document.createElement("figure"), svg = svgElement(figure, "svg", {viewBox: `0 0 ${wide} ${high}`, role: "img", "aria-label": title});
  for (const z of [low, low + rise]) {
    svgElement(svg, "line", {x1: left, x2: wide - 8, y1: y(z), y2: y(z), class: "grid"});
    svgElement(svg, "text", {x: left - 5, y: y(z) + 4, "text-anchor": "end"}).textContent = z.toFixed(1) + " m";
  }
  svgElement(svg, "path", {d: points.map(([s, z], n) => `${n ? "L" : "M"}${x(s).toFixed(1)} ${y(z).toFixed(1)}`).join(""), class: "line"});
  svgElement(svg, "text", {x: left, y: high - 5}).textContent = "0";
  svgElement(svg, "text", {x: wide - 8, y: high - 5, "text-anchor": "end"}).textContent = `${length.toFixed(0)} m`;
  addText(figure, "figcaption", "", title);
  box.append(figure);
}

function lengthOfPieces(pieces) {
  return pieces.reduce((sum, {from, to}) => sum + to - from, 0);
}

/** The elevation of the selected lane, or along a route. */
function showProfile(page, box) {
  const {selection, map} = page, {kind, index} = selection;
  if (kind === "lane") {
    const whole = [{lane: index, from: 0, to: lengthOf(map.lanes, index)}];
    drawProfile(box, profileOf(map.lanes, whole), "Elevation along the lane");
  } else if (kind === "overlays" && map.overlays[index].kind === "route") {
    drawProfile(box, profileOf(map.lanes, map.overlays[index].pieces), "Elevation along the route");
  }
}
