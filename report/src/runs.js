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
export const ranksOf = (record, timeline) => record.parts?.ranks?.length || busyIntervals(timeline).reduce((most, b) => Math.max(most, b.rank + 1), 0);

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

/** When each rank worked: {rank, start, stop, triangles}. */
export const busyIntervals = (timeline) =>
  (timeline?.busy ?? []).map(([rank, start, stop, triangles]) => ({ rank, start, stop, triangles }));

/** The rank of each subdomain at a time: subdomains that are on their way belong to their receiver. */
export function ownersAt(record, time) {
  const owners = Uint32Array.from(record.cluster.owners_before);
  for (const move of movesOf(record)) if (move.left <= time) owners[move.subdomain] = move.to;
  return owners;
}
