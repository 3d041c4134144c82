"""The call of the package `triangle`: the same names, switches, dictionaries and arrays, made by driftmesh.

    import driftmesh.triangle as tr

    square = dict(vertices=[[0, 0], [0, 1], [1, 1], [1, 0]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    mesh = tr.triangulate(square, "pq30a0.1")
    mesh["vertices"], mesh["triangles"], mesh["vertex_markers"]

Meshes are other ones than Triangle's, with the same bounds; the points of the input come first, in its order.
"""

import pathlib as _pathlib

import numpy as _np

from ._native import triangulate_tables as _triangulate_tables
from ._triangle_data import data as _data

__all__ = ["compare", "convex_hull", "delaunay", "get_data", "load", "loads", "plot", "show_data", "triangulate", "voronoi"]

# Each table of an input: the type of its entries, and the number of its columns (None: any).
_TABLES = {
    "vertices": (_np.float64, 2),
    "vertex_attributes": (_np.float64, None),
    "vertex_markers": (_np.int32, 1),
    "triangles": (_np.int32, (3, 6)),
    "triangle_attributes": (_np.float64, None),
    "triangle_max_area": (_np.float64, 1),
    "segments": (_np.int32, 2),
    "segment_markers": (_np.int32, 1),
    "holes": (_np.float64, 2),
    "regions": (_np.float64, 4),
}


def _table(name, given):
    """The table as an array with rows."""
    kind, columns = _TABLES[name]
    array = _np.asarray(given)
    if array.size == 0:
        return None
    try:
        table = array.astype(kind, casting="same_kind" if kind is _np.float64 else "unsafe")
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} are not numbers; give an array of numbers") from error
    if kind is _np.int32 and not _np.array_equal(table, array):
        raise ValueError(f"{name} are not all whole numbers of 32 bits; correct them")
    if table.ndim == 1 and columns in (1, None):
        table = table[:, None]
    if table.ndim != 2 or not (columns is None or table.shape[1] in _np.atleast_1d(columns)):
        raise ValueError(f"{name} have shape {array.shape}; give rows of {columns} numbers")
    return _np.ascontiguousarray(table)


def triangulate(tri, opts="", *, unsuitable=None):
    """Triangulate what the dictionary `tri` describes, as the switches in `opts` say.

    Input: vertices (n, 2), and where they apply vertex_attributes (n, k), vertex_markers (n, 1), segments (s, 2), segment_markers
    (s, 1), holes (h, 2), regions (r, 4) with x, y, attribute and largest area; for the switch r triangles (t, 3), triangle_attributes
    (t, k) and triangle_max_area (t, 1). Tables with one column may be lists. Indices start at 0. Other keys are ignored.

    The result has the same tables of the mesh, markers and indices as int32, and on request neighbors (t, 3; -1: none), edges
    (e, 2) with edge_markers (e, 1), and voronoi, a dictionary with vertices, edges, ray_origins and ray_directions.

    Switches: p segments, holes and regions count; r refine a mesh; q or q30 smallest angle, at most 34 degrees; a0.1 largest area;
    a areas of regions or triangles; u ask unsuitable(corners, area), which says whether a triangle is too large; A attributes of
    regions; c convex hull; D (or s) conforming Delaunay; j without unused points; e edges; n neighbors; v Voronoi diagram; o2 six
    points to a triangle; Y no new points on the boundary, YY on no segment; S100 at most 100 new points; C check the mesh; O no
    holes; B no markers; P no segments; N no vertices; E no triangles; V statistics. i, F, l, X, z, Q, I and g change nothing here.
    Others raise driftmesh.Error, wrong inputs driftmesh.InputError, which is a ValueError.
    """
    if "vertices" not in tri:
        raise ValueError("the dictionary has no 'vertices'; give an array of points, shape (n, 2)")
    tables = {name: _table(name, tri[name]) for name in _TABLES if tri.get(name) is not None}
    tables = {name: table for name, table in tables.items() if table is not None}
    return _triangulate_tables(tables, opts, unsuitable)


def delaunay(pts):
    """The Delaunay triangulation of points: triangles, shape (t, 3)."""
    return triangulate({"vertices": pts})["triangles"]


def convex_hull(pts):
    """The convex hull of points: segments, shape (s, 2), counterclockwise."""
    mesh = triangulate({"vertices": pts}, "en")
    edges = []
    for triangle, neighbors in zip(mesh["triangles"], mesh["neighbors"]):
        edges += [(triangle[(i + 1) % 3], triangle[(i + 2) % 3]) for i in range(3) if neighbors[i] < 0]
    following = dict(edges)
    ring = [min(following)]
    while following[ring[-1]] != ring[0]:
        ring.append(following[ring[-1]])
    return _np.array([(a, following[a]) for a in ring], _np.int32)


def voronoi(pts):
    """The Voronoi diagram of points: its vertices, its edges between them, and its rays by their origins and directions."""
    diagram = triangulate({"vertices": pts}, "v")["voronoi"]
    return diagram["vertices"], diagram["edges"], diagram["ray_origins"], diagram["ray_directions"]


