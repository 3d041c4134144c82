"""Domains from the polygons of other packages."""

from ._native import Pslg

_OUTER, _INNER, _LINE = 1, 2, 0  # markers, as those of land, islands and lines of a GeoJSON


def from_polygons(shapes):
    """The domain that polygons cover, with lines as segments inside: of a geometry of shapely, a GeoDataFrame or a GeoSeries of
    geopandas, or anything else with a __geo_interface__, of a dictionary like that, or of several of these in a list.

    Coordinates are taken as they are: project degrees first. Outer rings get the marker 1, inner ones 2, lines 0."""
    system = getattr(shapes, "crs", None)
    if getattr(system, "is_geographic", False):
        raise ValueError("the polygons are in degrees; project them first, for example by to_crs(shapes.estimate_utm_crs())")
    build = _Builder()
    build.add(shapes)
    if not build.points:
        raise ValueError("there are no polygons and no lines")
    return Pslg(build.points, build.segments, segment_markers=build.markers, polygons=build.polygons)


class _Builder:
    def __init__(self):
        self.points, self.segments, self.markers, self.polygons = [], [], [], []
        self.features = 0

    def add(self, shape):
        """A geometry, a feature, or several of them."""
        shape = getattr(shape, "__geo_interface__", shape)
        if not isinstance(shape, dict):
            if isinstance(shape, str) or not hasattr(shape, "__iter__"):
                raise TypeError(f"from_polygons takes geometries with a __geo_interface__, not {type(shape).__name__}")
            for one in shape:
                self.add(one)
            return
        kind = shape.get("type")
        if kind == "FeatureCollection":
            self.add(shape["features"])
        elif kind == "GeometryCollection":
            self.add(shape["geometries"])
        elif kind == "Feature":
            if shape["geometry"] is not None:
                self.add(shape["geometry"])
        else:
            self.features += 1
            self.add_geometry(kind, shape["coordinates"])

    def add_geometry(self, kind, coordinates):
        if kind == "Polygon" and coordinates:
            rings = [self.add_line(ring, _INNER if k else _OUTER, True) for k, ring in enumerate(coordinates)]
            self.polygons.append((rings, -1, self.features))
        elif kind in ("LineString", "LinearRing"):
            self.add_line(coordinates, _LINE, False)
        elif kind in ("MultiPolygon", "MultiLineString"):
            for part in coordinates:
                self.add_geometry(kind.removeprefix("Multi"), part)
        elif kind != "Polygon":
            raise ValueError(f"from_polygons takes polygons and lines, not {kind}")

    def add_line(self, coordinates, marker, is_ring):
        """The indices of its points, of which the last of a ring is the first."""
        places = [tuple(float(number) for number in place[:2]) for place in coordinates]
        if is_ring and len(places) > 1 and places[0] == places[-1]:
            places.pop()
        first, count = len(self.points), len(places)
        self.points += places
        indices = list(range(first, first + count))
        ends = list(zip(indices, indices[1:] + indices[:1] if is_ring else indices[1:]))
        self.segments += ends
        self.markers += [marker] * len(ends)
        return indices
