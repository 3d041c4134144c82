"""The calls of meshpy.triangle, made by driftmesh.

    import driftmesh.meshpy.triangle as triangle

    info = triangle.MeshInfo()
    info.set_points([(0, 0), (1, 0), (1, 1), (0, 1)])
    info.set_facets([(0, 1), (1, 2), (2, 3), (3, 0)], facet_markers=[1, 2, 3, 4])
    mesh = triangle.build(info, max_volume=1e-2, min_angle=25)
    mesh.points, mesh.elements          # numpy.array() makes arrays of them
"""

import copy as _copy

import numpy as _np

from .. import triangle as _triangle

__all__ = ["MeshInfo", "build", "refine", "subdivide_facets", "write_gnuplot_mesh"]


class _Array:
    """A list of numbers (unit 1) or of rows of numbers. Some are as long as another one, once setup() has been called."""

    def __init__(self, unit, kind, like=None):
        self.unit = unit
        self._kind = kind
        self._like = like
        self._rows = _np.zeros((0, unit), kind)
        self.allocated = like is None

    def __len__(self):
        return len(self._rows)

    def resize(self, new_size):
        if self._like is not None:
            raise RuntimeError("this array is as long as the one that it belongs to; resize that one, then call setup()")
        rows = _np.zeros((new_size, self.unit), self._kind)
        kept = min(new_size, len(self._rows))
        rows[:kept] = self._rows[:kept]
        self._rows = rows

    def setup(self):
        if self._like is None:
            raise RuntimeError("this array has a length of its own; call resize()")
        self._rows = _np.zeros((len(self._like), self.unit), self._kind)
        self.allocated = True

    def deallocate(self):
        self._rows = _np.zeros((0, self.unit), self._kind)
        self.allocated = self._like is None

    def fill(self, rows):
        """Takes the place of all entries."""
        rows = _np.asarray(rows, self._kind)
        if rows.ndim == 2 and rows.shape[0]:
            self.unit = rows.shape[1]
        self._rows = rows.reshape(-1, self.unit).copy()
        self.allocated = True

    def __getitem__(self, index):
        if isinstance(index, tuple):
            return self._rows[index].item()
        row = self._rows[self._checked(index)]
        return row[0].item() if self.unit == 1 else row.tolist()

    def __setitem__(self, index, value):
        if isinstance(index, tuple):
            self._rows[index] = value
        else:
            self._rows[self._checked(index)] = value

    def _checked(self, index):
        if not -len(self._rows) <= index < len(self._rows):
            raise IndexError(f"index {index} in an array of {len(self._rows)}")
        return index

    def __iter__(self):
        return iter(self._rows[:, 0].tolist() if self.unit == 1 else self._rows.tolist())

    def __array__(self, dtype=None, copy=None):
        rows = self._rows[:, 0] if self.unit == 1 else self._rows
        return _np.array(rows, dtype)

    def __repr__(self):
        return repr(list(self))


class MeshInfo:
    """An input, or a mesh: points, facets (segments), holes, regions, elements (triangles), faces (edges), neighbors."""

    # Names, with columns, types, the arrays that they are as long as, and the tables of driftmesh.triangle.
    _ARRAYS = {
        "points": (2, float, None, "vertices"),
        "point_attributes": (0, float, "points", "vertex_attributes"),
        "point_markers": (1, _np.int32, "points", "vertex_markers"),
        "facets": (2, _np.int32, None, "segments"),
        "facet_markers": (1, _np.int32, "facets", "segment_markers"),
        "holes": (2, float, None, "holes"),
        "regions": (4, float, None, "regions"),
        "elements": (3, _np.int32, None, "triangles"),
        "element_attributes": (0, float, "elements", "triangle_attributes"),
        "element_volumes": (1, float, "elements", "triangle_max_area"),
        "neighbors": (3, _np.int32, "elements", "neighbors"),
        "faces": (2, _np.int32, None, "edges"),
        "face_markers": (1, _np.int32, "faces", "edge_markers"),
        "normals": (2, float, "faces", None),
    }

    def __init__(self):
        for name, (unit, kind, like, _) in self._ARRAYS.items():
            setattr(self, name, _Array(unit, kind, getattr(self, like) if like else None))

    number_of_point_attributes = property(lambda self: self.point_attributes.unit,
                                          lambda self, count: setattr(self.point_attributes, "unit", count))
    number_of_element_attributes = property(lambda self: self.element_attributes.unit,
                                            lambda self, count: setattr(self.element_attributes, "unit", count))
    number_of_element_vertices = property(lambda self: self.elements.unit,
                                          lambda self, count: setattr(self.elements, "unit", count))

    def set_points(self, points, point_markers=None):
        self._set("points", points, "point_markers", point_markers)

    def set_facets(self, facets, facet_markers=None):
        self._set("facets", facets, "facet_markers", facet_markers)

    def set_holes(self, hole_starts):
        self.holes.fill(list(hole_starts) or _np.zeros((0, 2)))

    def _set(self, name, rows, markers_name, markers):
        rows = list(rows)
        getattr(self, name).fill(rows or _np.zeros((0, 2)))
        getattr(self, markers_name).deallocate()
        if markers is None:
            return
        markers = list(markers)
        if len(markers) != len(rows):
            raise ValueError(f"there are {len(markers)} markers for {len(rows)} {name}; give one for each")
        getattr(self, markers_name).fill(markers)

    def copy(self):
        return _copy.deepcopy(self)

    def _tables(self):
        named = {table: _np.array(array._rows) for name, (_, _, _, table) in self._ARRAYS.items()
                 if table and len(array := getattr(self, name)) and array.unit}
        return named

    @classmethod
    def _of(cls, tables):
        info = cls()
        for name, (_, _, _, table) in cls._ARRAYS.items():
            if table in tables:
                getattr(info, name).fill(tables[table])
        return info


