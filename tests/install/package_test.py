#!/usr/bin/env python3
"""The Debian packages: their contents and dependencies, and that their programs run.

usage: package_test.py BUILD_FOLDER VERSION
"""

import pathlib
import sys
import tempfile
import unittest

from command import run

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
        self.assertFalse((root / "usr/include").exists())

    def test_library(self):
        root = self.folder / "dev"
        run("dpkg", "-x", self.package("libdriftmesh-dev"), root)
        self.assertTrue((root / "usr/include/driftmesh/driftmesh.hpp").is_file())
        self.assertEqual(len(list(root.rglob("driftmeshConfig.cmake"))), 1)
        for package in self.field("libdriftmesh-dev", "Depends").split(", "):
            run("dpkg", "-s", package)  # there is such a package: it is what this was built with
        self.assertFalse((root / "usr/bin").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
