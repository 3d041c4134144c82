// node --test runs_test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";
import * as runs from "../src/runs.js";

const ranks = (...idle) => idle.map((i) => ({ seconds: { computing: 1 - i, idle: i } }));

test("keys that differ are those swept, in their order", () => {
  const records = [{ swept: { b: 1, a: "x", c: 5 } }, { swept: { b: 2, a: "x", c: 5 } }, { swept: { b: 2, a: "y", c: 5 } }];
  assert.deepEqual(runs.sweptKeys(records), ["b", "a"]);
  assert.deepEqual(runs.sweptKeys([{}, {}]), []);
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
  assert.equal(runs.ranksOf({}, { busy: [[4, 0, 1, 0]] }), 5);
});