def build(mesh_info, verbose=False, refinement_func=None, attributes=False, volume_constraints=True, max_volume=None,
          allow_boundary_steiner=True, allow_volume_steiner=True, quality_meshing=True, generate_edges=None, generate_faces=False,
          min_angle=None, mesh_order=None, generate_neighbor_lists=False):
    """Mesh what the facets of a MeshInfo enclose.

    refinement_func(vertices, area) says whether a triangle is too large; it must accept all small ones. attributes: triangles get
    those of their regions. volume_constraints: the largest areas of regions count. allow_volume_steiner=False: no points are added.
    generate_faces (or generate_edges): the result has faces, the edges of the triangles.
    """
    if generate_edges is not None:
        generate_faces = generate_edges
    switches = "pzj" + _quality(quality_meshing, min_angle)
    if mesh_order is not None:
        switches += f"o{mesh_order}"
    switches += "A" * bool(attributes) + "a" * bool(volume_constraints) + "e" * bool(generate_faces)
    switches += "n" * bool(generate_neighbor_lists)
    if max_volume is not None:
        switches += _area(max_volume)
    if not allow_boundary_steiner:
        switches += "Y"
    if not allow_volume_steiner:
        switches += "S0"
    return _mesh(mesh_info, switches, verbose, refinement_func)


def refine(input_p, verbose=False, refinement_func=None, quality_meshing=True, min_angle=None):
    """Refine a mesh that build() has made: its points stay. element_volumes, where they are set up, bound areas."""
    switches = "zj" + _quality(quality_meshing, min_angle) + "r"
    if len(input_p.facets):
        switches += "p"
    if input_p.element_volumes.allocated and len(input_p.element_volumes):
        switches += "a"
    return _mesh(input_p, switches, verbose, refinement_func)


def _quality(wanted, min_angle):
    if not wanted:
        return ""
    return "q" if min_angle is None else f"q{min_angle:.12f}"


def _area(area):
    if not area > 0:
        raise ValueError(f"max_volume is {area}; it must be positive")
    return f"a{_np.format_float_positional(area, trim='-')}"


def _mesh(info, switches, verbose, unsuitable):
    if unsuitable is not None:
        switches += "u"
    return MeshInfo._of(_triangle.triangulate(info._tables(), switches + ("V" if verbose else "Q"), unsuitable=unsuitable))


def subdivide_facets(subdivisions, points, facets, facet_markers=None):
    """Divide facets into equal parts: so many each, or as many as a list says for each of them.

    Returns points, facets and, if there are any, markers. The points that are there stay first.
    """
    points = [tuple(point) for point in points]
    counts = [subdivisions] * len(facets) if isinstance(subdivisions, int) else list(subdivisions)
    if len(counts) != len(facets):
        raise ValueError(f"there are {len(counts)} subdivisions for {len(facets)} facets; give one for each, or one number")
    new_facets, new_markers = [], []
    for i, (count, (a, b)) in enumerate(zip(counts, facets)):
        start, end = _np.array(points[a], float), _np.array(points[b], float)
        first = len(points)
        points += [tuple(start + (end - start) * (k / count)) for k in range(1, count)]
        chain = [a, *range(first, len(points)), b]
        new_facets += zip(chain[:-1], chain[1:])
        if facet_markers is not None:
            new_markers += [facet_markers[i]] * count
    return (points, new_facets) if facet_markers is None else (points, new_facets, new_markers)


def write_gnuplot_mesh(filename, out_p, facets=False):
    """Write triangles, or facets, as lines for gnuplot."""
    points = list(out_p.points)
    with open(filename, "w") as file:
        for corners in out_p.facets if facets else _np.array(out_p.elements)[:, :3].tolist():
            for corner in [*corners, corners[0]]:
                file.write("{!r} {!r}\n".format(*points[corner]))
            file.write("\n")
