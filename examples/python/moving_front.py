#!/usr/bin/env python3
"""A mesh that follows a front: a cylinder and a cone turn with a flow, by finite volumes on triangles (second order, explicit), and
every few steps the mesh is refined where they have come and coarsened where they have left. Needs numpy.

    moving_front.py [picture [turn]]   with matplotlib, a picture of the mesh and what has turned on it, by pi/4 or so many radians

Means of triangles are carried from mesh to mesh so that their integral stays, and so does the scheme: the program succeeds if mass
is kept to 1e-12, nothing becomes negative, and a third of the triangles are enough that a uniform mesh of the finest ones would have.
"""

import sys

import driftmesh
import numpy as np

SQUARE = driftmesh.Pslg([(-1, -1), (1, -1), (1, 1), (-1, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
FINEST, COARSEST, JUMP = 0.02, 0.2, 0.1
BETWEEN = 8  # steps between two meshes


def start(x, y):
    return np.where(np.hypot(x - 0.5, y) < 0.25, 1.0, 0) + np.maximum(0, 1 - np.hypot(x + 0.5, y) / 0.25)


class Volumes:
    """The triangles of a mesh as volumes, and the flow through their sides: the stream function is (x^2 + y^2) / 2, and 0 at walls."""

    def __init__(self, mesh):
        corners = mesh.points[mesh.triangles]
        self.neighbors = mesh.neighbors  # across from each corner; -1: a wall
        self.centers = corners.mean(axis=1)
        sides = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)  # across from each corner
        self.areas = (sides[:, 1, 0] * sides[:, 2, 1] - sides[:, 1, 1] * sides[:, 2, 0]) / 2
        self.size = np.sqrt(self.areas)
        self.middles = (np.roll(corners, -1, axis=1) + np.roll(corners, -2, axis=1)) / 2
        stream = stream_function(corners)
        self.outflow = np.where(self.neighbors < 0, 0, np.roll(stream, -2, axis=1) - np.roll(stream, -1, axis=1))
        self.step = 0.5 * np.min(self.areas / np.maximum(np.abs(self.outflow).sum(axis=1), 1e-300))

    def slopes(self, u):
        """Of each triangle, by least squares over its neighbors, limited so that no side is beyond what lies around."""
        beside = np.where(self.neighbors < 0, np.arange(len(u))[:, None], self.neighbors)
        away, rise = self.centers[beside] - self.centers[:, None], u[beside] - u[:, None]
        square = np.einsum("tki,tkj->tij", away, away) + 1e-12 * self.areas[:, None, None] * np.eye(2)
        slopes = np.linalg.solve(square, np.einsum("tki,tk->ti", away, rise)[:, :, None])[:, :, 0]
        change = np.einsum("tki,ti->tk", self.middles - self.centers[:, None], slopes)
        room = np.where(change > 0, np.maximum(rise.max(axis=1), 0)[:, None], np.minimum(rise.min(axis=1), 0)[:, None])
        share = np.where(np.abs(change) > 1e-14, room / np.where(change == 0, 1, change), 1).min(axis=1)
        return slopes * np.clip(share, 0, 1)[:, None]

    def rate(self, u):
        """The change of u in time: what flows through each side is that of the triangle upstream."""
        at_sides = u[:, None] + np.einsum("tki,ti->tk", self.middles - self.centers[:, None], self.slopes(u))
        flux = np.where(self.outflow > 0, self.outflow * at_sides, 0)
        leaving = flux.sum(axis=1)
        arriving = np.bincount(self.neighbors[self.neighbors >= 0], weights=flux[self.neighbors >= 0], minlength=len(u))
        return (arriving - leaving) / self.areas

    def advance(self, u):
        once = u + self.step * self.rate(u)  # Heun's method
        return (u + once + self.step * self.rate(once)) / 2

    def lengths(self, mesh, u):
        """At the points: such that u changes by about JUMP from a triangle to the next."""
        beside = np.where(self.neighbors < 0, np.arange(len(u))[:, None], self.neighbors)
        jumps = np.abs(u[beside] - u[:, None]).max(axis=1)
        lengths = np.full(len(mesh.points), COARSEST)
        np.minimum.at(lengths, mesh.triangles, (1.5 * self.size * JUMP / np.maximum(jumps, 1e-9))[:, None])
        return np.clip(lengths, FINEST, COARSEST)


def stream_function(points):
    return (1 - np.minimum(np.hypot(points[..., 0], points[..., 1]), 1) ** 2) / 2


def main():
    flow = driftmesh.AdaptiveMesh(SQUARE, max_area=0.02, min_angle=25, gradation=0.2)
    for _ in range(10):  # until the first mesh knows where the fronts are
        flow.adapt(Volumes(flow.mesh).lengths(flow.mesh, start(*Volumes(flow.mesh).centers.T)))
    volumes = Volumes(flow.mesh)
    flow.attach("u", start(*volumes.centers.T), where="triangles", transfer="conserve")
    mass = volumes.areas @ flow.field("u")
    turn = float(sys.argv[2]) if len(sys.argv) > 2 else np.pi / 4
    turned, generations, triangles, stayed = 0.0, 0, 0, 0
    while turned < turn:
        u = flow.field("u")
        for _ in range(BETWEEN):
            u = volumes.advance(u)
            turned += volumes.step
        flow.attach("u", u, where="triangles", transfer="conserve")
        flow.adapt(volumes.lengths(flow.mesh, u))
        volumes = Volumes(flow.mesh)
        generations += 1
        triangles += len(flow.mesh.triangles)
        stayed += np.count_nonzero(flow.stayed_triangles >= 0)
    u = flow.field("u")
    lost = abs(volumes.areas @ u / mass - 1)
    uniform = 4 / (np.sqrt(3) / 4 * FINEST**2)
    print(f"{generations} meshes of {triangles / generations:,.0f} triangles, {stayed / triangles:.1%} of them from the mesh before; "
          f"a uniform one would have {uniform:,.0f}")
    print(f"mass: {lost:.1e} lost; from {u.min():.1e} to {u.max():.3f}")
    if len(sys.argv) > 1 and sys.argv[1]:
        draw(flow.mesh, u, sys.argv[1])
    return 0 if lost < 1e-12 and u.min() > -1e-12 and 3 * triangles < generations * uniform else 1


def draw(mesh, u, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(12, 6), layout="constrained")
    left.tripcolor(*mesh.points.T, mesh.triangles, u, cmap="viridis")
    right.triplot(*mesh.points.T, mesh.triangles, linewidth=0.3, color="black")
    for axes in (left, right):
        axes.set_aspect("equal")
        axes.set_axis_off()
    figure.savefig(path, dpi=75)


if __name__ == "__main__":
    sys.exit(main())
