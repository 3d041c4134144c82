"""Every error: its class, what it says, and its file and line."""

import pathlib
import tempfile
import unittest

import driftmesh
import numpy as np

PLATE = driftmesh.generate("rectangle-hole")


class Errors(unittest.TestCase):
    def refuse(self, kind, *words, call):
        with self.assertRaises(kind) as caught:
            call()
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertNotIn("MeshOptions", str(caught.exception))
        return caught.exception

    def refuse_options(self, kind, *words, **options):
        return self.refuse(kind, *words, call=lambda: driftmesh.mesh(PLATE, **options))

    def test_classes(self):
        for kind, base in ((driftmesh.InputError, ValueError), (driftmesh.FileError, OSError),
                           (driftmesh.LimitError, driftmesh.Error), (driftmesh.Cancelled, driftmesh.Error)):
            self.assertTrue(issubclass(kind, driftmesh.Error) and issubclass(kind, base), kind)
            self.assertEqual(kind.__module__, "driftmesh")

    def test_file_and_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bad.poly"
            path.write_text("4 2 0 0\n1 0 0\n2 4 0\n3 x 4\n4 0 y\n")
            error = self.refuse(driftmesh.InputError, "bad.poly:4", "bad.poly:5", call=lambda: driftmesh.read(path))
            self.assertEqual((error.file, error.line), (str(path), 4))
            path = path.with_suffix(".vtu")
            path.write_text("nonsense")
            error = self.refuse(driftmesh.InputError, "bad.vtu", call=lambda: driftmesh.read(path))
            self.assertEqual(error.file, str(path))

    def test_missing_file(self):
        error = self.refuse(driftmesh.FileError, "missing.poly", call=lambda: driftmesh.read("missing.poly"))
        self.assertEqual((error.file, error.line), ("missing.poly", None))
        self.refuse(driftmesh.FileError, "no/folder", call=lambda: PLATE.write("no/folder/plate.poly"))
        self.refuse(driftmesh.InputError, "plate.xyz", call=lambda: driftmesh.mesh(PLATE).write("plate.xyz"))

    def test_domains_without_area(self):
        self.refuse(driftmesh.InputError, "three", call=lambda: driftmesh.mesh(driftmesh.Pslg([])))
        self.refuse(driftmesh.InputError, "line", call=lambda: driftmesh.mesh(driftmesh.Pslg([(0, 0), (1, 1), (2, 2)])))

    def test_generators(self):
        self.refuse(driftmesh.InputError, "'bay'", call=lambda: driftmesh.generate("bya"))
        self.refuse(driftmesh.InputError, "'seed'", call=lambda: driftmesh.generate("bay", sede=1))
        self.refuse(driftmesh.InputError, "whole number", call=lambda: driftmesh.generate("bay", seed=1.5))
        self.refuse(driftmesh.InputError, "true or false", call=lambda: driftmesh.generate("fan", corner=1))

    def test_limits(self):
        self.refuse_options(driftmesh.LimitError, "max_triangles", max_area=1e-6, max_triangles=100)
        self.refuse_options(driftmesh.LimitError, "max_memory", max_area=1e-7, max_memory=1000)

    def test_strict(self):
        loose = driftmesh.Pslg([(0, 0), (1, 0), (0, 1), (5, 5), (6, 6)], [(0, 1), (1, 2), (2, 0), (3, 4)])
        with self.assertWarnsRegex(driftmesh.InputWarning, "no part of the domain"):
            driftmesh.mesh(loose)
        self.refuse(driftmesh.InputError, "no part of the domain", call=lambda: driftmesh.mesh(loose, strict=True))

    def test_names_of_options(self):
        self.refuse_options(TypeError, "min_angel", "'min_angle'", min_angel=20)
        self.refuse_options(TypeError, "subdomains.cuont", "'subdomains.count'", subdomains={"cuont": 2})
        self.refuse_options(TypeError, "dictionary", subdomains=2)
        for given, meant in (("area", "max_area"), ("angle", "min_angle"), ("memory", "max_memory"), ("sleep", "subdomains.sleep"),
                             ("resolution", "size_resolution"), ("policy", "balance.policy")):
            self.refuse_options(TypeError, f"'{given}'; the nearest one is '{meant}'", **{given: 1})

    def test_kinds_of_options(self):
        for options in ({"min_angle": [20]}, {"max_area": object()}, {"threads": 1.5}, {"strict": 1}, {"holes": 1},
                        {"subdomains": {"count": []}}, {"balance": {"parameters": 3}}, {"size": 0.1}, {"progress": 1}):
            self.refuse_options(TypeError, "takes", **options)
        self.refuse_options(TypeError, "speeds", ranks={"speeds": ["fast"]})

    def test_truth_values_are_no_numbers(self):
        for true in (True, False, np.True_):
            for name in ("max_triangles", "max_memory", "max_area", "min_angle", "triangles", "threads", "size_resolution", "simplify"):
                self.refuse_options(TypeError, name, "bool", **{name: true})
            self.refuse_options(TypeError, "subdomains.count", "bool", subdomains={"count": true})
            self.refuse_options(TypeError, "balance.gap", "bool", balance={"gap": true})
            self.refuse_options(TypeError, "speeds", "bool", ranks={"speeds": [1.0, true]})
            self.refuse_options(TypeError, "bool", size=lambda x, y: true)
            mesh = driftmesh.mesh(PLATE)
            for call in (lambda: driftmesh.plot(mesh, "x.png", width=true), lambda: driftmesh.plot(mesh, "x.png", height=true),
                         lambda: driftmesh.plot(mesh, "x.png", box=[0, 0, true, 2]), lambda: driftmesh.cut_domain(PLATE, true),
                         lambda: driftmesh.size_on_mesh(mesh, np.ones(len(mesh.points)), gradation=true),
                         lambda: driftmesh.simulate(PLATE, {"ranks": true}), lambda: driftmesh.Pslg([(0, 0), (1, true)]),
                         lambda: driftmesh.Mesh(mesh.points, [(0, 1, true)]),
                         lambda: driftmesh.Pslg([(0, 0)], marker_names={true: "shore"})):
                self.refuse(TypeError, "bool", call=call)

    def test_masked_arrays(self):
        """Their masked entries would be taken for numbers, whatever is stored there."""
        mesh = driftmesh.mesh(PLATE)
        masked = lambda values: np.ma.array(values, mask=np.zeros(np.shape(values), bool))
        three = [(0, 0), (1, 0), (0, 1)]
        for call in (lambda: driftmesh.Pslg(masked(three)), lambda: driftmesh.Pslg(three, masked([(0, 1)])),
                     lambda: driftmesh.Pslg(three, holes=masked([(0.1, 0.1)])), lambda: driftmesh.Pslg([masked([0, 0]), masked([1, 0])]),
                     lambda: driftmesh.Pslg(three, regions=masked([(0.1, 0.1, 1, 0)])),
                     lambda: driftmesh.Pslg(three, point_markers=masked([1, 2, 3])), lambda: driftmesh.Pslg(three, attributes=masked([1, 2, 3])),
                     lambda: driftmesh.Pslg(three, [(0, 1)], segment_markers=masked([1])),
                     lambda: driftmesh.Mesh(three, masked([(0, 1, 2)])), lambda: driftmesh.Mesh(three, [(0, 1, 2)], regions=masked([1.0])),
                     lambda: driftmesh.size_on_mesh(mesh, masked(np.ones(len(mesh.points)))),
                     lambda: driftmesh.mesh(PLATE, ranks={"speeds": masked([1.0, 2.0])}), lambda: driftmesh.Pslg([(0, 0), (1, np.ma.masked)]),
                     lambda: driftmesh.plot(mesh, "x.png", box=masked([0, 0, 1, 1]))):
            self.refuse(TypeError, "masked", call=call)
        self.refuse_options(TypeError, "Masked", size=lambda x, y: np.ma.masked)
        self.refuse_options(TypeError, "Masked", max_area=np.ma.array(0.01))

    def test_ranges_of_options(self):
        self.refuse_options(driftmesh.Error, "min_angle is 50", "34", min_angle=50)
        self.refuse_options(driftmesh.Error, "max_area is -1", max_area=-1)
        self.refuse_options(driftmesh.Error, "threads is", threads=2**40)
        self.refuse_options(ValueError, "max_triangles", max_triangles=2**70)
        self.refuse_options(driftmesh.Error, "holes is 'nets'", "'nested'", holes="nets")
        self.refuse_options(driftmesh.Error, "balance.policy", balance={"policy": "zoltan"})

    def test_every_option_is_called_by_its_name(self):
        checked = 0
        for option in driftmesh.option_table():
            section, _, entry = option["name"].rpartition(".")
            for bad in (option["least"] - 1, option["most"] + 1):
                if option["kind"] not in ("int", "float") or not abs(bad) < 2**31:
                    continue
                if option["name"] == "max_triangles" and bad == 0:  # which stands for the default
                    continue
                bad = int(bad) if option["kind"] == "int" else bad
                error = self.refuse_options(driftmesh.Error, **{section or entry: {entry: bad} if section else bad})
                self.assertTrue(str(error).startswith(f"{option['name']} is {bad:.15g}; "), error)
                self.assertNotIn("--", str(error))
                checked += 1
        self.assertGreater(checked, 15)

    def test_what_users_write_stays_as_it_is(self):
        text = "MeshOptions::max_area --area bounds.area {bounds.area}"
        with self.assertRaises(driftmesh.Error) as caught:
            driftmesh.mesh(PLATE, holes=text)
        self.assertTrue(str(caught.exception).startswith(f"holes is '{text}'; "), caught.exception)

    def test_clusters(self):
        for name in ("latency", "speed", "message_overhead"):
            error = self.refuse(driftmesh.Error, call=lambda: driftmesh.simulate(PLATE, {"ranks": 2, name: -1}, max_area=1))
            self.assertTrue(str(error).startswith(f"{name} is -1; it must be at least 0"), error)

    def test_arrays(self):
        three = [(0, 0), (1, 0), (0, 1)]
        for words, call in ((("points", "shape (2, 3)"), lambda: driftmesh.Pslg([(0, 0, 0), (1, 1, 1)])),
                            (("segments", "index 3"), lambda: driftmesh.Pslg(three, [(0, 3)])),
                            (("segments", "index -1"), lambda: driftmesh.Pslg(three, [(0, -1)])),
                            (("segment_markers", "2 entries", "1"),
                             lambda: driftmesh.Pslg(three, [(0, 1)], segment_markers=[1, 2])),
                            (("triangles", "index 3"), lambda: driftmesh.Mesh(three, [(0, 1, 3)])),
                            (("triangles", "32 bits"), lambda: driftmesh.Mesh(three, [(0, 1, 2**40)])),
                            (("regions", "2 entries"), lambda: driftmesh.Mesh(three, [(0, 1, 2)], regions=[1, 2])),
                            (("attributes", "point"), lambda: driftmesh.Mesh(three, [(0, 1, 2)], attributes=[1, 2]))):
            self.refuse(ValueError, *words, call=call)
        self.refuse(TypeError, "whole numbers", call=lambda: driftmesh.Mesh(three, [(0, 1, 2.5)]))
        self.refuse(TypeError, "numbers", call=lambda: driftmesh.Pslg([("a", "b")]))


if __name__ == "__main__":
    unittest.main(verbosity=2)
