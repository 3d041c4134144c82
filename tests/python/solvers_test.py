"""Meshes handed to solvers in memory, on the ranks that mpiexec has started: Poisson problems against their exact solution."""

import importlib.util
import unittest

import driftmesh
import numpy as np
from mpi4py import MPI

WORLD = MPI.COMM_WORLD
CORNERS = [(0, 0), (0.5, 0), (1, 0), (1, 1), (0.5, 1), (0, 1)]
SIDES = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)]
MARKERS = [1, 1, 2, 3, 3, 4, 9]
SQUARE = driftmesh.Pslg(CORNERS, SIDES, segment_markers=MARKERS, regions=[(0.2, 0.5, 5, -1), (0.8, 0.5, 6, -1)],
                        marker_names={2: "inlet", 9: "in the middle", 1: "depth"}, region_names={6: "right half"})


def piece_of(area=1e-3, square=SQUARE):
    # Subdomains stay where they start, so that each rank has some.
    balance = {"balance": {"policy": "none"}} if WORLD.size > 1 else {}
    return driftmesh.mesh_distributed(WORLD, square, min_angle=28, max_area=area, subdomains={"count": 12}, **balance)


def exact(points):
    return np.sin(np.pi * points[:, 0]) * np.sin(np.pi * points[:, 1])


def gathered(values):
    return np.concatenate(WORLD.allgather(np.asarray(values)))


def counted(values):
    return dict(zip(*(array.tolist() for array in np.unique(gathered(values), return_counts=True))))


def whole_counts(piece):
    """What tags must count: edges between ranks, which both have, once."""
    edges = np.column_stack((np.sort(piece.mesh.numbers[piece.mesh.edges], axis=1), piece.mesh.edge_markers))
    return {"regions": counted(piece.mesh.regions.astype(int)),
            "markers": dict(zip(*(a.tolist() for a in np.unique(np.unique(gathered(edges), axis=0)[:, 2], return_counts=True))))}


def edges_of(piece):
    """Their number, by Euler's formula for a domain without holes."""
    return piece.total_points + piece.total_triangles - 1


class Solver(unittest.TestCase):
    def assert_second_order(self, error_on):
        coarse, fine = (error_on(piece_of(area)) for area in (4e-3, 1e-3))
        if WORLD.rank == 0:
            print(f"{type(self).__name__}, {WORLD.size} ranks: errors {coarse:.2e} and {fine:.2e}")
        self.assertLess(fine, 2e-3)
        self.assertGreater(coarse / fine, 3)

    def assert_refuses_regions(self, convert):
        halves = driftmesh.Pslg(CORNERS, SIDES, regions=[(0.2, 0.5, 5.5, -1), (0.8, 0.5, 6, -1)])
        with self.assertRaisesRegex(ValueError, "whole numbers"):
            convert(WORLD, piece_of(square=halves))


@unittest.skipUnless(importlib.util.find_spec("petsc4py"), "petsc4py is not installed")
class Petsc(Solver):
    @staticmethod
    def convert(piece):
        from driftmesh.petsc import to_dmplex
        return to_dmplex(WORLD, piece)

    @staticmethod
    def owned(plex, depth):
        leaves = plex.getPointSF().getGraph()[1] if WORLD.size > 1 else ()
        return np.setdiff1d(np.arange(*plex.getDepthStratum(depth)), leaves)

    def test_the_plex_is_the_mesh(self):
        piece = piece_of()
        plex = self.convert(piece)
        self.assertEqual([WORLD.allreduce(len(self.owned(plex, depth))) for depth in range(3)],
                         [piece.total_points, edges_of(piece), piece.total_triangles])
        self.assertEqual(np.diff(plex.getHeightStratum(0)), len(piece.mesh.triangles))
        area = sum(abs(plex.computeCellGeometryFVM(cell)[0]) for cell in range(*plex.getHeightStratum(0)))
        self.assertAlmostEqual(WORLD.allreduce(area), 1, 12)

    def test_labels(self):
        piece = piece_of()
        plex = self.convert(piece)
        counts = {"regions": counted([plex.getLabelValue("Cell Sets", p) for p in self.owned(plex, 2)]),
                  "markers": counted([plex.getLabelValue("Face Sets", p) for p in self.owned(plex, 1)])}
        counts["markers"].pop(-1)  # edges without a label
        self.assertEqual(counts, whole_counts(piece))
        # "depth" is a label of PETSc.
        for name, value, count in (("inlet", 2, counts["markers"][2]), ("in the middle", 9, counts["markers"][9]),
                                   ("right half", 6, counts["regions"][6])):
            found = counted([plex.getLabelValue(name, p) for depth in (1, 2) for p in self.owned(plex, depth)])
            self.assertEqual({v: n for v, n in found.items() if v != -1}, {value: count})
        self.assertEqual(plex.getLabelValue("depth", 0), 2)

    def test_a_star_ends_at_the_same_place(self):
        """Coordinates that owners send along the star forest are those that are there."""
        plex = self.convert(piece_of())
        here, there = plex.getCoordinatesLocal(), plex.getCoordinatesLocal().duplicate()
        everywhere = plex.getCoordinateDM().createGlobalVec()
        plex.getCoordinateDM().localToGlobal(here, everywhere)
        plex.getCoordinateDM().globalToLocal(everywhere, there)
        np.testing.assert_array_equal(here.array, there.array)

    def error_on(self, piece):
        from petsc4py import PETSc
        plex = self.convert(piece)
        start, end = plex.getDepthStratum(0)
        section = PETSc.Section().create(comm=WORLD)
        section.setChart(*plex.getChart())
        for point in range(start, end):
            section.setDof(point, 1)
        section.setUp()
        plex.setSection(section)
        points = plex.getCoordinatesLocal().array.reshape(-1, 2)
        matrix, load = plex.createMatrix(), plex.createGlobalVec()
        right, mass = plex.createLocalVec(), plex.createLocalVec()
        cells = piece.mesh.triangles
        opposite = points[cells[:, [2, 0, 1]]] - points[cells[:, [1, 2, 0]]]
        areas = np.abs(np.cross(opposite[:, 0], opposite[:, 1])) / 2
        numbers = plex.getLGMap().indices[cells].astype(PETSc.IntType)
        for number, element in zip(numbers, np.einsum("cik,cjk->cij", opposite, opposite) / (4 * areas)[:, None, None]):
            matrix.setValues(number, number, element, addv=PETSc.InsertMode.ADD_VALUES)
        matrix.assemble()
        np.add.at(mass.array, cells, areas[:, None] / 3)
        right.array[:] = 2 * np.pi**2 * exact(points) * mass.array
        plex.localToGlobal(right, load, addv=PETSc.InsertMode.ADD_VALUES)
        # A point may be on the boundary here without an edge of it, so points are asked, and not edges.
        rim = [p - start for p in range(start, end) if plex.getLabelValue("Vertex Sets", p) in (1, 2, 3, 4)]
        solution = plex.createGlobalVec()
        matrix.zeroRowsColumns(plex.getLGMap().indices[rim], 1, solution, load)
        solver = PETSc.KSP().create(WORLD)
        solver.setOperators(matrix)
        solver.setType("cg")
        solver.getPC().setType("jacobi")
        solver.setTolerances(rtol=1e-10)
        solver.solve(load, solution)
        found = plex.createLocalVec()
        plex.globalToLocal(solution, found)
        squares = WORLD.allreduce(float(((found.array - exact(points))**2 * mass.array).sum()))
        return np.sqrt(squares)

    def test_poisson(self):
        self.assert_second_order(self.error_on)

    def test_regions_are_whole_numbers(self):
        self.assert_refuses_regions(lambda _, piece: self.convert(piece))


