"""Examples of inputs in the manner of Triangle's, drawn for driftmesh."""

import numpy as np


def ring(points, first=0):
    """Segments that join so many points, the last one to the first."""
    index = np.arange(points)
    return np.stack([index, (index + 1) % points], axis=1) + first


def circle(points, center=(0, 0), radius=1.0, turned=0.0):
    angle = turned + np.arange(points) * 2 * np.pi / points
    return np.stack([center[0] + radius * np.cos(angle), center[1] + radius * np.sin(angle)], axis=1)


def of_rings(*rings, holes=()):
    """Closed lines, with holes at these points."""
    starts = np.cumsum([0] + [len(points) for points in rings])
    tables = {"vertices": np.concatenate(rings).astype(float),
              "segments": np.concatenate([ring(len(points), start) for points, start in zip(rings, starts)]).astype(np.int32)}
    if len(holes):
        tables["holes"] = np.array(holes, float)
    return tables


def letter_a():
    outer = [(0, 0), (0.4, 1), (0.6, 1), (1, 0), (0.8, 0), (0.68, 0.3), (0.32, 0.3), (0.2, 0)]
    inner = [(0.39, 0.45), (0.61, 0.45), (0.52, 0.72), (0.48, 0.72)]
    return of_rings(outer, inner, holes=[(0.5, 0.6)]) | {"vertex_attributes": np.linspace(0, 1, 12)[:, None]}


def box():
    """Two squares, one in the other, and no hole: without the convex hull, nothing is enclosed by the outer points."""
    outer, inner = [(0, 0), (3, 0), (3, 3), (0, 3)], [(1, 1), (2, 1), (2, 2), (1, 2)]
    tables = of_rings(outer, inner, holes=[(1.5, 1.5)])
    tables["segments"] = np.concatenate([tables["segments"][4:], [[0, 1]]]).astype(np.int32)
    tables["segment_markers"] = np.array([[2], [2], [2], [2], [5]], np.int32)
    return tables


def face():
    outline = circle(24, radius=1.0) * (0.8, 1)
    mouth = [(-0.35, -0.4), (0, -0.52), (0.35, -0.4), (0.25, -0.55), (0, -0.65), (-0.25, -0.55)]
    left, right = circle(8, (-0.3, 0.3), 0.12), circle(8, (0.3, 0.3), 0.12)
    tables = of_rings(outline, mouth, left, right, holes=[(0, -0.6), (-0.3, 0.3), (0.3, 0.3)])
    nose = len(tables["vertices"])
    tables["vertices"] = np.concatenate([tables["vertices"], [(0, 0.2), (-0.1, -0.15), (0.1, -0.15)]])
    tables["segments"] = np.concatenate([tables["segments"], [[nose, nose + 1], [nose + 1, nose + 2]]]).astype(np.int32)
    return tables


def double_hex(on_side, on_hexagon):
    """A unit square with so many points to a side, and two hexagonal holes with so many points."""
    steps = np.linspace(0, 1, on_side, endpoint=False)
    square = np.concatenate([np.stack([steps, 0 * steps], 1), np.stack([1 + 0 * steps, steps], 1),
                             np.stack([1 - steps, 1 + 0 * steps], 1), np.stack([0 * steps, 1 - steps], 1)])
    holes = []
    for center in ((0.25, 0.3), (0.7, 0.65)):
        corner = circle(6, center, 0.12)
        following = np.roll(corner, -1, axis=0)
        share = np.arange(on_hexagon // 6)[None, :, None] / (on_hexagon // 6)
        holes.append((corner[:, None] + share * (following - corner)[:, None]).reshape(-1, 2))
    return of_rings(square, *holes, holes=[(0.25, 0.3), (0.7, 0.65)])


def soil():
    """Layers of soil with a bound on the areas of each."""
    x = np.linspace(0, 10, 11)
    levels = [0 * x, 1 + 0.3 * np.sin(x), 2.2 + 0.4 * np.cos(x / 2), 3.5 + 0.2 * np.sin(x / 3)]
    vertices = np.concatenate([np.stack([x, level], 1) for level in levels])
    segments = [(11 * row + i, 11 * row + i + 1) for row in range(4) for i in range(10)]
    segments += [(11 * row + end, 11 * (row + 1) + end) for row in range(3) for end in (0, 10)]
    seeds = [(5, (levels[row][5] + levels[row + 1][5]) / 2, row + 1, area) for row, area in enumerate((0.4, 0.1, 0.02))]
    return {"vertices": vertices, "segments": np.array(segments, np.int32), "regions": np.array(seeds, float)}


def spiral():
    angle = np.linspace(0.4, 4.2 * np.pi, 40)
    radius = angle / 10
    return {"vertices": np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1)}


def diamond():
    side = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)], float)
    return {"vertices": np.concatenate([side, side / 2 + 0.02, [(0.02, -0.01)]])}


def ell():
    return of_rings([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])


def dots():
    return {"vertices": np.random.RandomState(0).uniform(size=(32, 2))}


def square_circle_hole():
    return of_rings([(-2, -2), (2, -2), (2, 2), (-2, 2)], circle(32, (0.4, 0.3), 0.8), holes=[(0.4, 0.3)])


def meshed(name, switches):
    def make():
        from .triangle import triangulate

        return triangulate(data(name), switches)

    return make


def bounded_box():
    """A mesh with a bound on the area of one triangle."""
    mesh = data("box.1")
    areas = np.full((len(mesh["triangles"]), 1), -1.0)
    areas[0] = 0.02
    return mesh | {"triangle_max_area": areas}


EXAMPLES = {
    "A": letter_a, "box": box, "box.1": meshed("box", "pc"), "box.2": meshed("box.1", "rpa0.2"), "box.3": meshed("box.2", "rpa0.05"),
    "box.4": meshed("box.3", "rpa0.0125"), "bbox.1": bounded_box, "diamond_02_00009": diamond, "dots": dots,
    "double_hex": lambda: double_hex(18, 12), "double_hex2": lambda: double_hex(9, 6), "double_hex3": lambda: double_hex(1, 6),
    "ell": ell, "face": face, "la": soil, "spiral": spiral, "spiral.1": meshed("spiral", ""), "spiral.q.1": meshed("spiral", "q"),
    "spiral.r.1": meshed("spiral", "q32.5"), "square_circle_hole": square_circle_hole,
}


def data(name):
    if name not in EXAMPLES:
        raise KeyError(f"there is no example '{name}'; there are {', '.join(EXAMPLES)}")
    return EXAMPLES[name]()
