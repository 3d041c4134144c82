"""Meshes on the ranks that mpiexec has started. Every rank runs every test."""

import pathlib
import re
import tempfile
import unittest

import driftmesh
import numpy as np
from mpi4py import MPI

WORLD = MPI.COMM_WORLD
PIPE = driftmesh.generate("pipe")
FIRST = WORLD.rank == 0
OPTIONS = {"max_area": 50.0, "subdomains": {"count": 12}}


def piece_of(**options):
    return driftmesh.mesh_distributed(WORLD, PIPE if FIRST else None, **(OPTIONS | options))


class Pieces(unittest.TestCase):
    def test_pieces_are_the_mesh(self):
        piece = piece_of()
        self.assertEqual((piece.rank, piece.ranks), (WORLD.rank, WORLD.size))
        mesh = piece.mesh
        self.assertEqual(WORLD.allreduce(len(mesh.triangles)), piece.total_triangles)
        self.assertEqual(WORLD.allreduce(int((piece.owners == piece.rank).sum())), piece.total_points)
        self.assertEqual(len(mesh.subdomains), len(mesh.triangles))
        whole = np.full((piece.total_points, 2), np.nan)
        for numbers, points in WORLD.allgather((mesh.numbers, mesh.points)):
            known = ~np.isnan(whole[numbers, 0])
            np.testing.assert_array_equal(whole[numbers][known], points[known])
            whole[numbers] = points
        self.assertFalse(np.isnan(whole).any())
        triangles = np.concatenate(WORLD.allgather(mesh.numbers[mesh.triangles]))
        alone = driftmesh.mesh(PIPE, **OPTIONS)
        self.assertEqual((len(triangles), len(whole)), (len(alone.triangles), len(alone.points)))

    def test_shared_points_are_in_the_same_order(self):
        piece = piece_of()
        self.assertEqual(sorted(piece.neighbors), [r for r in range(WORLD.size) if r != WORLD.rank])
        for rank, shared in piece.neighbors.items():
            mine = piece.mesh.numbers[shared]
            theirs = WORLD.sendrecv(mine, dest=rank, source=rank)
            np.testing.assert_array_equal(mine, theirs)

    def test_ghosts_are_the_triangles_of_others_at_own_points(self):
        piece = piece_of()
        ghosted = driftmesh.add_ghost_layer(WORLD, piece)
        mesh = ghosted.mesh
        np.testing.assert_array_equal(mesh.triangles[: ghosted.own_triangles], piece.mesh.triangles)
        np.testing.assert_array_equal(mesh.points[: ghosted.own_points], piece.mesh.points)
        np.testing.assert_array_equal(mesh.edges[: ghosted.own_edges], piece.mesh.edges)
        self.assertEqual((ghosted.rank, ghosted.ranks, len(ghosted.owners)), (WORLD.rank, WORLD.size, len(mesh.points)))
        triangles = mesh.numbers[mesh.triangles]
        everything = [(rank, number, corners) for rank, (numbers, own) in enumerate(WORLD.allgather(
            (ghosted.triangle_numbers[: ghosted.own_triangles], triangles[: ghosted.own_triangles])))
            for number, corners in zip(numbers.tolist(), map(tuple, own.tolist()))]
        self.assertEqual(sorted(number for _, number, _ in everything), list(range(piece.total_triangles)))
        own = set(piece.mesh.numbers.tolist())
        expected = {(rank, number, corners) for rank, number, corners in everything if rank != WORLD.rank and own & set(corners)}
        here = slice(ghosted.own_triangles, None)
        self.assertEqual(set(zip(mesh.ranks[here].tolist(), ghosted.triangle_numbers[here].tolist(),
                                 map(tuple, triangles[here].tolist()))), expected)
        for rank, (sent, received) in ghosted.neighbors.items():
            theirs = WORLD.sendrecv(ghosted.triangle_numbers[sent], dest=rank, source=rank)
            np.testing.assert_array_equal(ghosted.triangle_numbers[received], theirs)

    def test_a_view_outlives_its_piece(self):
        points = piece_of().mesh.points
        shared = list(piece_of().neighbors.values())
        copies = points.copy(), [s.copy() for s in shared]
        others = [piece_of() for _ in range(3)]
        np.testing.assert_array_equal(points, copies[0])
        for view, copy in zip(shared, copies[1]):
            np.testing.assert_array_equal(view, copy)
        self.assertEqual(len(others), 3)

    def test_write(self):
        with tempfile.TemporaryDirectory() as own:
            folder = pathlib.Path(WORLD.bcast(own))
            for name in ("pipe.pvtu", "pipe.msh"):
                piece = piece_of()
                driftmesh.write_distributed(WORLD, piece, folder / name)
                if FIRST:
                    self.assertTrue(driftmesh.check(driftmesh.read(folder / name), PIPE, max_area=50), name)
                WORLD.barrier()
            with self.assertRaises(driftmesh.FileError):
                driftmesh.write_distributed(WORLD, piece, folder / "no" / "pipe.pvtu")
            WORLD.barrier()

    def test_part_of_the_ranks(self):
        mine = WORLD.Split(WORLD.rank % 2)
        piece = driftmesh.mesh_distributed(mine, PIPE, max_area=100.0)
        self.assertEqual(piece.ranks, mine.size)
        mine.Free()


