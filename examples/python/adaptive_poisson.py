#!/usr/bin/env python3
"""Adaptive refinement: linear elements for the Laplace equation on an L-shaped domain, whose solution has infinite
derivatives at the inner corner. Needs scipy.

    adaptive_poisson.py [picture]

In each step the mesh is refined where the jumps of the gradient over its edges are large. The solution is known, so the
program can tell the error, and succeeds if the error is inversely proportional to the number of points, as it is for
smooth solutions; a uniform mesh does not reach that here.
"""

import sys

import driftmesh
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

CORNERS = [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)]
DOMAIN = driftmesh.Pslg(CORNERS, [(k, (k + 1) % 6) for k in range(6)])
STEPS = 6


def exact(points):
    x, y = points.T
    angle = np.arctan2(y, x) % (2 * np.pi)
    return np.hypot(x, y) ** (2 / 3) * np.sin(2 / 3 * angle)


def gradients(mesh):
    """The area of each triangle, and the gradients of its three linear shape functions, shape (triangles, 3, 2)."""
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    sides = np.stack([c - b, a - c, b - a], axis=1)
    areas = (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / 2
    return areas, np.stack([-sides[:, :, 1], sides[:, :, 0]], axis=2) / (2 * areas)[:, None, None]


def solve(mesh):
    """The values at the points. On the boundary they are the exact ones."""
    areas, shapes = gradients(mesh)
    elements = np.einsum("t,tik,tjk->tij", areas, shapes, shapes)
    rows, columns = (np.repeat(mesh.triangles, 3, axis=1), np.tile(mesh.triangles, 3))
    matrix = coo_matrix((elements.ravel(), (rows.ravel(), columns.ravel()))).tocsr()
    fixed = np.zeros(len(mesh.points), bool)
    fixed[mesh.edges] = True
    values = np.where(fixed, exact(mesh.points), 0.0)
    values[~fixed] = spsolve(matrix[~fixed][:, ~fixed], -matrix[~fixed][:, fixed] @ values[fixed])
    return values


def jumps(mesh, values):
    """Of each triangle: the squared jumps of the gradient over its edges, times the squares of their lengths."""
    _, shapes = gradients(mesh)
    slopes = np.einsum("tik,ti->tk", shapes, values[mesh.triangles])
    ends = np.sort(np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]]), axis=1)
    order = np.lexsort(ends.T)
    twins = np.flatnonzero((ends[order][1:] == ends[order][:-1]).all(axis=1))
    one, other = (order[twins + k] % len(mesh.triangles) for k in (0, 1))
    lengths = np.sum(np.diff(mesh.points[ends[order[twins]]], axis=1) ** 2, axis=(1, 2))
    squares = np.sum((slopes[one] - slopes[other]) ** 2, axis=1) * lengths
    sums = np.zeros(len(mesh.triangles))
    np.add.at(sums, one, squares / 2)
    np.add.at(sums, other, squares / 2)
    return sums


def error(mesh, values):
    """The root of the integral of the squared error, by the middles of edges."""
    areas, _ = gradients(mesh)
    squares = 0
    for k in range(3):
        ends = mesh.triangles[:, [k, (k + 1) % 3]]
        squares = squares + (values[ends].mean(axis=1) - exact(mesh.points[ends].mean(axis=1))) ** 2
    return np.sqrt(np.sum(areas * squares) / 3)


def main():
    adaptive = driftmesh.AdaptiveMesh(DOMAIN, max_area=0.02, min_angle=25, gradation=0.3)
    found = []
    for step in range(STEPS):
        mesh = adaptive.mesh
        values = solve(mesh)
        found.append((len(mesh.points), error(mesh, values)))
        print(f"{found[-1][0]:8,} points: error {found[-1][1]:.2e}")
        if step + 1 < STEPS:
            indicators = np.sqrt(gradients(mesh)[0] * jumps(mesh, values))  # as large as the errors, but for a factor
            adaptive.adapt(adaptive.lengths_from_error(indicators, target=0.6 * np.linalg.norm(indicators), order=2))
    if len(sys.argv) > 1:
        driftmesh.plot(mesh, sys.argv[1], color="area")
    points, errors = np.log(np.array(found)[STEPS // 2:]).T
    rate = -np.polyfit(points, errors, 1)[0]
    print(f"the error falls with the number of points to the power of -{rate:.2f}")
    return 0 if rate > 0.9 else 1


if __name__ == "__main__":
    sys.exit(main())
