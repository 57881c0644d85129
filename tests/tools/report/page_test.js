// Laws of the page's own functions; browser_test.cpp runs them and reads the result.

const failures = [];
let checked = 0;

function expectNear(what, found, expected, tolerance) {
  ++checked;
  if (!(Math.abs(found - expected) <= tolerance)) failures.push(`${what}: ${found}, not ${expected}`);
}

function expectEqual(what, found, expected) {
  ++checked;
  const [a, b] = [JSON.stringify(found), JSON.stringify(expected)];
  if (a !== b) failures.push(`${what}: ${a}, not ${b}`);
}

function testDecoding() {
  expectEqual("a series is the running sum of its steps",
              decodeSeries({scale: 0.5, v: [2, 2, -6]}), [1, 2, -1]);
  expectEqual("a gap does not change the sum", decodeSeries({scale: 1, v: [3, null, 4]}), [3, null, 7]);
  expectEqual("a line is in metres", decodeLine([1000, -2000, 500, 0]), [[1, -2], [1.5, -2]]);
  expectEqual("an empty line has no points", decodeLine([]), []);
}

const MOTION = {t: [0, 1, 3], x: [0, 10, 30], y: [0, 0, 4], h: [0, 0.2, 0.4]};

function testMotion() {
  expectNear("x is linear between rows", stateAt(MOTION, 2).x, 20, 1e-12);
  expectNear("the heading is linear between rows", stateAt(MOTION, 2).h, 0.3, 1e-12);
  expectNear("before the start it stands at the start", stateAt(MOTION, -5).x, 0, 0);
  expectNear("past the end it stands at the end", stateAt(MOTION, 9).y, 4, 0);
  expectNear("one row stands for ever", stateAt({t: [0], x: [7], y: [0], h: [0]}, 3).x, 7, 0);
  expectEqual("a path has both its ends", pathBetween(MOTION, 0.5, 2), [[5, 0], [10, 0], [20, 2]]);
  expectEqual("no path backwards", pathBetween(MOTION, 2, 1), []);
  expectEqual("last at or before", [-0.1, 0, 0.9, 1, 99].map((t) => lastAtOrBefore(MOTION.t, t)),
              [-1, 0, 0, 1, 2]);
  expectEqual("nearest, the earlier of two", [-9, 0.5, 0.6, 2, 2.1].map((t) => nearestTo(MOTION.t, t)),
              [0, 0, 1, 1, 2]);
}

function testRectangle() {
  const [rearRight, frontRight] = rectangle(10, 20, Math.PI / 2, -1, 3, 2);
  expectNear("facing north, right is east", rearRight[0], 11, 1e-12);
  expectNear("facing north, the rear is south", rearRight[1], 19, 1e-12);
  expectNear("facing north, the front is north", frontRight[1], 23, 1e-12);
}

function testView() {
  const view = {x: 5, y: -3, scale: 8, width: 800, height: 600};
  expectEqual("north is up", toScreen(view, [5, -2]), [400, 292]);
  const [x, y] = toWorld(view, toScreen(view, [12.5, 7.25]));
  expectNear("to the screen and back: x", x, 12.5, 1e-12);
  expectNear("to the screen and back: y", y, 7.25, 1e-12);
  const under = toWorld(view, [123, 456]);
  zoomAt(view, [123, 456], 3);
  expectNear("zooming keeps the place under the mouse", toWorld(view, [123, 456])[0], under[0], 1e-9);
  panBy(view, 10, -20);
  expectNear("the map moves with the mouse: x", toWorld(view, [133, 436])[0], under[0], 1e-9);
  expectNear("the map moves with the mouse: y", toWorld(view, [133, 436])[1], under[1], 1e-9);
  fitBox(view, [0, 0, 100, 10], 50);
  expectEqual("a box that fits has its margin", toScreen(view, [0, 5]), [50, 300]);
  expectEqual("a scale bar is round", scaleBarLength({scale: 3}, 140), 20);
  expectEqual("no points, no box", boxOf([]), null);
}

