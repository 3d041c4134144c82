#!/usr/bin/env python3
"""A load balancing policy in Python, compared with others on a simulated cluster of fast and slow ranks."""

import driftmesh
import numpy as np

PIPE = driftmesh.generate("pipe")
CLUSTER = {"rank_speeds": [1e5] * 8 + [2e5] * 8}


class Pairs:
    """Pairs the rank that would finish last with the one that would finish first, and so on; the later gives to the earlier."""

    def plan(self, load):
        order = np.argsort(load.rank_remaining / load.rank_speeds)
        moves = []
        for early, late in zip(order[: len(order) // 2], order[::-1]):
            work = load.rank_remaining[[early, late]]
            speed = load.rank_speeds[[early, late]]
            even = (work[1] / speed[1] - work[0] / speed[0]) / np.sum(1 / speed)  # both would finish at the same time
            for subdomain in np.flatnonzero((load.owners == late) & ~load.fixed & (load.turns > 0))[::-1]:
                if load.remaining[subdomain] <= even:
                    even -= load.remaining[subdomain]
                    moves.append((load.subdomains[subdomain], early))
        return moves


def main():
    print("policy       seconds   of the ideal   moves")
    for name, balance in (("none", {}), ("greedy", {"policy": "greedy"}), ("stealing", {"policy": "stealing"}),
                          ("own", {"own": Pairs()})):
        run = driftmesh.simulate(PIPE, CLUSTER, triangles="500k", subdomains={"count": 320}, balance=balance)
        print(f"{name:10} {run.seconds:9.4f} {run.ideal_seconds / run.seconds:13.0%} {len(run.moves):7}")


if __name__ == "__main__":
    main()
