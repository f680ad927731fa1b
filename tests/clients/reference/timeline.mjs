// Transition states over time: T as one Float64Array (one share a vertex) a source.

const EASES = {
  linear: (u) => u,
  step: (u) => (u < 1 ? 0 : 1),
  smoothstep: (u) => u * u * (3 - 2 * u),
  cubic: (u) => (u < 0.5 ? 4 * u ** 3 : 1 - (2 - 2 * u) ** 3 / 2),
};

/** The shares written as a source's name, or as {name: share, ...}. */
export function readShares(written, sourceNames) {
  const byName = typeof written === 'string' ? { [written]: 1 } : written;
  for (const name of Object.keys(byName))
    if (!sourceNames.includes(name)) throw new Error(`no source "${name}"`);
  return sourceNames.map((name) => byName[name] ?? 0);
}

/**
 * The recipe's timeline with all times resolved.
 *
 * @param fields  d of every region, by name
 */
export function readTimeline(recipe, sourceNames, fields, vertexCount) {
  const written = recipe.timeline ?? {};
  const everywhere = new Float64Array(vertexCount);
  const readEdit = (edit) => ({
    to: readShares(edit.to, sourceNames), amount: edit.amount ?? 1,
    d: edit.region === undefined ? everywhere : fields[edit.region] });
  const times = trackTimes(written.tracks ?? []);
  const tracks = (written.tracks ?? []).map((track) =>
    ({ ...readEdit(track), ...times(track), ease: EASES[track.ease ?? 'smoothstep'] }));
  const states = {};
  for (const [name, state] of Object.entries(recipe.states ?? {}))
    states[name] = { mix: readShares(state.mix, sourceNames), edits: (state.edits ?? []).map(readEdit) };
  const readState = (name) => states[name] ?? { mix: readShares(name, sourceNames), edits: [] };
  const keys = (written.keys ?? []).map((key) =>
    ({ time: key.time, T: evaluateState(readState(key.state), vertexCount), ease: EASES[key.ease ?? 'linear'] }));
  const start = readShares(written.start ?? sourceNames[0], sourceNames);
  const lastEvent = Math.max(0, ...tracks.map((track) => track.end), ...keys.map((key) => key.time));
  return { tracks, keys, vertexCount, fps: written.fps ?? 30,
    start, rest: keys.length ? readState(written.keys[0].state).mix : start,
    duration: Math.max(lastEvent, written.duration ?? 0),
    stateNamed: (name) => ({ T: evaluateState(readState(name), vertexCount), rest: readState(name).mix }) };
}

/** A track without a name is called after its region, or its source. */
const nameOf = (track) => track.name ?? track.region ?? track.to;

/** Resolves `begin` and `end` of tracks that refer to each other. */
function trackTimes(tracks) {
  const named = (name) => {
    const track = tracks.find((candidate) => nameOf(candidate) === name);
    if (!track) throw new Error(`no track "${name}"`);
    return times(track);
  };
  const times = (track) => {
    const { begin: written = 0 } = track;
    let begin = written;
    if (written.after !== undefined) begin = named(written.after).end + (written.delay ?? 0);
    if (written.with !== undefined) begin = named(written.with).begin + (written.delay ?? 0);
    return { begin, end: track.end ?? begin + track.duration };
  };
  return times;
}

const uniform = (shares, vertexCount) => shares.map((share) => new Float64Array(vertexCount).fill(share));

/** T <- (1 - a (1 - d)) T + a (1 - d) S (eq. 7 with an amount a). */
function applyEdit(T, { to, d }, amount) {
  T.forEach((row, s) => {
    for (let i = 0; i < row.length; i++) {
      const w = amount * (1 - d[i]);
      row[i] = (1 - w) * row[i] + w * to[s];
    }
  });
}

function evaluateState(state, vertexCount) {
  const T = uniform(state.mix, vertexCount);
  for (const edit of state.edits) applyEdit(T, edit, edit.amount);
  return T;
}

function progress({ begin, end, ease }, t) {
  if (begin === end) return t < end ? 0 : 1;
  return ease(Math.min(1, Math.max(0, (t - begin) / (end - begin))));
}

/** T(t). */
export function transitionAt(timeline, t) {
  if (timeline.keys.length) return betweenKeys(timeline.keys, t);
  const T = uniform(timeline.start, timeline.vertexCount);
  for (const track of timeline.tracks) applyEdit(T, track, track.amount * progress(track, t));
  return T;
}

function betweenKeys(keys, t) {
  const next = keys.findIndex((key) => key.time > t);
  if (next < 0) return keys.at(-1).T;
  if (next === 0) return keys[0].T;
  const [from, to] = [keys[next - 1], keys[next]];
  const u = progress({ begin: from.time, end: to.time, ease: to.ease }, t);
  return from.T.map((row, s) => row.map((share, i) => (1 - u) * share + u * to.T[s][i]));
}

/** Which vertices keep the shares of the start's mix over the whole timeline. */
export function findUntouched(timeline) {
  return untouchedIn(timeline, timeline.rest, eventTimes(timeline).map((t) => transitionAt(timeline, t)));
}

/** Which vertices have the shares `rest` in all of `states`. */
export function untouchedIn({ vertexCount }, rest, states) {
  const untouched = new Array(vertexCount).fill(true);
  for (const T of states)
    T.forEach((row, s) => {
      // Mixing a share with itself may change its last bit.
      row.forEach((share, i) => { if (Math.abs(share - rest[s]) > 1e-12) untouched[i] = false; });
    });
  return untouched;
}

/** Between two events each ease is monotone, so their times and middles show every change. */
function eventTimes({ tracks, keys, duration }) {
  const events = [0, duration, ...tracks.flatMap(({ begin, end }) => [begin, end]), ...keys.map((key) => key.time)]
    .filter((t) => t >= 0 && t <= duration).sort((a, b) => a - b);
  return events.flatMap((t, i) => (i ? [(t + events[i - 1]) / 2, t] : [t]));
}
