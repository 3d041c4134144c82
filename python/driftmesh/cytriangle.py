"""The calls of cytriangle, made by driftmesh: functions from dictionaries to dictionaries of lists, and the same as objects.

    import driftmesh.cytriangle as triangle

    mesh = triangle.triangulate({"vertices": points, "segments": facets, "regions": regions}, "pq30.0Aao2")
    mesh["vertices"], mesh["triangles"], mesh["triangle_attributes"]
"""

import numpy as _np

from . import triangle as _triangle

__all__ = ["CyTriangle", "TriangleIO", "convex_hull", "delaunay", "triangulate", "voronoi"]

_NAMES = (*_triangle._TABLES, "neighbors", "edges", "edge_markers", "ray_origins", "ray_directions")


def _listed(tables):
    return {name: table.tolist() for name, table in tables.items() if isinstance(table, _np.ndarray)}


def triangulate(input_dict, flags=""):
    """The tables of the mesh as lists. Those with one column have rows of one number."""
    return CyTriangle(input_dict).triangulate(flags).to_dict()


def delaunay(vertices):
    """The triangles of the Delaunay triangulation."""
    return _triangle.delaunay(vertices).tolist()


def convex_hull(vertices):
    """The segments of the convex hull."""
    return _triangle.convex_hull(vertices).tolist()


def voronoi(vertices):
    """The Voronoi diagram: vertices, edges, ray_origins, ray_directions."""
    return CyTriangle({"vertices": vertices}).voronoi().to_dict()


class TriangleIO:
    """Tables as attributes: vertices, vertex_markers, segments, triangles, ... None stands for one that is not there."""

    def __init__(self, input_dict=None, kind=""):
        unknown = set(input_dict or {}) - set(_NAMES)
        if unknown:
            raise ValueError(f"there are no tables called {', '.join(sorted(unknown))}; there are {', '.join(_NAMES)}")
        self.kind = kind
        for name in _NAMES:
            setattr(self, name, (input_dict or {}).get(name))

    def to_dict(self, opt="list"):
        """The tables that are there: as lists, or opt="np" as arrays."""
        found = {name: getattr(self, name) for name in _NAMES if getattr(self, name) is not None}
        return {name: _np.asarray(table) if opt == "np" else _np.asarray(table).tolist() for name, table in found.items()}


class CyTriangle:
    """An input, and what has been made of it: in_, out and vorout are a TriangleIO each."""

    def __init__(self, input_dict=None):
        self.in_ = TriangleIO(input_dict, "in")
        self.out = TriangleIO(kind="out")
        self.vorout = TriangleIO(kind="vorout")

    in_dict = property(lambda self: self.in_.to_dict())
    out_dict = property(lambda self: self.out.to_dict())
    vorout_dict = property(lambda self: self.vorout.to_dict())

    def triangulate(self, triflags=""):
        """Returns `out`."""
        tables = _triangle.triangulate(self.in_.to_dict("np"), triflags)
        self.vorout = TriangleIO(_listed(tables.pop("voronoi", {})), "vorout")
        self.out = TriangleIO(_listed(tables), "out")
        return self.out

    def delaunay(self):
        return self.triangulate("")

    def convex_hull(self):
        return self.triangulate("c")

    def voronoi(self):
        """Returns `vorout`."""
        self.triangulate("v")
        return self.vorout

    def refine(self, triflags):
        """Refines the mesh that was made: `out` takes the place of `in_`. Returns the new `out`."""
        self.in_ = self.out
        return self.triangulate(triflags + "r")
