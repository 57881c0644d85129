// Diagrams over time: zoomed together, one cursor, a click goes to its moment.

const LINE_INKS = ["plot-1", "plot-2", "plot-3", "plot-4"];
const MOST_TURNS = 15;   // how often a quiet series may go through its range
const COURSE_S = 0.5;
const LEAST_SPANS = {"1/m": 0.004, "rad": 0.01, "m": 0.1};

function decodePlot(coded) {
  return {title: coded.title, unit: coded.unit, lower: coded.lower, upper: coded.upper,
          t: decodeSeries(coded.t),
          series: coded.series.map((one) => ({name: one.name, values: decodeSeries(one)}))};
}

/** Smallest and largest finite value; null if there is none. */
function rangeOf(plot) {
  let low = Infinity, high = -Infinity;
  for (const {values} of plot.series) {
    for (const value of values) {
      if (value === null) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  return low <= high ? [low, high] : null;
}

/** Whether a series goes up and down all the time, as what a noisy sensor says does. */
function isRestless(values) {
  const known = values.filter((value) => value !== null), range = Math.max(...known) - Math.min(...known);
  const way = known.reduce((sum, value, i) => sum + (i > 0 ? Math.abs(value - known[i - 1]) : 0), 0);
  return known.length > 100 && way > MOST_TURNS * range;
}

/** The mean of a series within `reach` before and after each time. */
function smoothed(t, values, reach) {
  const sums = [0], counts = [0];
  for (const value of values) {
    sums.push(sums.at(-1) + (value ?? 0));
    counts.push(counts.at(-1) + (value === null ? 0 : 1));
  }
  let from = 0, to = 0;
  return t.map((now, i) => {
    while (t[from] < now - reach) ++from;
    while (to < t.length && t[to] <= now + reach) ++to;
    const count = counts[to] - counts[from];
    return values[i] === null || count === 0 ? null : (sums[to] - sums[from]) / count;
  });
}

/** The lines of a plot: a restless series is pale and thin, with its course over it. */
function linesOfPlot(plot) {
  const lines = plot.series.map(({name, values}, i) => ({name, values, ink: i, isPale: isRestless(values)}));
  const courses = lines.filter(({isPale}) => isPale).map((line) => (
      {...line, name: line.name + ", smoothed", values: smoothed(plot.t, line.values, COURSE_S), isPale: false}));
  return [...lines, ...courses];
}

/** What the axis shows: all values, a bound that they come near, and never a mere tremor. */
function axisRange(plot) {
  let [low, high] = rangeOf(plot) ?? [0, 1];
  if (plot.upper !== null && high > 0.4 * plot.upper) high = Math.max(high, plot.upper);
  if (plot.lower !== null && low < 0.4 * plot.lower) low = Math.min(low, plot.lower);
  const missing = (LEAST_SPANS[plot.unit] ?? 0.5) - (high - low);
  if (missing > 0) [low, high] = [low - missing / 2, high + missing / 2];
  const margin = 0.08 * (high - low);
  return [low - margin, high + margin];
}

function boundText({lower, upper, unit}) {
  if (lower !== null && upper !== null) return `${lower} … ${upper} ${unit}`;
  if (upper !== null) return `≤ ${upper} ${unit}`;
  return lower !== null ? `≥ ${lower} ${unit}` : "";
}

/** Value with as many digits as its plot's scale deserves. */
function valueText(value, span) {
  if (value === null || value === undefined) return "–";
  const digits = Math.min(5, Math.max(1, 2 - Math.floor(Math.log10(Math.max(span, 1e-6)))));
  return fixedText(value, digits);
}

/** Digits after the point; zero has no sign. */
function fixedText(value, digits) {
  return value.toFixed(digits).replace(/^-(0\.?0*)$/, "$1");
}

/** Label of an axis: as many digits as tell neighbouring labels apart. */
function axisText(value, span) {
  const digits = Math.min(6, Math.max(0, Math.ceil(1 - Math.log10(span))));
  return String(Number(value.toFixed(digits)));
}

function addText(parent, tag, name, text) {
  const child = document.createElement(tag);
  child.className = name;
  child.textContent = text;
  parent.append(child);
  return child;
}

function layOutPlot(plot) {
  const figure = document.createElement("figure"), caption = document.createElement("figcaption");
  figure.append(caption);
  addText(caption, "b", "", plot.title);
  addText(caption, "span", "unit", plot.unit);
  plot.readouts = plot.series.map((one, i) => {
    const item = addText(caption, "span", "series", one.name + " ");
    item.style.setProperty("--line", `var(--${LINE_INKS[i % LINE_INKS.length]})`);
    return addText(item, "output", "", "");
  });
  if (boundText(plot) !== "") addText(caption, "span", "bound", "bound " + boundText(plot));
  plot.box = document.createElement("div");
  plot.box.className = "plot";
  figure.append(plot.box);
  element("plots").append(figure);
}

function shadeBounds(plot, ctx, area, graph, ink) {
  ctx.fillStyle = ink("beyond");
  ctx.strokeStyle = ink("bound");
  ctx.setLineDash([5, 3]);
  for (const [bound, edge] of [[plot.upper, area.y], [plot.lower, area.y + area.h]]) {
    if (bound === null) continue;
    const y = Math.min(area.y + area.h, Math.max(area.y, graph.toDomYCoord(bound)));
    ctx.fillRect(area.x, Math.min(y, edge), area.w, Math.abs(edge - y));
    if (y <= area.y || y >= area.y + area.h) continue;
    ctx.beginPath();
    ctx.moveTo(area.x, y);
    ctx.lineTo(area.x + area.w, y);
    ctx.stroke();
  }
  ctx.setLineDash([]);
}

function plotOptions(plot, page) {
  const ink = (name) => inkOf(page.map.stage, name), [low, high] = axisRange(plot);
  return {
    labels: ["t", ...plot.lines.map((line) => line.name)],
    colors: plot.lines.map((line) => ink(LINE_INKS[line.ink % LINE_INKS.length]) + (line.isPale ? "50" : "")),
    series: Object.fromEntries(plot.lines.filter((line) => line.isPale).map((line) => [line.name, {strokeWidth: 0.8}])),
    legend: "never", strokeWidth: 1.6, highlightCircleSize: 3,
    valueRange: [low, high], dateWindow: [page.clock.start, page.clock.end],
    gridLineColor: ink("grid"), axisLineColor: ink("grid"), axisLabelFontSize: 11,
    rightGap: 8, connectSeparatedPoints: false,
    axes: {y: {axisLabelWidth: 46, pixelsPerLabel: 20,
               axisLabelFormatter: (value) => axisText(value, high - low)},
           x: {axisLabelFormatter: (t) => `${round(t)} s`}},
    underlayCallback: (ctx, area, graph) => shadeBounds(plot, ctx, area, graph, ink),
    highlightCallback: (_, t) => hover(page, t),
    unhighlightCallback: () => hover(page, null),
    clickCallback: (_, t) => seek(page.clock, t),
    drawCallback: () => placeCursors(page),
  };
}

function round(t) {
  return Number(t.toFixed(2));
}

function rowsOf(plot) {
  return plot.t.map((t, i) => [t, ...plot.lines.map((line) => line.values[i])]);
}

function drawPlot(plot, page) {
  plot.lines = linesOfPlot(plot);
  plot.graph = new Dygraph(plot.box, rowsOf(plot), plotOptions(plot, page));
  plot.cursor = addText(plot.box, "div", "cursor", "");
}

function makePlots(coded, page) {
  page.plots = coded.map(decodePlot).filter((plot) => plot.t.length > 0);
  page.plots.forEach(layOutPlot);  // all of them first: they share the height
  page.plots.forEach((plot) => drawPlot(plot, page));
  new ResizeObserver(() => page.plots.forEach(({graph}) => graph.resize())).observe(element("plots"));
  if (page.plots.length > 1) {
    Dygraph.synchronize(page.plots.map((plot) => plot.graph), {selection: true, zoom: true, range: false});
  }
  page.clock.listeners.push(() => showPlots(page));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => recolour(page));
}

function recolour(page) {
  for (const plot of page.plots) {
    const {colors, gridLineColor, axisLineColor} = plotOptions(plot, page);
    plot.graph.updateOptions({colors, gridLineColor, axisLineColor});
  }
}

function hover(page, t) {
  page.map.ghost = t;
  redraw(page.map.stage);
  showPlots(page);
}

/** Values at the hovered time, else at the page's time. */
function showPlots(page) {
  const t = page.map.ghost ?? page.clock.t;
  for (const plot of page.plots) {
    const [low, high] = axisRange(plot), row = nearestTo(plot.t, t);
    plot.readouts.forEach((output, i) => {
      output.textContent = valueText(plot.series[i].values[row], high - low);
    });
  }
  placeCursors(page);
}

function placeCursors(page) {
  for (const {graph, cursor} of page.plots ?? []) {
    if (!graph || !cursor) continue;
    const x = graph.toDomXCoord(page.clock.t), area = graph.getArea();
    cursor.hidden = !(x >= area.x - 0.5 && x <= area.x + area.w + 0.5);
    cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
  }
}