function testClock() {
  const clock = makeClock(0, 20), heard = [];
  clock.listeners.push(({t}) => heard.push(t));
  for (const t of [5, -1, 99, NaN]) seek(clock, t);
  expectEqual("seeking stays within the drive", heard, [5, 0, 20, 0]);
  clock.pace = 2;
  setPlaying(clock, true);
  advance(clock, 3);
  expectNear("twice as fast", clock.t, 6, 1e-12);
  advance(clock, 60);
  expectEqual("it stops at the end", [clock.t, clock.playing], [20, false]);
  setPlaying(clock, true);
  expectEqual("from the end it starts again", clock.t, 0);
  const still = makeClock(0, 0);
  setPlaying(still, true);
  expectEqual("nothing to play", still.playing, false);
}

function testKeys() {
  const clock = {start: 0, end: 20, t: 10}, times = [1, 10, 15];
  const leads = (key, shift) => timeOfKey(clock, key, shift, times);
  expectEqual("arrows", [leads("ArrowLeft", false), leads("ArrowRight", true)], [9.9, 11]);
  expectEqual("ends", [leads("Home"), leads("End")], [0, 20]);
  expectEqual("events", [leads("["), leads("]")], [1, 15]);
  expectEqual("other keys", leads("x"), null);
}

function testFragments() {
  expectEqual("times in fragments",
              ["#t=12.3", "#t=4&follow", "#follow&t=5", "#x=3", "", "#t=abc", "#at=3"].map(timeInFragment),
              [12.3, 4, 5, null, null, null, null]);
  expectEqual("there and back", timeInFragment(fragmentOf(7.25, true)), 7.25);
  expectEqual("round times are short", fragmentOf(10, false), "#t=10");
  expectEqual("following", ["#t=1&follow", "#follow", "#t=1", "#follower"].map(followInFragment),
              [true, true, false, false]);
}

function testPlots() {
  const plot = {unit: "m/s", lower: null, upper: 13.9, t: [0, 1], series: [{values: [8, null]}, {values: [12, 9]}]};
  expectEqual("a gap has no value", rangeOf(plot), [8, 12]);
  expectEqual("a bound that is near is seen", axisRange(plot)[1] > 13.9, true);
  plot.upper = 100;
  expectEqual("a bound that is far is not", axisRange(plot)[1] < 20, true);
  const calm = axisRange({unit: "m", lower: null, upper: null, series: [{values: [1e-9, -1e-9]}]});
  expectEqual("a tremor looks calm", calm[1] - calm[0] > 0.1, true);
  expectEqual("no value at all", rangeOf({series: [{values: [null]}]}), null);
  expectEqual("values", [valueText(null, 1), valueText(-0.0001, 1), valueText(12.345, 10), valueText(-0.0123, 0.02)],
              ["–", "0.00", "12.3", "-0.0123"]);
  expectEqual("axis labels differ", [axisText(0.01, 0.03), axisText(0.012, 0.03), axisText(10, 5)],
              ["0.01", "0.012", "10"]);
}

function testRestlessSeries() {
  const t = Array.from({length: 400}, (_, i) => i / 100), noisy = t.map((at, i) => at + (i % 2 === 0 ? 0.5 : -0.5));
  expectEqual("a noisy series is restless, a slow wave is not", [noisy, t.map((at) => Math.sin(3 * at))].map(isRestless), [true, false]);
  const course = smoothed(t, noisy, 0.5);
  expectNear("its course is what it was before the noise", course[200], 2, 0.01);
  expectEqual("a gap stays one", smoothed([0, 1, 2], [1, null, 3], 0.1), [1, null, 3]);
  const lines = linesOfPlot({t, series: [{name: "a", values: noisy}, {name: "b", values: t}]});
  expectEqual("it is pale below its course", lines.map(({name, ink, isPale}) => [name, ink, isPale]),
              [["a", 0, true], ["b", 1, false], ["a, smoothed", 0, false]]);
}

