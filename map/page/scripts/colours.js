// What the colours of lanes say. A scheme has a class for each lane and a colour for each class.

const GROUND_OF_TYPE = {sidewalk: "walk", biking: "cycle", shoulder: "shoulder", parking: "parking", stop: "parking",
                        border: "verge", curb: "kerb", median: "verge", restricted: "verge", none: "verge",
                        tram: "rail", rail: "rail", bus: "bus", taxi: "bus", roadworks: "works", roadWorks: "works"};

function byType(map) {
  const {lanes} = map;
  return {
    label: "type",
    classOf: (i) => {
      const type = lanes.types[lanes.type[i]];
      if (lanes.drivable[i]) return lanes.junction[i] >= 0 ? "junction" : "drive";
      return GROUND_OF_TYPE[type] ?? "other";
    },
    names: {drive: "driving", junction: "driving, in a junction", walk: "sidewalk", cycle: "cycling", shoulder: "shoulder",
            parking: "parking, stop", verge: "border, median, none", kerb: "kerb", rail: "rails", bus: "bus, taxi",
            works: "road works", other: "other"},
  };
}

const SPEEDS = [[8.4, "up to 30 km/h"], [14, "up to 50"], [19.6, "up to 70"], [28, "up to 100"], [Infinity, "above"]];

function bySpeed(map) {
  const names = {unknown: "not known"};
  SPEEDS.forEach(([, name], k) => (names["scale-" + k] = name));
  return {
    label: "speed limit",
    classOf: (i) => {
      const limit = leastSpeed(map.lanes, i);
      return limit === null ? "unknown" : "scale-" + SPEEDS.findIndex(([most]) => limit <= most);
    },
    names,
  };
}

const SLOPES = [[0.01, "up to 1 %"], [0.03, "up to 3 %"], [0.06, "up to 6 %"], [0.1, "up to 10 %"], [Infinity, "above"]];

function bySlope(map) {
  const names = {};
  SLOPES.forEach(([, name], k) => (names["scale-" + k] = name));
  return {
    label: "slope",
    classOf: (i) => "scale-" + SLOPES.findIndex(([most]) => steepest(map.lanes, i) <= most),
    names,
  };
}

/** Groups of drivable lanes that links and lane changes join, the largest first. */
function componentsOf(lanes) {
  const parent = Int32Array.from({length: lanes.count}, (_, i) => i);
  const find = (i) => {
    while (parent[i] !== i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const join = (i, j) => (lanes.drivable[i] && lanes.drivable[j] ? (parent[find(i)] = find(j)) : null);
  for (let i = 0; i < lanes.count; ++i) {
    for (const j of successorsOf(lanes, i)) join(i, j);
    for (const side of [lanes.left, lanes.right]) {
      const to = neighbourOf(side[i], i);
      if (to && to.sameDirection && to.changeAllowed) join(i, to.lane);
    }
  }
  const sizes = new Map();
  for (let i = 0; i < lanes.count; ++i) if (lanes.drivable[i]) sizes.set(find(i), (sizes.get(find(i)) ?? 0) + 1);
  const ranks = new Map([...sizes].sort((a, b) => b[1] - a[1] || a[0] - b[0]).map(([root], rank) => [root, rank]));
  return {rankOf: (i) => ranks.get(find(i)), sizes: [...sizes.values()].sort((a, b) => b - a)};
}

function byConnectivity(map) {
  const {lanes} = map, components = componentsOf(lanes);
  const names = {dead: "leads nowhere", lone: "joined with nothing", other: "cannot be driven"};
  components.sizes.slice(0, 5).forEach((size, rank) => (names["part-" + rank] = `part ${rank + 1}: ${size} lanes`));
  if (components.sizes.length > 5) names["part-5"] = `${components.sizes.length - 5} smaller parts`;
  return {
    label: "connectivity",
    classOf: (i) => {
      if (!lanes.drivable[i]) return "other";
      const to = lanes.successors, from = lanes.predecessors, rank = components.rankOf(i);
      const ends = to.starts[i] === to.starts[i + 1];
      if (ends && from.starts[i] === from.starts[i + 1] && components.sizes[rank] === 1) return "lone";
      return ends ? "dead" : "part-" + Math.min(rank, 5);
    },
    names,
  };
}

const SCHEMES = {type: byType, speed: bySpeed, connectivity: byConnectivity, slope: bySlope};

/** Classes of all lanes: numbers into `keys`, and how many lanes each has. */
function classify(map, key) {
  const scheme = SCHEMES[key](map), keys = Object.keys(scheme.names), numbers = new Map(keys.map((name, k) => [name, k]));
  const classes = new Uint8Array(map.lanes.count), counts = new Array(keys.length).fill(0);
  for (let i = 0; i < map.lanes.count; ++i) {
    classes[i] = numbers.get(scheme.classOf(i));
    ++counts[classes[i]];
  }
  return {key, label: scheme.label, keys, names: scheme.names, classes, counts};
}
