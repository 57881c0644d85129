// Starts the page: one clock, and all that listens to it.

/** First and last time of the drive, else of the plots. */
function timesOf(scene, plots) {
  const all = [scene.drive.t, ...plots.map((plot) => decodeSeries(plot.t))].filter((t) => t.length > 0);
  if (all.length === 0) return [0, 0];
  const ranged = scene.drive.t.length > 0 ? all.slice(0, 1) : all;
  return [Math.min(...ranged.map((t) => t[0])), Math.max(...ranged.map((t) => t[t.length - 1]))];
}

function addReading(list, name, value) {
  addText(list, "dt", "", name);
  addText(list, "dd", "", value);
}

/** The vehicle's state at the page's time, beside the map. */
function showState(page) {
  const hud = element("hud"), {drive} = page.map.scene;
  hud.replaceChildren();
  if (drive.t.length === 0) return void (hud.textContent = "No drive");
  const state = stateAt(drive, page.clock.t), list = document.createElement("dl");
  addReading(list, "speed", `${state.v.toFixed(2)} m/s (${(3.6 * state.v).toFixed(0)} km/h)`);
  addReading(list, "acceleration", `${fixedText(state.a, 2)} m/s²`);
  addReading(list, "steering", `${fixedText(state.steering * 180 / Math.PI, 1)}°`);
  const plan = planAt(page.map.scene, page.clock.t);
  if (plan && plan.note !== "") addReading(list, "plan", plan.note);
  hud.append(list);
}

/** Lets the map be as high as the window leaves room below the head. */
function watchHead() {
  const head = document.querySelector("header");
  new ResizeObserver(() => {
    document.documentElement.style.setProperty("--head", head.offsetHeight + "px");
  }).observe(head);
}

/** A drive along the page has a map that is low and wide, with the plots below it; many plots stand in two columns. */
function chooseShape({home: [x0, y0, x1, y1]}, plots) {
  const shape = x1 - x0 > 3 * (y1 - y0) ? "along" : plots.length > 4 ? "many" : "";
  document.querySelector("main").className = shape;
}

function start() {
  const [data, mapData] = ["data", "map_data"].map((id) => JSON.parse(element(id).textContent)), scene = decodeScene(data, mapData);
  const clock = makeClock(...timesOf(scene, data.plots));
  const page = {clock, map: makeMap(scene, clock), plots: []};
  chooseShape(scene, data.plots);
  watchHead();
  makePlots(data.plots, page);
  makePlayer(data, page);
  clock.listeners.push(() => showState(page));
  const showPlan = () => showCycle(page, {costs: data.costNames, causes: data.causeNames});
  clock.listeners.push(showPlan);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    page.shownPlan = undefined;  // drawn anew, in other colours
    showPlan();
  });
  setFollow(page.map, followInFragment(location.hash));
  seek(clock, timeInFragment(location.hash) ?? clock.start);
  playOn(clock);
  document.documentElement.dataset.ready = "yes";
}