class Callables(unittest.TestCase):
    def test_size(self):
        piece = piece_of(max_area=0, size=lambda x, y: 8 + abs(x) / 20, size_resolution=50)
        self.assertGreater(piece.total_triangles, 2000)

    def test_exception_on_one_rank(self):
        """It comes back as it is there, and as an error on the others."""
        last = WORLD.size - 1

        def size(x, y):
            if WORLD.rank == last:
                raise LookupError("on purpose")
            return 8.0

        with self.assertRaises(LookupError if WORLD.rank == last else driftmesh.Error) as caught:
            piece_of(max_area=0, size=size, size_resolution=20)
        self.assertIn("on purpose", str(caught.exception))
        self.assertGreater(piece_of().total_triangles, 0)

    def test_cancelled_by_one_rank(self):
        with self.assertRaises(driftmesh.Cancelled):
            piece_of(max_area=0.01, progress=lambda p: WORLD.rank != 0)

    def test_policy(self):
        policy = (lambda load: []) if WORLD.size > 1 else None
        piece = piece_of(balance={"own": policy, "look": 1e-4, "gap": 1e-4})
        self.assertEqual(piece.total_triangles, piece_of().total_triangles)

    def test_one_exception_for_all(self):
        """What is wrong on one rank alone is that rank's exception, and an error with its words on the others."""
        if WORLD.size == 1:
            return
        wrong = [({"max_area": "small"}, driftmesh.Error, "max_area"), ({"min_angle": []}, TypeError, "takes a number, not list"),
                 ({"max_triangles": True}, TypeError, "takes a whole number, not bool"), ({"area": 1}, TypeError, "max_area"),
                 ({"size": 3}, TypeError, "a callable"), ({"subdomains": 3}, TypeError, "dictionary"),
                 ({"balance": {"own": 3}}, TypeError, "method plan")]
        for guilty in (0, WORLD.size - 1):
            for options, kind, words in wrong:
                mine = WORLD.rank == guilty
                with self.assertRaises(kind if mine else driftmesh.Error, msg=options) as caught:
                    piece_of(**(options if mine else {}))
                self.assertIn(words, str(caught.exception))
                self.assertTrue(mine or f"rank {guilty}: " in str(caught.exception), caught.exception)
        self.assertGreater(piece_of().total_triangles, 0)

    def test_arguments_that_are_wrong_on_one_rank(self):
        if WORLD.size == 1:
            return
        piece = piece_of()
        last = WORLD.rank == WORLD.size - 1
        for call in (lambda: driftmesh.mesh_distributed(WORLD, [1] if last else PIPE),
                     lambda: driftmesh.write_distributed(WORLD, 3 if last else piece, "x.pvtu"),
                     lambda: driftmesh.write_distributed(WORLD, piece, 3 if last else "x.pvtu"),
                     lambda: driftmesh.add_ghost_layer(WORLD, None if last else piece)):
            with self.assertRaises(TypeError if last else driftmesh.Error):
                call()
        self.assertFalse(pathlib.Path("x.pvtu").exists())

    def test_options_that_differ(self):
        if WORLD.size == 1:
            return
        for name, options in (("max_area", {"max_area": 50.0 + WORLD.rank}), ("min_angle", {"min_angle": 20 + WORLD.rank % 2}),
                              ("subdomains.count", {"subdomains": {"count": 12 + WORLD.rank}}),
                              ("size", {"size": (lambda x, y: 9.0) if FIRST else None})):
            with self.assertRaisesRegex(driftmesh.Error, f"^{name} differs between ranks: .* on rank 0, .* on rank 1"):
                piece_of(**options)

    def test_sizes_that_differ(self):
        """Sizes on the piece of each rank alone, the natural way to adapt, are not those of the other ranks."""
        mesh = piece_of().mesh
        size = driftmesh.size_on_mesh(mesh, 8 + np.abs(mesh.points[:, 0]) / 20)
        if WORLD.size == 1:
            self.assertGreater(piece_of(max_area=0, size=size).total_triangles, 0)
            return
        pattern = r"^the size field differs between ranks: at \((\S+), (\S+)\) it is (\S+) on rank 0 and (\S+) on rank (\d+); "
        with self.assertRaisesRegex(driftmesh.Error, pattern) as caught:
            piece_of(max_area=0, size=size)
        x, y, first, other, rank = map(float, re.match(pattern, str(caught.exception)).groups())
        self.assertEqual(len(set(WORLD.allgather(str(caught.exception)))), 1)
        if WORLD.rank in (0, rank):
            self.assertLess(abs(size(x, y) / (first if FIRST else other) - 1), 0.02)    # told as they are compiled

    def test_communicators(self):
        piece = piece_of()
        calls = (lambda c: driftmesh.mesh_distributed(c, PIPE), lambda c: driftmesh.add_ghost_layer(c, piece),
                 lambda c: driftmesh.write_distributed(c, piece, "x.pvtu"))
        for call in calls:
            with self.assertRaisesRegex(driftmesh.Error, "MPI_COMM_NULL"):
                call(MPI.COMM_NULL)
        if WORLD.size == 1:
            return
        half = WORLD.Split(WORLD.rank % 2)
        between = half.Create_intercomm(0, WORLD, 1 - WORLD.rank % 2)
        for call in calls:
            with self.assertRaisesRegex(driftmesh.Error, "intercommunicator"):
                call(between)
        between.Free()
        half.Free()

    def test_errors(self):
        with self.assertRaisesRegex(driftmesh.Error, "min_angle is 50"):
            piece_of(min_angle=50)
        with self.assertRaises(driftmesh.InputError):
            driftmesh.mesh_distributed(WORLD, driftmesh.Pslg([(0, 0), (1, 1), (2, 2)]), max_area=1)
        with self.assertRaisesRegex(TypeError, "mpi4py"):
            driftmesh.mesh_distributed(3, PIPE)


