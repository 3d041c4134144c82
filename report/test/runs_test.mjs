// node --test runs_test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";
import * as runs from "../src/runs.js";

const slice = (tid, ts, dur, left) => ({ ph: "X", name: "refine", tid, ts, dur, args: { triangles: 1, to_be_made: left } });
const ranks = (...idle) => idle.map((i) => ({ seconds: { computing: 1 - i, idle: i } }));

test("keys that differ are those swept, in their order", () => {
  const records = [{ swept: { b: 1, a: "x", c: 5 } }, { swept: { b: 2, a: "x", c: 5 } }, { swept: { b: 2, a: "y", c: 5 } }];
  assert.deepEqual(runs.sweptKeys(records), ["b", "a"]);
  assert.deepEqual(runs.sweptKeys([{}, {}]), []);
});

test("slices join where the gap between them cannot be seen, on one rank", () => {
  const trace = { traceEvents: [slice(1, 0, 1e6, 9), slice(0, 0, 400000, 8), slice(0, 400100, 100000, 7), slice(0, 900000, 100000, 0)] };
  assert.deepEqual(runs.busyIntervals(trace).map((i) => [i.rank, i.start, i.stop]),
    [[0, 0, 0.5001], [0, 0.9, 1], [1, 0, 1]]);
  assert.deepEqual(runs.busyIntervals(null), []);
});

test("plans are told from looks, and what was made from what was rejected", () => {
  const noted = (name, verdict, moves) => ({ ph: "i", cat: "balance", name: `${name}: ${verdict}`, tid: 3, ts: 5e5, args: { verdict, moves } });
  const moves = [{ verdict: "done" }, { verdict: "needless" }];
  const trace = { traceEvents: [slice(0, 0, 1, 1), noted("load", "even"), noted("plan", "no moves", []), noted("plan", "done", moves),
    noted("plan", "small saving", moves), noted("advice", "done", moves)] };
  assert.deepEqual(runs.plansOf(trace).map((p) => [p.rank, p.time, p.plan, p.moves]),
    [[3, 0.5, "made", 1], [3, 0.5, "rejected", 1], [3, 0.5, "made", 1]]);
  assert.deepEqual(runs.plansOf(null), []);
});

test("what is left over time is that of each rank's last slice", () => {
  const trace = { traceEvents: [slice(0, 0, 50, 10), slice(0, 50, 50, 0), slice(1, 0, 100, 4)] };
  const load = runs.loadOverTime(trace, 2);
  assert.deepEqual(load.map((l) => [l.least, l.mean, l.most]), [[4, 7, 10], [4, 7, 10], [0, 2, 4]]);
});

test("a subdomain belongs to its receiver from the moment at which it leaves", () => {
  const record = { cluster: { owners_before: [0, 0, 1], moves: [{ subdomain: 1, from: 0, to: 1, left: 2, arrived: 3 },
    { subdomain: 1, from: 1, to: 2, left: 5, arrived: 6 }] } };
  assert.deepEqual([...runs.ownersAt(record, 1.9)], [0, 0, 1]);
  assert.deepEqual([...runs.ownersAt(record, 2)], [0, 1, 1]);
  assert.deepEqual([...runs.ownersAt(record, 9)], [0, 2, 1]);
});

test("idle is a share of all time of all ranks", () => {
  assert.equal(runs.idleOf({ parts: { ranks: ranks(0, 0.5) } }), 0.25);
  assert.equal(runs.idleOf({}), null);
});

test("a row has the settings and figures of its run", () => {
  const record = (policy, seconds) => ({ swept: { policy }, cluster: { seconds, ideal_seconds: 1, moves: [{}] }, mesh: { triangles: 7 },
    parts: { ranks: ranks(0.1) } });
  const rows = runs.rowsOf([{ name: "a", record: record("none", 3) }, { name: "b", record: record("greedy", 2) }]);
  assert.deepEqual(rows[1], { run: 1, name: "b", seconds: 2, ideal: 1, triangles: 7, moves: 1, messages: null, idle: 0.1, keys: ["greedy"] });
});

test("means of ranks are those of each kind of time", () => {
  const record = { parts: { ranks: ranks(0.25, 0.75) } };
  assert.deepEqual(runs.rankMeans(record).map((m) => m.seconds), [0.5, 0, 0, 0, 0.5]);
  assert.deepEqual(runs.rankMeans({}), []);
  assert.equal(runs.ranksOf({}, { traceEvents: [slice(4, 0, 1, 0)] }), 5);
});
