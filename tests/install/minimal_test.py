#!/usr/bin/env python3
"""A build with nothing but the standard library: with -DDRIFTMESH_MINIMAL=ON CMake looks for no other package but pybind11, the
library and the Python package are built, mesh and check, and refuse by name what takes a library.

usage: minimal_test.py SOURCE_FOLDER BUILD_FOLDER COMPILER GENERATOR PYTHON [--configure]      --configure: only the first
"""

import pathlib
import sys
import unittest

from command import ENVIRONMENT, run

SOURCE, BUILD, COMPILER, GENERATOR, PYTHON = sys.argv[1:6]
ONLY_CONFIGURE = sys.argv[6:] == ["--configure"]
PACKAGES = ("Boost", "CLI11", "fmt", "HDF5Serial", "METIS", "MPI", "nlohmann_json", "PkgConfig", "ZLIB", "Zoltan")

PROGRAM = """\
import os, sys, driftmesh
bay = driftmesh.generate("bay", seed=7)
mesh = driftmesh.mesh(bay, min_angle=25, subdomains={"count": 8}, max_area=20_000)
assert driftmesh.check(mesh, bay, min_angle=25, max_area=20_000)
assert "numpy" not in sys.modules
for name in ("a.vtu", "a.msh", "a.su2", "a.mesh", "a.14", "a.node"):
    mesh.write(name)
def refused(library, part, call, *arguments):
    try:
        call(*arguments)
    except driftmesh.InputError as error:
        said = str(error)
        assert f"takes {library}, which this driftmesh was built without" in said and f"-DDRIFTMESH_{part}=ON" in said, said
    else:
        raise AssertionError(f"{arguments} should take {library}")
open("a.geojson", "w").write("{}")
refused("HDF5", "HDF5", mesh.write, "a.h5")
refused("HDF5", "HDF5", driftmesh.read, "a.h5")
refused("nlohmann-json", "JSON", driftmesh.read, "a.geojson")
refused("cairo", "CAIRO", driftmesh.plot, mesh, "a.png")
refused("cairo", "CAIRO", driftmesh.plot, bay, "a.svg")
assert not os.path.exists("a.png") and not os.path.exists("a.h5")
try:
    driftmesh.mesh_distributed
except ImportError as error:
    assert "driftmesh.mesh_distributed needs MPI, which this package was built without" in str(error), error
else:
    raise AssertionError("should need MPI")
print("all refused by name")
"""


class Minimal(unittest.TestCase):
    def configure(self, folder):
        return run("cmake", "--fresh", "-G", GENERATOR, "-S", SOURCE, "-B", folder, f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DDRIFTMESH_MINIMAL=ON",
                   "-DDRIFTMESH_PYTHON=ON", "-DDRIFTMESH_WERROR=ON", "-Wno-dev",
                   *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{package}=TRUE" for package in PACKAGES))

    def test_configures(self):
        """And with a part, it looks for that."""
        folder = pathlib.Path(BUILD) / "configured"
        self.configure(folder)
        with self.assertRaisesRegex(AssertionError, "METIS"):
            run("cmake", "-S", SOURCE, "-B", folder, "-DDRIFTMESH_METIS=ON")
        with self.assertRaisesRegex(AssertionError, "DRIFTMESH_MPI takes DRIFTMESH_"):
            run("cmake", "-S", SOURCE, "-B", folder, "-DDRIFTMESH_METIS=OFF", "-DDRIFTMESH_MPI=ON")

    @unittest.skipIf(ONLY_CONFIGURE, "this takes minutes")
    def test_builds(self):
        folder = pathlib.Path(BUILD) / "built"
        self.configure(folder)
        run("cmake", "--build", folder, "-j", "2")
        work = folder / "work"
        work.mkdir(exist_ok=True)
        said = run(PYTHON, "-c", PROGRAM, cwd=work, env=ENVIRONMENT | {"PYTHONPATH": str(folder / "python")})
        self.assertIn("all refused by name", said)
        needed = run("ldd", next((folder / "python" / "driftmesh").glob("_native*")))
        for library in ("libmpi", "libhdf5", "libcairo", "libmetis", "libz.", "libfmt", "libboost"):
            self.assertNotIn(library, needed)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
