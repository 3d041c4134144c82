#!/usr/bin/env python3
"""What an order of points means to a solver: bandwidth and profile of the matrix of linear elements on a generated bay, processor time of
a product with a vector and of a sparse factorization (SuperLU), and what ordering costs beside meshing; prints a table in Markdown (docs/results/orders.md). Needs the Python package on the PYTHONPATH, numpy and scipy.

usage: orders.py [--program DRIFTMESH] [--areas A,A] [--repetitions N] [--update]
"""

import argparse
import pathlib
import statistics
import sys
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from table import Table  # noqa: E402


def matrix_of(mesh):
    """Stiffness and mass of linear elements, so that it is positive definite."""
    import numpy as np
    from scipy.sparse import coo_matrix
    corners = mesh.triangles
    side = mesh.points[corners[:, [2, 0, 1]]] - mesh.points[corners[:, [1, 2, 0]]]
    area = (side[:, 0, 0] * side[:, 1, 1] - side[:, 0, 1] * side[:, 1, 0]) / 2
    local = np.einsum("tid,tjd->tij", side, side) / (4 * area)[:, None, None] + \
        (area / area.mean() / 1200)[:, None, None] * (np.ones((3, 3)) + np.eye(3))
    return coo_matrix((local.ravel(), (np.repeat(corners, 3), np.tile(corners, 3).ravel()))).tocsr()


def seconds(work):
    begin = time.process_time()
    value = work()
    return time.process_time() - begin, value


def measured(options):
    import driftmesh
    import numpy as np
    from scipy.sparse.linalg import splu
    table = Table("orders", "Orders of a bay's points", ["points", "--order", "ordering", "bandwidth", "profile", "product", "factorization"],
                  "Profile: mean distance of the first entry of a row from the diagonal. Ordering: processor time, as a part of that of "
                  "meshing in one piece. Product with a vector and factorization by SuperLU (which orders columns itself): "
                  f"processor time, in that of `given`; medians of {options.repetitions} rounds in which orders alternate.")
    bay = driftmesh.generate("bay")
    for area in options.areas:
        times = {order: [] for order in ("given", "hilbert", "rcm")}
        shown = {}
        for _ in range(options.repetitions):
            meshing, mesh = seconds(lambda: driftmesh.mesh(bay, max_area=area, threads=1))
            for order, rounds in times.items():
                ordering, ordered = seconds(lambda: mesh.ordered(order))
                matrix = matrix_of(ordered)
                x = np.ones(len(ordered.points))
                product, _ = seconds(lambda: [matrix @ x for _ in range(max(3, 3_000_000 // len(x)))])
                columns = matrix.tocsc()
                factorization, _ = seconds(lambda: splu(columns))
                rounds.append((ordering / meshing, product, factorization))
                first = np.minimum.reduceat(matrix.indices, matrix.indptr[:-1])
                shown[order] = len(x), ordered.bandwidth, np.maximum(np.arange(len(x)) - first, 0).mean()
        middle = {order: [statistics.median(column) for column in zip(*rounds)] for order, rounds in times.items()}
        for order, (points, bandwidth, profile) in shown.items():
            ratios = [mine / given for mine, given in zip(middle[order][1:], middle["given"][1:])]
            table.add(points, order, f"{middle[order][0]:.2f}", f"{bandwidth:,}", f"{profile:,.0f}", *(f"{r:.2f}" for r in ratios))
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh", help="of the same build, to say which it is")
    parser.add_argument("--areas", type=lambda text: [float(a) for a in text.split(",")], default=[40000.0, 2500.0])
    parser.add_argument("--repetitions", type=int, default=5)
    results.add_option(parser)
    options = parser.parse_args()
    results.show("bench/orders.py", map(measured, [options]), options)


if __name__ == "__main__":
    main()
