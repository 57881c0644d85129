// The data block, decoded once into flat arrays: metres from the map's origin.

const LEFT = 0, CENTRE = 1, RIGHT = 2;  // the three lines of a lane

function decodeLanes(coded, unit) {
  const lanes = {count: coded.count, names: coded.names, types: coded.types, texts: coded.texts,
                 lines: linesOf(coded.lines, unit), rings: linesOf(coded.rings, unit)};
  for (const key of ["type", "drivable", "level", "oneWay", "plain"]) lanes[key] = Uint8Array.from(numbersOf(coded[key]));
  for (const key of ["participants", "attributes", "left", "right"]) lanes[key] = Int32Array.from(numbersOf(coded[key]));
  for (const key of ["road", "junction"]) lanes[key] = Int32Array.from(sumsOf(coded[key]), (n) => n - 1);
  for (const key of ["successors", "predecessors", "speeds", "marks"]) lanes[key] = listsOf(coded[key]);
  lanes.line = sumsOf(coded.line);
  lanes.heights = sumsOf(coded.heights);
  lanes.roadFrom = sumsOf(coded.roadFrom);
  lanes.roadTo = sumsOf(coded.roadTo);
  let ring = 0, height = 0, onRoad = 0;
  lanes.ringOf = new Int32Array(lanes.count);
  lanes.heightFrom = new Uint32Array(lanes.count);
  lanes.onRoad = new Uint32Array(lanes.count);
  for (let i = 0; i < lanes.count; ++i) {
    lanes.ringOf[i] = lanes.plain[i] ? -1 : ring++;
    lanes.heightFrom[i] = height;
    height += pointCount(lanes, i, CENTRE);
    lanes.onRoad[i] = onRoad;
    onRoad += lanes.road[i] >= 0 ? 1 : 0;
  }
  lanes.boxes = boxesOfLanes(lanes);
  lanes.width = meanWidths(lanes);
  return lanes;
}

function pointCount(lanes, i, line) {
  return lanes.lines.starts[3 * i + line + 1] - lanes.lines.starts[3 * i + line];
}

/** Index into `lanes.lines.xy` of the first coordinate of a lane's line, and one past its last. */
function rangeOfLine(lanes, i, line) {
  return [2 * lanes.lines.starts[3 * i + line], 2 * lanes.lines.starts[3 * i + line + 1]];
}

function boxesOfLanes(lanes) {
  const boxes = new Float64Array(4 * lanes.count), {xy} = lanes.lines;
  for (let i = 0; i < lanes.count; ++i) {
    let x0 = Infinity, y0 = Infinity, x1 = -Infinity, y1 = -Infinity;
    for (let k = rangeOfLine(lanes, i, LEFT)[0]; k < rangeOfLine(lanes, i, RIGHT)[1]; k += 2) {
      x0 = Math.min(x0, xy[k]); x1 = Math.max(x1, xy[k]);
      y0 = Math.min(y0, xy[k + 1]); y1 = Math.max(y1, xy[k + 1]);
    }
    boxes.set([x0, y0, x1, y1], 4 * i);
  }
  return boxes;
}

/** Distances between the borders' middles, for lines that stand for whole lanes. */
function meanWidths(lanes) {
  const widths = new Float32Array(lanes.count), {xy, starts} = lanes.lines;
  for (let i = 0; i < lanes.count; ++i) {
    const middle = (line) => 2 * ((starts[3 * i + line] + starts[3 * i + line + 1]) >> 1);
    const a = middle(LEFT), b = middle(RIGHT);
    widths[i] = Math.min(8, Math.hypot(xy[a] - xy[b], xy[a + 1] - xy[b + 1]));
  }
  return widths;
}

/** The lane's outline, counter-clockwise: [x0, y0, x1, y1, …]. */
function ringOf(lanes, i) {
  if (lanes.ringOf[i] >= 0) {
    const ring = lanes.ringOf[i], {xy, starts} = lanes.rings;
    return xy.subarray(2 * starts[ring], 2 * starts[ring + 1]);
  }
  const {xy} = lanes.lines, [l0, l1] = rangeOfLine(lanes, i, LEFT), [r0, r1] = rangeOfLine(lanes, i, RIGHT);
  const ring = new Float64Array(l1 - l0 + r1 - r0);
  ring.set(xy.subarray(r0, r1));
  for (let k = l1 - 2, at = r1 - r0; k >= l0; k -= 2, at += 2) {
    ring[at] = xy[k];
    ring[at + 1] = xy[k + 1];
  }
  return ring;
}

/** A neighbour: its lane, and what may be done; null where there is none. */
function neighbourOf(coded, lane) {
  if (coded === 0) return null;
  return {lane: lane + Math.floor(coded / 4), sameDirection: (coded & 2) !== 0, changeAllowed: (coded & 1) !== 0};
}

function successorsOf(lanes, i) {
  return listAt(lanes.successors, i).map((step) => i + step);
}