@unittest.skipUnless(importlib.util.find_spec("dolfinx"), "dolfinx is not installed")
class Dolfinx(Solver):
    @staticmethod
    def convert(piece):
        from driftmesh.dolfinx import to_dolfinx
        return to_dolfinx(WORLD, piece)

    def test_the_domain_is_the_mesh(self):
        piece = piece_of()
        domain, cells, facets = self.convert(piece)
        domain.topology.create_connectivity(1, 2)
        maps = [domain.topology.index_map(dimension) for dimension in range(3)]
        self.assertEqual([m.size_global for m in maps], [piece.total_points, edges_of(piece), piece.total_triangles])
        self.assertEqual(maps[2].size_local, len(piece.mesh.triangles), "no triangle leaves its rank")
        self.assertEqual(maps[2].num_ghosts > 0, WORLD.size > 1)
        self.assertEqual({"regions": counted(cells.values[cells.indices < maps[2].size_local]),
                          "markers": counted(facets.values[facets.indices < maps[1].size_local])}, whole_counts(piece))
        self.assertEqual(len(cells.values), maps[2].size_local + maps[2].num_ghosts)

    def test_ghosts_are_across_every_shared_edge(self):
        """An owned edge with a single triangle is on the boundary."""
        piece = piece_of()
        domain, _, _ = self.convert(piece)
        domain.topology.create_connectivity(1, 2)
        around = domain.topology.connectivity(1, 2)
        count = domain.topology.index_map(1).size_local
        alone = sum(len(around.links(edge)) == 1 for edge in range(count))
        rim = sum(count for marker, count in whole_counts(piece)["markers"].items() if marker != 9)
        self.assertEqual(WORLD.allreduce(alone), rim)

    def error_on(self, piece):
        import ufl
        from dolfinx import fem
        from petsc4py.PETSc import ScalarType
        domain, _, facets = self.convert(piece)
        space = fem.FunctionSpace(domain, ("Lagrange", 1))
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        x = ufl.SpatialCoordinate(domain)
        solution = ufl.sin(ufl.pi * x[0]) * ufl.sin(ufl.pi * x[1])
        boundary = fem.locate_dofs_topological(space, 1, facets.indices[facets.values != 9])
        problem = fem.petsc.LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx, 2 * ufl.pi**2 * solution * v * ufl.dx,
                                          bcs=[fem.dirichletbc(ScalarType(0), boundary, space)],
                                          petsc_options={"ksp_type": "cg", "pc_type": "jacobi", "ksp_rtol": 1e-10})
        error = fem.assemble_scalar(fem.form((problem.solve() - solution)**2 * ufl.dx))
        return np.sqrt(WORLD.allreduce(error))

    def test_poisson(self):
        self.assert_second_order(self.error_on)

    def test_regions_are_whole_numbers(self):
        self.assert_refuses_regions(lambda _, piece: self.convert(piece))


if __name__ == "__main__":
    unittest.main(verbosity=2 if WORLD.rank == 0 else 0)
