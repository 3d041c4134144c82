"""Rules for target edge lengths, for the `size` of a mesh.

    from driftmesh import sizes

    rule = sizes.minimum(20 + 0.1 * sizes.distance(), 0.4 * sizes.raster(depth, x0, y0, dx, dy))
    mesh = driftmesh.mesh(bay, size=rule.limited(gradation=0.2, shortest=10))

The library evaluates them by itself, on all threads, as the program does size expressions, with the same guarantees.
"""

import functools as _functools

import numpy as _np

from ._native import SizeRule
from ._native import Pslg as _Pslg
from ._native import _raster_rule

__all__ = ["SizeRule", "curvature", "distance", "expression", "maximum", "minimum", "on_mesh", "raster", "slope", "width"]


def expression(formula, **named):
    """A formula in x and y (docs/size-expressions.md), and in rules that it calls by the names of the other arguments."""
    return SizeRule.expression(formula, {name: _rule(rule) for name, rule in named.items()})


def distance(*markers, to=None):
    """The distance to the nearest segment of the domain with one of these markers; without markers, to any segment.

    to: instead, segments wherever they lie: a Pslg, or their ends, shape (segments, 2, 2)"""
    if to is None:
        return SizeRule.distance(list(markers))
    if markers:
        raise TypeError("distance takes either markers of the domain or segments (to), not both")
    ends = to.points[to.segments] if isinstance(to, _Pslg) else _np.asarray(to, dtype=float)
    if ends.ndim != 3 or ends.shape[1:] != (2, 2):
        raise ValueError(f"to has shape {ends.shape}; segments have shape (segments, 2, 2)")
    return SizeRule.distance_to(ends.reshape(-1, 4))


def width():
    """The local width of the domain: `width() / 4` puts four triangles across every channel."""
    return SizeRule.width()


def curvature():
    """The curvature of the outline, one over the radius."""
    return SizeRule.curvature()


def on_mesh(mesh, lengths, *, gradation=0):
    """Lengths at the points of a mesh, linear on its triangles: see size_on_mesh."""
    return SizeRule.on_mesh(mesh, lengths, gradation)


def raster(values, x0=None, y0=None, dx=None, dy=None):
    """Values on a regular grid, bilinear in between: those of an array of shape (rows, columns), of which that in row j
    and column i lies at (x0 + i*dx, y0 + j*dy), of an xarray.DataArray with evenly spaced coordinates of its two last
    dimensions (y, x), or of the first band of a rasterio dataset. In the coordinates of the domain. Masked values and NaN
    are gaps, which the nearest value fills."""
    return _raster_rule(*_grid(values, x0, y0, dx, dy), False)


def slope(values, x0=None, y0=None, dx=None, dy=None):
    """The length of the gradient of a raster."""
    return _raster_rule(*_grid(values, x0, y0, dx, dy), True)


def minimum(*rules):
    """The least of some rules and numbers."""
    return _functools.reduce(SizeRule._least, map(_rule, rules))


def maximum(*rules):
    """The greatest of some rules and numbers."""
    return _functools.reduce(SizeRule._greatest, map(_rule, rules))


def _rule(given):
    return given if isinstance(given, SizeRule) else SizeRule(given)


def _grid(values, x0, y0, dx, dy):
    placed = [number is not None for number in (x0, y0, dx, dy)]
    if any(placed) and not all(placed):
        raise TypeError("a raster has all of x0, y0, dx and dy, or brings them along (xarray, rasterio)")
    if not any(placed):
        values, x0, y0, dx, dy = _placed(values)
    values = _np.ma.filled(_np.ma.asarray(values, dtype=_np.float32), _np.nan)
    if values.ndim != 2:
        raise ValueError(f"a raster has shape {values.shape}; give (rows, columns)")
    return values, x0, y0, dx, dy


def _placed(given):
    """Values and their place, as xarray or rasterio have them."""
    if hasattr(given, "coords") and hasattr(given, "dims"):
        y, x = given.dims[-2:]
        return (_np.asarray(given.values).squeeze(), *_steps(given.coords[x], given.coords[y]))
    if hasattr(given, "transform") and hasattr(given, "read"):
        t = given.transform
        if t.b != 0 or t.d != 0:
            raise ValueError("a raster is rotated; warp it to a grid along the axes first")
        return given.read(1, masked=True), t.c + t.a / 2, t.f + t.e / 2, t.a, t.e
    raise TypeError("a raster is no xarray.DataArray and no rasterio dataset; give the place of an array by x0, y0, dx and dy")


def _steps(x, y):
    x, y = _np.asarray(x, dtype=float), _np.asarray(y, dtype=float)
    for name, at in (("x", x), ("y", y)):
        if at.ndim != 1 or len(at) < 2:
            raise ValueError(f"a raster has no two coordinates in {name}")
        steps = _np.diff(at)
        if abs(steps - steps.mean()).max() > 1e-3 * abs(steps.mean()):
            raise ValueError(f"a raster has coordinates in {name} that are not evenly spaced; interpolate it to a regular grid first")
    return x[0], y[0], (x[-1] - x[0]) / (len(x) - 1), (y[-1] - y[0]) / (len(y) - 1)
