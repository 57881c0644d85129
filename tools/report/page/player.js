// The bar of time: play button, clock, decisions, events, needle, and the keys.

const STATE_INKS = 8;

function makePlayer(data, page) {
  const {clock} = page;
  page.events = data.events;
  page.decisions = data.decisions;
  showStrip(page);
  showMarks(page);
  showTicks(page);
  watchTrack(page);
  watchControls(page);
  watchKeys(page);
  watchSeekLinks(page);
  clock.listeners.push(() => showTime(page));
}

/** Share of the drive's time, 0 … 1. */
function shareOf(clock, t) {
  return clock.end > clock.start ? (t - clock.start) / (clock.end - clock.start) : 0;
}

function percent(share) {
  return (100 * share).toFixed(3) + "%";
}

// These have the same colours in every report, the states of drives and the verdicts of audits;
// others follow in order of appearance.
const KNOWN_STATES = new Map([
  ["cruise", 0], ["follow", 1], ["pass", 2], ["emergency", 3], ["stop", 4], ["yield", 5],
  ["clear", 2], ["conflict", 3], ["unknown", 5], ["undecided", 6],
]);
const FIRST_FREE = 7;

/** The same number for the same state. */
function numberStates(decisions) {
  const numbers = new Map(KNOWN_STATES);
  for (const {state} of decisions) {
    if (!numbers.has(state)) numbers.set(state, FIRST_FREE + numbers.size - KNOWN_STATES.size);
  }
  return numbers;
}

function showStrip(page) {
  const numbers = numberStates(page.decisions);
  for (const decision of page.decisions) {
    const piece = addText(element("strip"), "span", "", decision.state);
    const from = shareOf(page.clock, decision.from);
    piece.style.left = percent(from);
    piece.style.width = percent(shareOf(page.clock, decision.to) - from);
    piece.dataset.ink = numbers.get(decision.state) % STATE_INKS;
    piece.title = `${round(decision.from)} s: ${decision.state}. ${decision.reason}`;
  }
  element("strip").hidden = page.decisions.length === 0;
}

const MARK_SHAPES = {info: "●", warning: "▲", fault: "✖"};

function showMarks(page) {
  for (const event of page.events) {
    const mark = addText(element("marks"), "button", "mark " + event.severity,
                         MARK_SHAPES[event.severity]);
    mark.type = "button";
    mark.tabIndex = -1;
    mark.style.left = percent(shareOf(page.clock, event.t));
    mark.title = `${round(event.t)} s: ${event.text}`;
    mark.addEventListener("click", () => seek(page.clock, event.t));
  }
  element("marks").hidden = page.events.length === 0;
}

/** Step of 1, 2, 5 × 10ⁿ s with at most about ten ticks. */
function tickStep(span) {
  const power = Math.pow(10, Math.floor(Math.log10(span / 10)));
  return [1, 2, 5, 10].map((n) => n * power).find((step) => span / step <= 10);
}

function showTicks(page) {
  const {start, end} = page.clock;
  if (!(end > start)) return;
  const step = tickStep(end - start);
  for (let n = Math.ceil(start / step); n * step <= end + 1e-9; ++n) {
    const tick = addText(element("ticks"), "span", "", String(round(n * step)));
    tick.style.left = percent(shareOf(page.clock, n * step));
  }
}

function watchTrack(page) {
  const track = element("track");
  const go = (event) => {
    const box = track.getBoundingClientRect();
    seek(page.clock, page.clock.start + ((event.clientX - box.left) / box.width) *
        (page.clock.end - page.clock.start));
  };
  track.addEventListener("pointerdown", (event) => {
    if (event.target.classList.contains("mark")) return;
    track.setPointerCapture(event.pointerId);
    go(event);
  });
  track.addEventListener("pointermove", (event) => {
    if (track.hasPointerCapture(event.pointerId)) go(event);
  });
  track.addEventListener("pointerup", () => writeFragment(page));
  element("needle").setAttribute("aria-valuemin", page.clock.start);
  element("needle").setAttribute("aria-valuemax", page.clock.end);
}

function watchControls(page) {
  const {clock} = page;
  element("play").addEventListener("click", () => togglePlaying(page));
  element("pace").addEventListener("change", (event) => (clock.pace = Number(event.target.value)));
  element("link").addEventListener("click", () => copyLink(page));
  element("player").hidden = clock.end <= clock.start;
  window.addEventListener("hashchange", () => {
    const t = timeInFragment(location.hash);
    if (t !== null) seek(clock, t);
  });
}

function togglePlaying(page) {
  setPlaying(page.clock, !page.clock.playing);
  if (!page.clock.playing) writeFragment(page);
}

function writeFragment(page) {
  history.replaceState(null, "", fragmentOf(page.clock.t, page.map.follow));
}

async function copyLink(page) {
  writeFragment(page);
  const told = element("link");
  try {
    await navigator.clipboard.writeText(location.href);
    told.textContent = "Copied";
  } catch {
    told.textContent = "In the address bar";
  }
  setTimeout(() => (told.textContent = "Link"), 1500);
}

function watchSeekLinks(page) {
  document.addEventListener("click", (event) => {
    const link = event.target.closest("[data-t]");
    if (!link) return;
    event.preventDefault();
    seek(page.clock, Number(link.dataset.t));
    writeFragment(page);
  });
}

/** Whether a key belongs to what has the focus, as the arrows to a list of choices. */
function keyIsTaken(event) {
  const tag = event.target.tagName;
  if (event.ctrlKey || event.altKey || event.metaKey || tag === "SELECT") return true;
  return event.key === " " && (tag === "BUTTON" || tag === "SUMMARY" || tag === "INPUT" || tag === "A");
}

/** Arrows are the clock's. */
function mapKey(page, key) {
  if (key === "f" || key === "F") return setFollow(page.map, !page.map.follow), true;
  return !key.startsWith("Arrow") && keyOfStage(page.map.stage, key);
}

function watchKeys(page) {
  const times = page.events.map((event) => event.t);
  document.addEventListener("keydown", (event) => {
    if (keyIsTaken(event)) return;
    const t = timeOfKey(page.clock, event.key, event.shiftKey, times);
    if (t !== null) seek(page.clock, t);
    else if (event.key === " ") togglePlaying(page);
    else if (!mapKey(page, event.key)) return;
    event.preventDefault();
  });
}

function decisionAt(decisions, t) {
  return decisions.findLast((one) => one.from <= t + 1e-9 && t <= one.to + 1e-9) ?? null;
}

function showTime(page) {
  const {clock} = page, decision = decisionAt(page.decisions, clock.t);
  element("clock").textContent = `${clock.t.toFixed(2)} s`;
  element("play").textContent = clock.playing ? "❚❚" : "▶";
  element("play").setAttribute("aria-label", clock.playing ? "Pause" : "Play");
  element("needle").style.left = percent(shareOf(clock, clock.t));
  element("needle").setAttribute("aria-valuenow", clock.t.toFixed(2));
  const state = element("state");
  state.replaceChildren();
  if (decision) {
    addText(state, "b", "", decision.state);
    state.append(" " + (planAt(page.map.scene, clock.t)?.reason || decision.reason));
  }
}
