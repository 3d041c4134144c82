"""Every error: its class, what it says, and its file and line."""

import pathlib
import tempfile
import unittest

import driftmesh

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

    def test_kinds_of_options(self):
        for options in ({"min_angle": [20]}, {"max_area": object()}, {"threads": 1.5}, {"strict": 1}, {"holes": 1},
                        {"subdomains": {"count": []}}, {"balance": {"parameters": 3}}, {"size": 0.1}, {"progress": 1}):
            self.refuse_options(TypeError, "takes", **options)
        self.refuse_options(TypeError, "speeds", ranks={"speeds": ["fast"]})

    def test_ranges_of_options(self):
        self.refuse_options(driftmesh.Error, "min_angle is 50", "34", min_angle=50)
        self.refuse_options(driftmesh.Error, "max_area is -1", max_area=-1)
        self.refuse_options(driftmesh.Error, "threads is", threads=2**40)
        self.refuse_options(ValueError, "max_triangles", max_triangles=2**70)
        self.refuse_options(driftmesh.Error, "holes is 'nets'", "'nested'", holes="nets")
        self.refuse_options(driftmesh.Error, "balance.policy", balance={"policy": "zoltan"})

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
