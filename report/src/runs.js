// Figures of runs, from their records. Pure functions.

/** Seconds of refinement: virtual on simulated ranks. */
export const secondsOf = (record) => record.cluster?.seconds ?? record.work?.seconds ?? null;

export const idealOf = (record) => record.cluster?.ideal_seconds ?? null;

export const movesOf = (record) => record.cluster?.moves ?? [];

/** The mean share of their time that ranks were idle; null without ranks. */
export function idleOf(record) {
  const ranks = record.parts?.ranks ?? [];
  let idle = 0, all = 0;
  for (const { seconds } of ranks) {
    idle += seconds.idle;
    for (const part of Object.values(seconds)) all += part;
  }
  return all > 0 ? idle / all : null;
}

/** What the time of ranks is spent on, as records name it. */
export const kindsOfTime = ["computing", "sending", "polling", "balancing", "idle"];

/** The mean seconds of all ranks for each kind: {kind, seconds}; nothing without ranks. */
export function rankMeans(record) {
  const ranks = record.parts?.ranks ?? [];
  if (ranks.length === 0) return [];
  return kindsOfTime.map((kind) => ({ kind, seconds: ranks.reduce((sum, r) => sum + (r.seconds[kind] ?? 0), 0) / ranks.length }));
}

/** The number of ranks. */
export const ranksOf = (record, trace) => record.parts?.ranks?.length || busyIntervals(trace).reduce((most, b) => Math.max(most, b.rank + 1), 0);

/** The keys that differ between runs, in the order in which they were swept. */
export function sweptKeys(records) {
  const keys = [];
  for (const record of records)
    for (const key of Object.keys(record.swept ?? {})) if (!keys.includes(key)) keys.push(key);
  return keys.filter((key) => new Set(records.map((r) => JSON.stringify(r.swept?.[key]))).size > 1);
}

const word = (value) => (typeof value === "string" ? value : JSON.stringify(value));

/** One row for each run: {run, settings, seconds, ideal, ...swept keys as words or numbers}. */
export function rowsOf(runs) {
  const keys = sweptKeys(runs.map((r) => r.record));
  return runs.map(({ record, name }, run) => {
    const swept = keys.map((key) => record.swept?.[key]);
    const value = (v) => (typeof v === "number" ? v : v === undefined ? "" : word(v));
    return { run, name, seconds: secondsOf(record), ideal: idealOf(record), triangles: record.mesh?.triangles ?? null,
      moves: movesOf(record).length, messages: record.cluster?.messages ?? null, idle: idleOf(record), keys: swept.map(value) };
  });
}

/** When each rank worked: its slices, joined where the gap between them is too short to be seen. */
export function busyIntervals(trace) {
  const slices = (trace?.traceEvents ?? []).filter((e) => e.ph === "X" && e.name === "refine");
  slices.sort((a, b) => a.tid - b.tid || a.ts - b.ts);
  const end = slices.reduce((last, e) => Math.max(last, e.ts + e.dur), 0);
  const intervals = [];
  for (const { tid, ts, dur, args } of slices) {
    const last = intervals[intervals.length - 1];
    if (last && last.rank === tid && ts - last.stop < end / 2000) {
      last.stop = ts + dur;
      last.triangles = args?.triangles ?? last.triangles;
    } else {
      intervals.push({ rank: tid, start: ts, stop: ts + dur, triangles: args?.triangles });
    }
  }
  return intervals.map((i) => ({ ...i, start: i.start / 1e6, stop: i.stop / 1e6 }));
}

/** Plans and rejections with their moments: {rank, time, what, plan, moves}. A look that finds the load even is none. */
export function plansOf(trace) {
  return (trace?.traceEvents ?? []).filter((e) => e.ph === "i" && e.cat === "balance" && /^(plan|advice):/.test(e.name))
    .map(({ tid, ts, name, args }) => ({ rank: tid, time: ts / 1e6, what: name,
      plan: args.verdict === "done" ? "made" : "rejected", moves: args.moves.filter((m) => m.verdict === "done").length }))
    .filter(({ what }) => what !== "plan: no moves");
}

/** What is left to do on the ranks over time: {time, least, mean, most} at `samples` times. */
export function loadOverTime(trace, samples = 200) {
  const byRank = new Map();
  let end = 0;
  for (const e of trace?.traceEvents ?? []) {
    if (e.ph !== "X" || e.name !== "refine" || e.args?.to_be_made === undefined) continue;
    if (!byRank.has(e.tid)) byRank.set(e.tid, []);
    byRank.get(e.tid).push([e.ts + e.dur, e.args.to_be_made]);
    end = Math.max(end, e.ts + e.dur);
  }
  const ranks = [...byRank.values()].map((steps) => steps.sort((a, b) => a[0] - b[0]));
  const place = ranks.map(() => 0);
  const load = [];
  for (let k = 0; k <= samples && ranks.length > 0; ++k) {
    const time = (end * k) / samples;
    const left = ranks.map((steps, r) => {
      while (place[r] + 1 < steps.length && steps[place[r] + 1][0] <= time) ++place[r];
      return steps[place[r]][1];
    });
    load.push({ time: time / 1e6, least: Math.min(...left), most: Math.max(...left),
      mean: left.reduce((a, b) => a + b) / left.length });
  }
  return load;
}

/** The rank of each subdomain at a time: subdomains that are on their way belong to their receiver. */
export function ownersAt(record, time) {
  const owners = Uint32Array.from(record.cluster.owners_before);
  for (const move of movesOf(record)) if (move.left <= time) owners[move.subdomain] = move.to;
  return owners;
}