class Adaptive(unittest.TestCase):
    @staticmethod
    def ring(mesh, radius):
        x, y = mesh.points.T
        return 2 + 0.3 * np.abs(np.hypot(x, y) - radius)

    def make(self, **options):
        flow = driftmesh.DistributedAdaptiveMesh(WORLD, PIPE if FIRST else None, **({"max_area": 50.0, "threads": 1} | options))
        flow.attach("u", np.sin(flow.piece.mesh.points)[..., None], transfer="conserve")
        flow.attach("mass", np.ones((len(flow.piece.mesh.triangles), 3)), where="corners", transfer="conserve")
        return flow

    def check_as_alone(self, flow, alone):
        numbers = flow.piece.mesh.numbers
        np.testing.assert_array_equal(flow.piece.mesh.points, alone.mesh.points[numbers])
        np.testing.assert_array_equal(flow.field("u"), alone.field("u")[numbers])
        self.assertEqual(WORLD.allreduce(len(flow.piece.mesh.triangles)), len(alone.mesh.triangles))

    def test_the_same_as_on_one_process(self):
        alone = driftmesh.AdaptiveMesh(PIPE, max_area=50.0, threads=1)
        alone.attach("u", np.sin(alone.mesh.points)[..., None], transfer="conserve")
        flow = self.make()
        for radius in (5, 8):
            alone.adapt(self.ring(alone.mesh, radius))
            flow.spent(1.0 + WORLD.rank)
            flow.keep_old()
            before = flow.piece
            flow.adapt(self.ring(flow.piece.mesh, radius))
            self.check_as_alone(flow, alone)
            np.testing.assert_array_equal(flow.old_piece.mesh.points, before.mesh.points)
            np.testing.assert_array_equal(flow.old_piece.mesh.triangles, before.mesh.triangles)
        self.assertEqual(flow.report["generation"], 2)
        self.assertEqual(flow.fields, ["mass", "u"])
        with tempfile.TemporaryDirectory() as folder:
            path = WORLD.bcast(pathlib.Path(folder) / "flow.h5")
            flow.save(path)
            again = driftmesh.DistributedAdaptiveMesh.load(WORLD, path)
            here = driftmesh.AdaptiveMesh.load(path, threads=1)
            WORLD.barrier()
        self.check_as_alone(again, alone)
        self.check_as_alone(again, here)
        for loaded, mesh in ((again, again.piece.mesh), (here, here.mesh)):
            self.assertEqual(loaded.field("mass").shape, (len(mesh.triangles), 3))
            self.assertEqual(loaded.field("u").shape, (len(mesh.points), 2, 1))
        alone.adapt(lambda x, y: 1 + 0.2 * abs(x))
        again.adapt(lambda x, y: 1 + 0.2 * abs(x))
        self.check_as_alone(again, alone)

    def test_errors(self):
        flow = self.make()
        last = WORLD.rank == WORLD.size - 1
        count = len(flow.piece.mesh.points)
        for wrong in ("lengths", [1.0], np.full(count, np.nan)):
            with self.assertRaises((driftmesh.Error, TypeError, ValueError)):
                flow.adapt(wrong if last else np.full(count, 5.0))
        with self.assertRaises((driftmesh.Error, ValueError)):
            flow.attach("v", np.ones(count + 1 if last else count))
        if WORLD.size > 1:
            with self.assertRaisesRegex(driftmesh.Error, r"'v' has values of shape \(4\) .* on rank 0, and of shape \(2, 2\)"):
                flow.attach("v", np.ones((count, 2, 2) if last else (count, 4)))
        with self.assertRaises((driftmesh.Error, ZeroDivisionError)):
            flow.adapt(lambda x, y: 1 / 0 if last else 5.0)
        values = np.ones(count)
        if last:
            values[flow.piece.owners == WORLD.rank] = np.nan
        flow.attach("w", values, transfer="conserve")
        with self.assertRaisesRegex(driftmesh.Error, f"rank {WORLD.size - 1}: field 'w' is nan at point" if WORLD.size > 1 else "'w' is nan"):
            flow.adapt(np.full(count, 5.0))
        flow.detach("w")
        with self.assertRaisesRegex(driftmesh.Error, "^gradation is -1|: gradation is -1"):
            driftmesh.DistributedAdaptiveMesh(WORLD, PIPE, gradation=-1)
        for wrong in (lambda: flow.save(""), lambda: driftmesh.DistributedAdaptiveMesh.load(WORLD, "")):
            with self.assertRaisesRegex(driftmesh.Error, "name of the file is empty"):
                wrong()
        with self.assertRaises((driftmesh.Error, TypeError)):
            driftmesh.DistributedAdaptiveMesh(WORLD, 3 if last else PIPE)
        flow.adapt(np.full(count, 5.0))
        self.assertEqual(flow.report["generation"], 1)


if __name__ == "__main__":
    unittest.main(verbosity=2 if FIRST else 0)
