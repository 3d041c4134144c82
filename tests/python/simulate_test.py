"""Runs on simulated clusters, with policies of the library and of Python."""

import unittest

import driftmesh
import numpy as np

PIPE = driftmesh.generate("pipe")
UNEVEN = {"rank_speeds": [1e5, 1e5, 2e5, 4e5]}
OPTIONS = {"triangles": "50k", "subdomains": {"count": 60}}
EAGER = {"look": 1e-3, "gap": 1e-3}


class FromLastToFirst:
    """Gives the last subdomain of the rank that would finish last to the one that would finish first."""

    def __init__(self):
        self.loads = []

    def plan(self, load):
        self.loads.append(load)
        finish = load.rank_remaining / load.rank_speeds
        own = load.subdomains[(load.owners == finish.argmax()) & ~load.fixed]
        return [(own[-1], finish.argmin())] if len(own) > 1 else None


def simulate(policy=None, **options):
    balance = EAGER | ({"policy": policy} if isinstance(policy, str) else {"own": policy})
    return driftmesh.simulate(PIPE, UNEVEN, **OPTIONS, balance=balance, **options)


class Simulate(unittest.TestCase):
    def test_results(self):
        run = simulate("none")
        self.assertEqual(len(run.ranks), 4)
        np.testing.assert_array_equal(run.speeds, UNEVEN["rank_speeds"])
        np.testing.assert_array_equal(run.owners_before, run.owners_after)
        self.assertEqual((len(run.owners_after), run.moves), (60, []))
        self.assertLess(abs(run.triangles - 50_000), 5_000)
        self.assertLess(run.ideal_seconds, run.seconds)
        self.assertGreater(run.message_bytes, run.messages)
        for rank in run.ranks:
            total = rank.computing + rank.sending + rank.polling + rank.balancing + rank.idle
            self.assertLess(total, run.seconds * 1.001)

    def test_the_same_again(self):
        one, other = simulate("greedy"), simulate("greedy")
        self.assertGreater(len(one.moves), 0)
        self.assertEqual([(m.subdomain, m.source, m.target, m.left, m.arrived, m.bytes) for m in one.moves],
                         [(m.subdomain, m.source, m.target, m.left, m.arrived, m.bytes) for m in other.moves])
        self.assertEqual(one.seconds, other.seconds)

    def test_clusters(self):
        slow, fast = (driftmesh.simulate(PIPE, {"ranks": 3, "speed": speed}, **OPTIONS) for speed in (1e5, "1M"))
        self.assertGreater(slow.seconds, 5 * fast.seconds)
        far = driftmesh.simulate(PIPE, {"ranks": 3, "speed": 1e5, "latency": 1.0}, **OPTIONS)
        self.assertGreater(far.seconds, slow.seconds + 1)


class Policies(unittest.TestCase):
    def test_policy(self):
        policy = FromLastToFirst()
        run = simulate(policy)
        self.assertGreater(len(run.moves), 0)
        self.assertLess(run.seconds, simulate("none").seconds)
        for move in run.moves:
            self.assertNotEqual(move.source, move.target)
        self.assertEqual(run.seconds, simulate(FromLastToFirst()).seconds)

    def test_load(self):
        policy = FromLastToFirst()
        simulate(policy)
        for load in policy.loads:  # after the run, which is over
            count = len(load.subdomains)
            self.assertEqual({len(getattr(load, name)) for name in ("owners", "remaining", "bytes", "turns", "costs", "fixed")},
                             {count})
            self.assertTrue((np.diff(load.subdomains) > 0).all() and set(load.owners) <= {0, 1, 2, 3})
            self.assertTrue((load.rank_free_memory >= 1e300).all())
            self.assertEqual((load.rank_remaining.shape, load.rank_speeds.shape, load.rank_doubts.shape), ((4,), (4,), (4,)))
            self.assertGreater(load.rank_speeds.min(), 0)
            self.assertFalse(load.remaining.flags.writeable)
        neighbors = policy.loads[0].neighbors(5)
        self.assertTrue(neighbors and all(0 <= s < 60 and length > 0 for s, length in neighbors.items()))
        with self.assertRaises(IndexError):
            policy.loads[0].neighbors(60)

    def test_function(self):
        self.assertEqual(simulate(lambda load: []).moves, [])

    def test_wrong_moves(self):
        for words, move in (("99", lambda load: (99, 0)), ("no such rank", lambda load: (load.subdomains[0], 4))):
            with self.assertRaisesRegex(ValueError, words):
                simulate(lambda load: [move(load)])
        with self.assertRaisesRegex(ValueError, "moved already"):
            simulate(lambda load: [(load.subdomains[0], 1), (load.subdomains[0], 2)])

    def test_exceptions(self):
        with self.assertRaises(ZeroDivisionError):
            simulate(lambda load: 1 / 0)
        with self.assertRaises(TypeError):
            simulate(lambda load: [3])

    def test_errors(self):
        for error, words, call in (
                (TypeError, "'speed'", lambda: driftmesh.simulate(PIPE, {"ranks": 2, "speeed": 1})),
                (TypeError, "plan", lambda: driftmesh.simulate(PIPE, {"ranks": 2}, balance={"own": 3})),
                (driftmesh.Error, "number of ranks", lambda: driftmesh.simulate(PIPE, {})),
                (driftmesh.Error, "policy", lambda: driftmesh.simulate(PIPE, {"ranks": 2}, balance={"policy": "grab"})),
                (driftmesh.Error, "alone", lambda: driftmesh.mesh(PIPE, balance={"own": lambda load: []}))):
            with self.assertRaisesRegex(error, words):
                call()


if __name__ == "__main__":
    unittest.main(verbosity=2)