def get_data(name):
    """An example by its name. They are driftmesh's own, in the manner of Triangle's."""
    return _data(name)


# ---- Files ----

def _rows(text):
    lines = (line.split("#")[0].split() for line in text.splitlines())
    return [[float(field) for field in line] for line in lines if line]


def _parse_node(rows):
    count, _, attributes, markers = (int(field) for field in (rows.pop(0) + [0, 0])[:4])
    if count == 0:
        return {}, None
    body = _np.array([rows.pop(0) for _ in range(count)])
    tables = {"vertices": body[:, 1:3]}
    if attributes:
        tables["vertex_attributes"] = body[:, 3:3 + attributes]
    if markers:
        tables["vertex_markers"] = body[:, [3 + attributes]].astype(_np.int32)
    return tables, int(body[0, 0])


def _parse_list(rows, columns):
    """A section of a file: its header, then so many rows."""
    header = rows.pop(0)
    body = _np.array([rows.pop(0) for _ in range(int(header[0]))])
    return header, body.reshape(len(body), -1)[:, 1:1 + columns] if len(body) else _np.empty((0, columns))


def loads(node=None, ele=None, poly=None, area=None, edge=None, neigh=None):
    """The tables in the texts of files, with indices from 0."""
    tables, first = _parse_node(_rows(node)) if node else ({}, None)
    if poly:
        rows = _rows(poly)
        own, numbered = _parse_node(rows)
        tables.update(own)
        first = numbered if numbered is not None else first
        header, segments = _parse_list(rows, 3)
        if len(segments):
            tables["segments"] = segments[:, :2].astype(_np.int32) - (first or 0)
            if len(header) > 1 and header[1]:
                tables["segment_markers"] = segments[:, [2]].astype(_np.int32)
        for name, columns in (("holes", 2), ("regions", 4)):
            if rows and len(found := _parse_list(rows, columns)[1]):
                tables[name] = found
    first = first or 0
    if ele:
        rows = _rows(ele)
        corners, attributes = int(rows[0][1]), int(rows[0][2])
        body = _parse_list(rows, corners + attributes)[1]
        tables["triangles"] = body[:, :corners].astype(_np.int32) - first
        if attributes:
            tables["triangle_attributes"] = body[:, corners:]
    if area:
        tables["triangle_max_area"] = _parse_list(_rows(area), 1)[1]
    if edge:
        header, body = _parse_list(_rows(edge), 3)
        tables["edges"] = body[:, :2].astype(_np.int32) - first
        if header[1]:
            tables["edge_markers"] = body[:, [2]].astype(_np.int32)
    if neigh:
        body = _parse_list(_rows(neigh), 3)[1].astype(_np.int32)
        tables["neighbors"] = _np.where(body < 0, -1, body - first).astype(_np.int32)
    return tables


def load(directory, name):
    """The tables in the files `name`.node, .ele, .poly, .area, .edge and .neigh of a folder, as far as they exist."""
    texts = {}
    for kind in ("node", "ele", "poly", "area", "edge", "neigh"):
        path = _pathlib.Path(directory) / f"{name}.{kind}"
        if path.exists():
            texts[kind] = path.read_text()
    if not texts:
        raise FileNotFoundError(f"{_pathlib.Path(directory) / name}: there is no such file with .node, .ele or .poly after it")
    return loads(**texts)


# ---- Pictures, by the caller's matplotlib ----

def plot(ax, **tables):
    """Draw tables on axes of matplotlib."""
    vertices = _np.asarray(tables["vertices"], float)
    ax.axes.set_aspect("equal")
    ax.plot(*vertices.T, "k.", markersize=3)
    if "triangles" in tables:
        ax.triplot(*vertices.T, _np.asarray(tables["triangles"])[:, :3], color="0.6", linewidth=0.6)
    for name, color in (("segments", "C3"), ("edges", "C0")):
        for a, b in _np.asarray(tables.get(name, ())):
            ax.plot(*vertices[[a, b]].T, color=color, linewidth=1)
    if "holes" in tables:
        ax.plot(*_np.asarray(tables["holes"], float).T, "C3x")
    if "ray_origins" in tables:
        reach = _np.ptp(vertices, axis=0).max() + 1
        for origin, direction in zip(tables["ray_origins"], tables["ray_directions"]):
            far = vertices[origin] + reach * direction / _np.hypot(*direction)
            ax.plot(*_np.array([vertices[origin], far]).T, color="C0", linewidth=1)
    ax.get_xaxis().set_visible(False)
    ax.get_yaxis().set_visible(False)


def compare(plt, A, B, figsize=(6, 3)):
    """Draw two dictionaries beside each other. `plt` is matplotlib.pyplot."""
    plt.figure(figsize=figsize)
    left = plt.subplot(121)
    plot(left, **A)
    limits = left.axis()
    right = plt.subplot(122, sharex=left, sharey=left)
    plot(right, **B)
    left.axis(limits)
    plt.tight_layout()


def show_data(name):
    """Draw an example by its name."""
    import matplotlib.pyplot as plt

    plot(plt.axes(), **get_data(name))
    plt.show()
