"""Meshes that follow a solution, with numpy."""

import pathlib
import tempfile
import threading
import unittest

import driftmesh
import numpy as np

PLATE = driftmesh.generate("rectangle-hole")


def areas(mesh):
    a, b, c = mesh.points[mesh.triangles].transpose(1, 0, 2)
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def front(mesh, at):
    return 0.01 + 0.3 * np.abs(mesh.points[:, 0] - at)


class Adaptive(unittest.TestCase):
    def test_follows_lengths(self):
        plate = driftmesh.AdaptiveMesh(PLATE, min_angle=25, max_area=0.01, threads=2)
        for at in (0.2, 0.3, 0.4):
            before = plate.mesh
            lengths = front(before, at)
            plate.adapt(lengths)
            mesh = plate.mesh
            size = driftmesh.size_on_mesh(before, lengths, gradation=0.2)
            report = driftmesh.check(mesh, PLATE, min_angle=25, max_area=0.01, size=lambda x, y: size(x, y), size_resolution=1)
            self.assertTrue(report, report.verdict)
            stayed = plate.stayed_points
            np.testing.assert_array_equal(mesh.points[stayed >= 0], before.points[stayed[stayed >= 0]])
            self.assertEqual(len(plate.stayed_triangles), len(mesh.triangles))
        self.assertEqual(plate.report["generation"], 3)

    def test_the_old_mesh_is_kept_on_request(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01)
        plate.adapt(front(plate.mesh, 0.2))
        with self.assertRaisesRegex(driftmesh.Error, "keep_old"):
            plate.old_mesh
        plate.keep_old()
        for at in (0.3, 0.5):
            before = plate.mesh
            plate.adapt(front(before, at))
            np.testing.assert_array_equal(plate.old_mesh.points, before.points)
            np.testing.assert_array_equal(plate.old_mesh.triangles, before.triangles)
        plate.keep_old(False)
        with self.assertRaisesRegex(driftmesh.Error, "keep_old"):
            plate.old_mesh

    def test_a_copy_of_a_field_cannot_be_taken_for_the_field(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01)
        plate.attach("u", np.zeros(len(plate.mesh.points)))
        with self.assertRaisesRegex(ValueError, "read-only"):
            plate.field("u")[0] = 1
        plate.attach("u", plate.field("u") + 1)
        self.assertEqual(plate.field("u")[0], 1)

    def test_follows_functions(self):
        plate = driftmesh.AdaptiveMesh(PLATE, size_resolution=100)
        size = lambda x, y: 0.02 + 0.2 * abs(y - 0.5)
        plate.adapt(size)
        self.assertTrue(driftmesh.check(plate.mesh, PLATE, size=size, size_resolution=100))
        coarse = len(plate.mesh.triangles)
        plate.adapt(driftmesh.size_on_mesh(plate.mesh, np.full(len(plate.mesh.points), 0.01)))
        self.assertGreater(len(plate.mesh.triangles), coarse)

    def test_fields(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.002)
        mesh, random = plate.mesh, np.random.default_rng(5)
        count = len(mesh.triangles)
        plate.attach("velocity", mesh.points * [1, -2])
        plate.attach("mass", random.uniform(1, 2, count), where="triangles", transfer="conserve")
        plate.attach("tensor", random.uniform(1, 2, (count, 3, 2)), where="corners", transfer="conserve")
        self.assertEqual(plate.field("tensor").shape, (count, 3, 2))
        masses = [areas(mesh) @ plate.field("mass"), *(areas(mesh) @ plate.field("tensor").mean(axis=1))]
        plate.adapt(front(mesh, 0.4))
        mesh = plate.mesh
        np.testing.assert_allclose(plate.field("velocity"), mesh.points * [1, -2], atol=1e-12)
        np.testing.assert_allclose([areas(mesh) @ plate.field("mass"), *(areas(mesh) @ plate.field("tensor").mean(axis=1))],
                                   masses, rtol=1e-12)
        plate.detach("mass")
        with self.assertRaisesRegex(driftmesh.Error, "no field 'mass'"):
            plate.field("mass")

    def test_lengths_from_error(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.002)
        indicators = areas(plate.mesh)
        target = np.linalg.norm(indicators) / 4
        plate.adapt(plate.lengths_from_error(indicators, target, order=1))
        self.assertLess(np.linalg.norm(areas(plate.mesh)), target)

    def test_older_arrays_stay(self):
        plate = driftmesh.AdaptiveMesh(PLATE, size_resolution=100)
        points, copy = plate.mesh.points, plate.mesh.points.copy()
        plate.adapt(np.full(len(points), 0.02))
        np.testing.assert_array_equal(points, copy)

    def test_wrong_use(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01, size_resolution=100)
        points, count = len(plate.mesh.points), len(plate.mesh.triangles)
        for lengths, text in ((np.ones(3), "3 lengths for"), (np.zeros(points), "point 0"), (np.full(points, np.nan), "point 0")):
            with self.assertRaisesRegex(driftmesh.Error, text):
                plate.adapt(lengths)
        with self.assertRaisesRegex(ValueError, "shape"):
            plate.attach("u", np.ones((points + 1, 2)))
        with self.assertRaisesRegex(ValueError, "3"):
            plate.attach("u", np.ones(count), where="corners", transfer="conserve")
        with self.assertRaisesRegex(driftmesh.Error, "not interpolated"):
            plate.attach("u", np.ones(count), where="triangles")
        with self.assertRaisesRegex(ValueError, "where"):
            plate.attach("u", np.ones(count), where="edges")
        with self.assertRaisesRegex(TypeError, "max_aera"):
            driftmesh.AdaptiveMesh(PLATE, max_aera=1)
        for wrong, text in (({"gradation": -1e-9}, "^gradation is -1e-09; it must be at least 0$"),
                            ({"coarsening": 1}, "^coarsening is 1; it must be at least 0, and below 1$"),
                            ({"longest": 0.5, "shortest": 1}, "^longest is 0.5; .* not below shortest, which is 1$")):
            with self.assertRaisesRegex(driftmesh.Error, text):
                driftmesh.AdaptiveMesh(PLATE, **wrong)
        with self.assertRaisesRegex(driftmesh.Error, "name of the file is empty"):
            plate.save("")
        with self.assertRaisesRegex(driftmesh.Error, "name of the file is empty"):
            driftmesh.AdaptiveMesh.load("")

    def test_a_value_that_cannot_be_conserved_is_refused(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01)
        points, count = len(plate.mesh.points), len(plate.mesh.triangles)
        before, lengths = plate.mesh.triangles.copy(), np.full(points, 0.05)
        for where, shape, place in (("points", (points, 2), (7, 1)), ("triangles", count, 7), ("corners", (count, 3), (7, 2))):
            for wrong in (np.nan, np.inf, -np.inf, 1e300):
                values = np.ones(shape)
                values[place] = wrong
                plate.attach("mass", values, where=where, transfer="conserve")
                kind = "point" if where == "points" else "triangle"
                with self.assertRaisesRegex(driftmesh.Error, f"^field 'mass' is {wrong:g} at {kind} 7 ".replace("+", r"\+")):
                    plate.adapt(lengths)
                np.testing.assert_array_equal(plate.mesh.triangles, before)
                np.testing.assert_array_equal(plate.field("mass"), values)
        plate.detach("mass")
        values = np.ones(points)
        values[7] = np.nan
        plate.attach("gauge", values)
        plate.adapt(lengths)
        self.assertTrue(np.isnan(plate.field("gauge")).any())

    def test_a_limit_leaves_the_mesh_as_it_was(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01, max_triangles=400)
        before = plate.mesh.triangles.copy()
        with self.assertRaisesRegex(driftmesh.LimitError, r"max_triangles.*\. The mesh is as it was$"):
            plate.adapt(np.full(len(plate.mesh.points), 0.02))
        np.testing.assert_array_equal(plate.mesh.triangles, before)

    def test_a_mesh_alone_is_no_session(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "plate.h5"
            driftmesh.mesh(PLATE, max_area=0.01).write(path)
            with self.assertRaisesRegex(driftmesh.InputError, "plate.h5: is a mesh alone, not an adaptive mesh; give"):
                driftmesh.AdaptiveMesh.load(path)

    def test_saved_and_loaded(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01, threads=1)
        plate.attach("u", np.sin(plate.mesh.points), transfer="conserve")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "plate.h5"
            plate.save(path)
            again = driftmesh.AdaptiveMesh.load(path, threads=1)
            with self.assertRaises(TypeError):
                driftmesh.AdaptiveMesh.load(path, treads=1)
            path.write_text("nothing")
            with self.assertRaisesRegex(driftmesh.InputError, "plate.h5"):
                driftmesh.AdaptiveMesh.load(path)
        self.assertEqual(again.fields, ["u"])
        for mesh in (plate, again):
            mesh.adapt(0.02 + 0.1 * np.abs(mesh.mesh.points[:, 0]))
        np.testing.assert_array_equal(plate.mesh.triangles, again.mesh.triangles)
        np.testing.assert_array_equal(plate.field("u"), again.field("u"))

    def test_a_loaded_field_has_its_shape(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01)
        points, count, random = len(plate.mesh.points), len(plate.mesh.triangles), np.random.default_rng(3)
        shapes = {"points": [(), (1,), (2,), (2, 2), (1, 3, 1)], "triangles": [(), (1,), (3,)], "corners": [(), (1,), (2,)]}
        for where, trailing in shapes.items():
            places = {"points": (points,), "triangles": (count,), "corners": (count, 3)}[where]
            for shape in trailing:
                plate.attach(f"{where}{shape}", random.random(places + shape), where=where, transfer="conserve")
        plate.attach("now a number", np.ones((points, 1)))
        plate.attach("now a number", np.ones(points))
        plate.attach("gone", np.ones((points, 1)))
        plate.detach("gone")
        self.assertEqual(plate.field("points(2, 2)").shape, (points, 2, 2))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "plate.h5"
            plate.save(path)
            again = driftmesh.AdaptiveMesh.load(path)
            again.save(path)
            again = driftmesh.AdaptiveMesh.load(path)
        self.assertEqual(again.fields, plate.fields)
        for mesh in (plate, again):
            self.assertEqual(mesh.field("now a number").ndim, 1)
            mesh.adapt(np.full(points, 0.05))
        for name in plate.fields:
            np.testing.assert_array_equal(again.field(name), plate.field(name), name, strict=True)

    def test_not_within_itself(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01, size_resolution=100)
        before = plate.mesh.triangles.copy()
        with self.assertRaisesRegex(driftmesh.Error, "at work"):
            plate.adapt(lambda x, y: plate.adapt(np.ones(3)) or 0.1)
        with self.assertRaises(ZeroDivisionError):
            plate.adapt(lambda x, y: 1 / 0)
        np.testing.assert_array_equal(plate.mesh.triangles, before)
        plate.adapt(lambda x, y: 0.05)
        self.assertEqual(plate.report["generation"], 1)

    def test_one_thread_at_a_time(self):
        plate = driftmesh.AdaptiveMesh(PLATE, max_area=0.01, size_resolution=100)
        begun, raised = threading.Event(), []

        def use():
            begun.wait()
            try:
                plate.mesh
            except driftmesh.Error as error:
                raised.append(str(error))

        other = threading.Thread(target=use)
        other.start()

        def size(x, y):
            if not begun.is_set():
                begun.set()
                other.join()
            return 0.1

        plate.adapt(size)
        self.assertEqual(len(raised), 1)


if __name__ == "__main__":
    unittest.main()
