// The planning cycle in force: why each end state was rejected, and what the chosen one costs.

/** Causes of a grid, one per end state, d fastest. */
function decodeRuns(runs) {
  const causes = [];
  for (let i = 0; i + 1 < runs.length; i += 2) {
    for (let k = 0; k < runs[i]; ++k) causes.push(runs[i + 1]);
  }
  return causes;
}

/** Quintic d(l) from a start {d, slope, curvature} to d_e, level, at l_e. */
function quintic(start, endD, endL) {
  const T = endL, c0 = start.d, c1 = start.slope, c2 = start.curvature / 2;
  const h = endD - c0 - c1 * T - c2 * T * T, v = -c1 - 2 * c2 * T, a = -2 * c2;
  const c3 = (10 * h - 4 * v * T + a * T * T / 2) / T ** 3;
  const c4 = (-15 * h + 7 * v * T - a * T * T) / T ** 4;
  const c5 = (6 * h - 3 * v * T + a * T * T / 2) / T ** 5;
  return (l) => c0 + l * (c1 + l * (c2 + l * (c3 + l * (c4 + l * c5))));
}

/** Lengths along a line up to each of its points. */
function stationsOf(points) {
  const stations = [];
  points.forEach(([x, y], i) => stations.push(
      i === 0 ? 0 : stations[i - 1] + Math.hypot(x - points[i - 1][0], y - points[i - 1][1])));
  return stations;
}

/** The point d beside a line at a station of it. */
function pointBeside(line, s, d) {
  const {points, stations} = line;
  const i = Math.min(Math.max(lastAtOrBefore(stations, s), 0), points.length - 2);
  const length = stations[i + 1] - stations[i], [ax, ay] = points[i], [bx, by] = points[i + 1];
  const ux = (bx - ax) / length, uy = (by - ay) / length, along = s - stations[i];
  return [ax + along * ux - d * uy, ay + along * uy + d * ux];
}

/** End state number i of a grid. */
function endOf(grid, i) {
  const at = ([least, most, count], k) => count > 1 ? least + (most - least) * k / (count - 1) : least;
  return {d: at(grid.d, i % grid.d[2]), l: at(grid.l, Math.floor(i / grid.d[2]))};
}

function candidatePoints(line, plan, end) {
  const points = [], steps = 12, d = quintic(plan.start, end.d, end.l);
  for (let k = 0; k <= steps; ++k) {
    const l = end.l * k / steps;
    points.push(pointBeside(line, plan.start.s + l, d(l)));
  }
  return points;
}

/** Some of a grid's candidates, by cause: the shortest, the middle and the longest, every fifth d. */
function shownCandidates(line, plan) {
  const shown = [], {grid} = plan, rows = grid.l[2], lanes = grid.d[2];
  for (const row of new Set([0, rows >> 1, rows - 1])) {
    for (let lane = 0; lane < lanes; lane += 5) {
      const i = row * lanes + lane;
      shown.push({cause: grid.causes[i], points: candidatePoints(line, plan, endOf(grid, i))});
    }
  }
  return shown;
}

function causeInk(cause) {
  return `--cause-${cause}`;
}

/** The heat map: d to the left as on the road, l upwards. */
function drawGrid(canvas, plan) {
  const {grid, chosen} = plan, [lanes, rows] = [grid.d[2], grid.l[2]];
  const style = getComputedStyle(document.documentElement);
  canvas.width = 4 * lanes;
  canvas.height = 6 * rows;
  const ctx = canvas.getContext("2d");
  grid.causes.forEach((cause, i) => {
    ctx.fillStyle = style.getPropertyValue(causeInk(cause));
    ctx.fillRect(4 * (lanes - 1 - i % lanes), 6 * (rows - 1 - Math.floor(i / lanes)), 4, 6);
  });
  if (!chosen) return;
  const x = (1 - (chosen.d - grid.d[0]) / (grid.d[1] - grid.d[0])) * (canvas.width - 4) + 2;
  const y = (1 - (chosen.l - grid.l[0]) / (grid.l[1] - grid.l[0])) * (canvas.height - 6) + 3;
  ctx.strokeStyle = style.getPropertyValue("--text");
  ctx.lineWidth = 2;
  ctx.strokeRect(x - 5, y - 5, 10, 10);
}

function addBar(row, cost, largest, kind) {
  const cell = document.createElement("td"), bar = document.createElement("span");
  bar.className = "bar " + kind;
  bar.style.width = `${largest > 0 ? 100 * cost / largest : 0}%`;
  cell.append(bar, cost.toFixed(3));
  row.append(cell);
}

function costTable(names, plan) {
  const all = [plan.chosen, plan.runner].filter((one) => one !== null);
  const largest = Math.max(...all.flatMap((one) => one.costs));
  const table = document.createElement("table"), head = table.insertRow();
  table.className = "costs";
  for (const text of ["cost", "chosen", ...(plan.runner ? ["runner-up"] : [])]) addText(head, "th", "", text);
  names.forEach((name, i) => {
    const row = table.insertRow();
    addText(row, "th", "", name.replaceAll("_", " "));
    all.forEach((one, k) => addBar(row, one.costs[i], largest, k === 0 ? "chosen" : "runner"));
  });
  return table;
}

function causeLegend(names, grid) {
  const legend = document.createElement("ul");
  names.forEach((name, cause) => {
    const count = grid.causes.filter((one) => one === cause).length;
    if (count === 0) return;
    const item = addText(legend, "li", "", `${name === "none" ? "feasible" : name.replaceAll("_", " ")}: ${count}`);
    item.style.setProperty("--swatch", `var(${causeInk(cause)})`);
  });
  return legend;
}

/** Shows the cycle in force where it is another than before. */
function showCycle(page, names) {
  const plan = planAt(page.map.scene, page.clock.t), box = element("cycle");
  if (plan === page.shownPlan) return;
  page.shownPlan = plan;
  box.replaceChildren();
  box.hidden = !plan || !(plan.grid || plan.chosen || plan.hypotheses.length > 0);
  if (box.hidden) return;
  if (plan.hypotheses.length > 0) {
    const [table, figure, draw] = hypothesesBox(page, plan);
    box.append(...[table, figure].filter(Boolean));
    draw?.();
  }
  if (plan.grid) {
    const figure = document.createElement("figure"), canvas = document.createElement("canvas");
    canvas.className = "grid";
    drawGrid(canvas, plan);
    const [d, l] = [plan.grid.d, plan.grid.l].map(([least, most]) => `${least.toFixed(1)} … ${most.toFixed(1)} m`);
    figure.append(canvas);
    addText(figure, "figcaption", "", `End states: d ${d} from right to left, l ${l} upwards`);
    figure.append(causeLegend(names.causes, plan.grid));
    box.append(figure);
  }
  // A path through knots was not among the candidates, and has no costs.
  if (plan.chosen?.costs.some((cost) => cost !== 0)) box.append(costTable(names.costs, plan));
}
