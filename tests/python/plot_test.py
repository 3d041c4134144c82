"""Pictures."""

import pathlib
import tempfile
import unittest

import driftmesh

PLATE = driftmesh.generate("rectangle-hole")
STARTS = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}


class Plot(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_formats(self):
        mesh = driftmesh.mesh(PLATE)
        for what in (mesh, PLATE):
            for extension, start in STARTS.items():
                path = self.folder / f"plate{extension}"
                driftmesh.plot(what, path)
                self.assertTrue(path.read_bytes().startswith(start), extension)

    def test_options(self):
        mesh = driftmesh.mesh(PLATE, max_area=1e-3, subdomains={"count": 5})
        pictures = set()
        for options in ({}, {"color": "area"}, {"color": "subdomain"}, {"color": "none"}, {"edges": "off"}, {"title": "plate"},
                        {"width": 500}, {"width": 500, "height": 700}, {"box": (0, 0, 0.5, 0.5)}):
            driftmesh.plot(mesh, self.folder / "plate.svg", **options)
            pictures.add((self.folder / "plate.svg").read_bytes())
        self.assertEqual(len(pictures), 9)

    def test_notebook(self):
        for what in (PLATE, driftmesh.mesh(PLATE)):
            self.assertTrue(what._repr_png_().startswith(STARTS[".png"]))

    def test_errors(self):
        mesh = driftmesh.mesh(PLATE)
        for error, words, options in (
                (driftmesh.Error, "'area'", {"color": "aera"}), (driftmesh.Error, "'off'", {"edges": "of"}),
                (driftmesh.Error, "x0 < x1", {"box": (1, 1, 0, 0)}), (driftmesh.Error, "2 numbers", {"box": (1, 1)}),
                (driftmesh.InputError, "rank", {"color": "rank"}), (driftmesh.InputError, "from .0, 0.", {"box": (5, 5, 6, 6)})):
            with self.assertRaisesRegex(error, words):
                driftmesh.plot(mesh, self.folder / "plate.png", **options)
        with self.assertRaisesRegex(driftmesh.InputError, "plate.gif"):
            driftmesh.plot(mesh, self.folder / "plate.gif")
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