function predecessorsOf(lanes, i) {
  return listAt(lanes.predecessors, i).map((step) => i + step);
}

/** [[from s, limit in m/s or null, infinite: there is none], …] */
function speedsOf(lanes, i) {
  const limits = [], {starts, values} = lanes.speeds;
  // Two numbers each, but counted once.
  for (let k = starts[i]; k < starts[i + 1]; ++k) {
    const limit = values[2 * k + 1];
    limits.push([values[2 * k] / 1000, limit === 0 ? null : limit < 0 ? Infinity : (limit - 1) / 1000]);
  }
  return limits;
}

/** [[from s, type, yellow], …] of the left or right border. */
function marksOf(lanes, i, isRight) {
  const marks = [], {starts, values} = lanes.marks, list = 2 * i + (isRight ? 1 : 0);
  for (let k = starts[list]; k < starts[list + 1]; ++k) {
    marks.push([values[2 * k] / 1000, values[2 * k + 1] >> 1, (values[2 * k + 1] & 1) !== 0]);
  }
  return marks;
}

/** The least limit of a lane in m/s; null if none is known. */
function leastSpeed(lanes, i) {
  const known = speedsOf(lanes, i).map(([, limit]) => limit).filter(Number.isFinite);
  return known.length > 0 ? Math.min(...known) : null;
}

/** Lengths along a lane's line up to each of its points. */
function stationsOfLine(lanes, i, line) {
  const {xy} = lanes.lines, [from, to] = rangeOfLine(lanes, i, line), stations = [0];
  for (let k = from + 2; k < to; k += 2) {
    stations.push(stations[stations.length - 1] + Math.hypot(xy[k] - xy[k - 2], xy[k + 1] - xy[k - 1]));
  }
  return stations;
}

function lengthOf(lanes, i) {
  const stations = stationsOfLine(lanes, i, CENTRE);
  return stations[stations.length - 1];
}

/** Heights of a lane's centreline [m], one per point. */
function heightsOf(lanes, i) {
  const from = lanes.heightFrom[i];
  return Array.from(lanes.heights.subarray(from, from + pointCount(lanes, i, CENTRE)), (z) => z / 1000);
}

/** The greatest rise along a lane, up or down. */
function steepest(lanes, i) {
  const stations = stationsOfLine(lanes, i, CENTRE), heights = heightsOf(lanes, i);
  let most = 0;
  for (let k = 1; k < stations.length; ++k) {
    const run = stations[k] - stations[k - 1];
    if (run > 0.5 || stations.length === 2) most = Math.max(most, Math.abs(heights[k] - heights[k - 1]) / Math.max(run, 1e-3));
  }
  return most;
}

function decodeRoads(coded, unit) {
  return {ids: coded.ids, names: coded.names, junction: Int32Array.from(sumsOf(coded.junction), (n) => n - 1),
          lengths: Array.from(numbersOf(coded.lengths), (mm) => mm / 1000),
          references: linesOf(coded.references, unit), roadS: sumsOf(coded.roadS).map((s) => s / 1e4)};
}

/** Things with lines of their own: line or ring i belongs to entry i. */
function withPoints(list, coded, unit) {
  const lines = linesOf(coded, unit);
  return list.map((one, i) => ({...one, points: pointsAt(lines, i)}));
}

function decodeAreas(coded, unit) {
  const rings = linesOf(coded.rings, unit);
  let next = 0;
  return coded.list.map((area) => {
    const own = [];
    for (let k = 0; k < area.rings; ++k) own.push(pointsAt(rings, next++));
    return {...area, rings: own};
  });
}

/** Every line of a list. */
function allLines(coded, unit) {
  const lines = linesOf(coded, unit);
  return Array.from({length: lines.starts.length - 1}, (_, i) => pointsAt(lines, i));
}

function decodeMap(data) {
  const {unit} = data;
  const map = {
    file: data.file, format: data.format, crs: data.crs, origin: data.origin, box: data.box,
    lonLat: data.lonLat, remarksTitle: data.remarksTitle, remarks: data.remarks, lines: data.lines,
    hiddenRules: new Set(),
    lanes: decodeLanes(data.lanes, unit), roads: decodeRoads(data.roads, unit),
    junctions: data.junctions, signals: data.signals, regulations: data.regulations,
    objects: withPoints(data.objects.list, data.objects.outlines, unit),
    stopLines: withPoints(data.stopLines.list, data.stopLines.lines, unit),
    areas: decodeAreas(data.areas, unit),
    overlays: data.overlays.map((one) => ({...one, shown: true, lines: allLines(one.lines, unit),
                                           rings: allLines(one.rings, unit), boxes: allLines(one.boxes, unit)})),
  };
  map.grid = makeGrid(map.lanes.boxes, map.lanes.count);
  map.laneNumbers = new Map(map.lanes.names.map((name, i) => [name, i]));
  return map;
}