function testStrip() {
  const decisions = [{from: 0, to: 2, state: "a"}, {from: 2, to: 5, state: "b"}, {from: 5, to: 6, state: "a"}];
  const numbers = numberStates(decisions);
  const ofDrives = ["cruise", "follow", "pass", "emergency", "stop", "yield", "a", "b"];
  const ofAudits = ["clear", "conflict", "unknown", "undecided", "a", "b"];
  for (const states of [ofDrives, ofAudits]) {
    expectEqual("one number per state", new Set(states.map((s) => numbers.get(s))).size, states.length);
  }
  expectEqual("known states keep theirs", numberStates([{state: "stop"}]).get("stop"), numbers.get("stop"));
  expectEqual("decision in force", [1, 2, 6, 7].map((t) => decisionAt(decisions, t)?.state ?? "none"),
              ["a", "b", "a", "none"]);
  expectEqual("ticks are round and few", [9, 40, 61, 300].map(tickStep), [1, 5, 10, 50]);
}

function testTexts() {
  expectEqual("short texts stay", shortened("abc", 3), "abc");
  expectEqual("long texts end in an ellipsis, letters stay whole", shortened("😀😀😀😀", 3), "😀😀…");
}

function testHypotheses() {
  const st = decodeSt({drive: [0, 500, 950], parts: [1, 0, 2000, 2600, 1, 1, 2300, 2900, -1, 1, 3000, 4000]});
  expectEqual("distances are in metres", [st.drive, st.parts[0]], [[0, 5, 9.5], {obstacle: 1, step: 0, from: 20, to: 26}]);
  const rings = ringsOfParts(st.parts);
  expectEqual("parts of one obstacle join over time, those of others do not", rings.map((one) => one.obstacle), [1, -1]);
  expectEqual("up one side, down the other", rings[0].points, [[0, 20], [0.5, 23], [0.5, 29], [0, 26]]);
  expectEqual("what is there once lasts for half a step", rings[1].points.map(([t]) => t), [0.375, 0.625, 0.625, 0.375]);
  const far = ringsOfParts([{obstacle: 1, step: 0, from: 0, to: 5}, {obstacle: 1, step: 1, from: 60, to: 65}]);
  expectEqual("what is somewhere else is another part", far.length, 2);
  const {t, s} = rangesOfSt(st);
  expectEqual("all of the drive is shown", [t[0] <= 0 && t[1] >= 1, s[0] <= 0 && s[1] >= 9.5], [true, true]);
  const axes = axesOfSt(400, 240, {t: [0, 5], s: [0, 50]});
  expectNear("later is to the right", axes.x(5) - axes.x(0), 400 - 44 - 10, 1e-9);
  expectNear("farther is up", axes.y(0) - axes.y(50), 240 - 8 - 30, 1e-9);
}

function testCycle() {
  expectEqual("runs of causes", decodeRuns([2, 5, 1, 0]), [5, 5, 0]);
  const start = {s: 10, d: 0.5, slope: 0.1, curvature: -0.02}, d = quintic(start, -1.5, 20), h = 1e-4;
  expectNear("a candidate begins at its start", d(0), 0.5, 1e-12);
  expectNear("with its slope", (d(h) - d(-h)) / (2 * h), 0.1, 1e-7);
  expectNear("and its curvature", (d(h) - 2 * d(0) + d(-h)) / (h * h), -0.02, 1e-5);
  expectNear("it ends at its end state", d(20), -1.5, 1e-12);
  expectNear("level", (d(20 + h) - d(20 - h)) / (2 * h), 0, 1e-7);
  const points = [[0, 0], [10, 0], [10, 10]], line = {points, stations: stationsOf(points)};
  expectEqual("stations are lengths", line.stations, [0, 10, 20]);
  expectEqual("left of a line that goes north is west", pointBeside(line, 15, 2), [8, 5]);
  expectEqual("past the end it goes straight on", pointBeside(line, 25, 0), [10, 15]);
  const grid = {d: [-1, 1, 3], l: [15, 30, 2]};
  expectEqual("d is fastest", endOf(grid, 4), {d: 0, l: 30});
}

for (const test of [testDecoding, testMotion, testRectangle, testView, testClock, testKeys, testFragments,
                    testPlots, testRestlessSeries, testStrip, testTexts, testHypotheses, testCycle]) {
  try {
    test();
  } catch (error) {
    failures.push(`${test.name}: ${error}`);
  }
}
document.body.textContent = failures.length === 0 ? `all ${checked} hold` : failures.join("\n");
