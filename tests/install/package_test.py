#!/usr/bin/env python3
"""The Debian packages: their contents and dependencies, and that their programs run.

usage: package_test.py BUILD_FOLDER VERSION
"""

import pathlib
import sys
import tempfile
import unittest

from command import ENVIRONMENT, run

BUILD, VERSION = sys.argv[1:3]


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        run("cpack", "-G", "DEB", "--config", f"{BUILD}/CPackConfig.cmake", "-B", cls.folder)

    def package(self, name):
        return next(self.folder.glob(f"{name}_{VERSION}_*.deb"))

    def field(self, name, field):
        return run("dpkg-deb", "-f", self.package(name), field).strip()

    def test_program(self):
        root = self.folder / "root"
        run("dpkg", "-x", self.package("driftmesh"), root)
        self.assertIn(VERSION, run(root / "usr/bin/driftmesh", "--version"))
        for library in ("libopenmpi3", "libtrilinos-zoltan", "libyaml-cpp", "libcairo2"):
            self.assertIn(library, self.field("driftmesh", "Depends"))
        self.assertNotIn("gdal", self.field("driftmesh", "Depends"))  # which is loaded only when a file needs it
        self.assertFalse((root / "usr/include").exists())

    def test_library(self):
        root = self.folder / "dev"
        run("dpkg", "-x", self.package("libdriftmesh-dev"), root)
        self.assertTrue((root / "usr/include/driftmesh/driftmesh.hpp").is_file())
        self.assertEqual(len(list(root.rglob("driftmeshConfig.cmake"))), 1)
        for package in self.field("libdriftmesh-dev", "Depends").split(", "):
            run("dpkg", "-s", package)  # there is such a package: it is what this was built with
        self.assertFalse((root / "usr/bin").exists())

    def test_python(self):
        if not next(self.folder.glob("python3-driftmesh_*"), None):
            self.skipTest("the Python package was not built")
        root = self.folder / "python"
        run("dpkg", "-x", self.package("python3-driftmesh"), root)
        for package in ("libopenmpi3", "python3-numpy", "python3 (>= 3."):
            self.assertIn(package, self.field("python3-driftmesh", "Depends"))
        self.assertFalse((root / "usr/bin").exists())
        said = run("/usr/bin/python3", "-c", "import driftmesh; print(driftmesh.__version__, driftmesh.__file__)",
                   env=ENVIRONMENT | {"PYTHONPATH": f"{root}/usr/lib/python3/dist-packages"})
        self.assertEqual(said.split(), [VERSION, f"{root}/usr/lib/python3/dist-packages/driftmesh/__init__.py"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
