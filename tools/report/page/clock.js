// The one time of the page: everybody who listens hears of a change, whoever made it.

function makeClock(start, end) {
  return {start, end, t: start, playing: false, pace: 1, listeners: []};
}

function tell(clock) {
  for (const listener of clock.listeners) listener(clock);
}

function seek(clock, t) {
  const finite = Number.isFinite(t) ? t : clock.start;
  clock.t = Math.min(clock.end, Math.max(clock.start, finite));
  tell(clock);
}

function setPlaying(clock, playing) {
  clock.playing = playing && clock.end > clock.start;
  if (clock.playing && clock.t >= clock.end) clock.t = clock.start;
  tell(clock);
}

/** Moves on by `seconds` of real time; stops at the end. */
function advance(clock, seconds) {
  const t = clock.t + seconds * clock.pace;
  if (t >= clock.end) clock.playing = false;
  seek(clock, t);
}

function playOn(clock) {
  let last = null;
  const frame = (now) => {
    if (clock.playing && last !== null) advance(clock, Math.min(0.25, (now - last) / 1000));
    last = clock.playing ? now : null;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

/** Time in a fragment such as "#t=12.3"; null if there is none. */
function timeInFragment(fragment) {
  const found = /(?:^#|&)t=(-?\d+(?:\.\d+)?)(?:&|$)/.exec(fragment);
  return found ? Number(found[1]) : null;
}

/** Whether a fragment such as "#t=12.3&follow" asks to follow the vehicle. */
function followInFragment(fragment) {
  return /[#&]follow(?:&|$)/.test(fragment);
}

function fragmentOf(t, follow) {
  return "#t=" + t.toFixed(2).replace(/\.?0+$/, "") + (follow ? "&follow" : "");
}

/** Where a key leads from time `t`; null if it is not a key of the clock. */
function timeOfKey(clock, key, shift, eventTimes) {
  const step = shift ? 1 : 0.1;
  if (key === "ArrowLeft") return clock.t - step;
  if (key === "ArrowRight") return clock.t + step;
  if (key === "Home") return clock.start;
  if (key === "End") return clock.end;
  if (key === "]") return eventTimes.find((t) => t > clock.t + 1e-6) ?? clock.end;
  if (key === "[") return eventTimes.findLast((t) => t < clock.t - 1e-6) ?? clock.start;
  return null;
}
