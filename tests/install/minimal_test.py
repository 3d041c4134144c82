#!/usr/bin/env python3
"""A build with nothing but the standard library: with -DDRIFTMESH_MINIMAL=ON CMake looks for no other package but pybind11. pip builds
the same of an sdist, without calls of the system, too (-DDRIFTMESH_PORTABLE=ON): the package meshes and checks, refuses by name what takes
a library, and does so in a root with nothing but Python and numpy.

usage: minimal_test.py SOURCE_FOLDER BUILD_FOLDER COMPILER GENERATOR PYTHON [--configure]      --configure: only the first
"""

import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest
import zipfile

import bare_root
from command import ENVIRONMENT, run

SOURCE, BUILD, COMPILER, GENERATOR, PYTHON = sys.argv[1:6]
ONLY_CONFIGURE = sys.argv[6:] == ["--configure"]
PARTS = ("CAIRO", "HDF5", "JSON", "METIS", "ZLIB")
PACKAGES = ("Boost", "CLI11", "fmt", "HDF5Serial", "METIS", "MPI", "nlohmann_json", "PkgConfig", "ZLIB", "Zoltan")
HEADERS = ("boost/archive/binary_iarchive.hpp", "cairo.h", "CLI/CLI.hpp", "fmt/format.h", "gdal.h", "hdf5.h", "metis.h", "mpi.h", "nlohmann/json.hpp",
           "yaml-cpp/yaml.h", "zlib.h", "zoltan.h")

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

    def hide_headers(self, folder):
        """Those of the packages, which lie among the system's: whoever includes one gets an error."""
        for name in HEADERS:
            header = folder / name
            header.parent.mkdir(parents=True, exist_ok=True)
            header.write_text("#error a build with nothing but the standard library does without\n")
        return folder

    def check_package(self, package, work):
        work.mkdir(exist_ok=True)
        self.assertIn("all refused by name", run(PYTHON, "-c", PROGRAM, cwd=work, env=ENVIRONMENT | {"PYTHONPATH": str(package)}))

    @unittest.skipIf(ONLY_CONFIGURE, "this takes minutes")
    def test_pip_builds_from_an_sdist(self):
        folder = pathlib.Path(BUILD) / "pip"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        made = "import sys; sys.path.insert(0, sys.argv[1]); import driftmesh_backend; print(driftmesh_backend.build_sdist(sys.argv[2]))"
        sdist = folder / run(PYTHON, "-B", "-c", made, f"{SOURCE}/python/backend", folder).strip()
        define = ";".join(["CMAKE_MODULE_LINKER_FLAGS=-static-libstdc++ -static-libgcc", f"CMAKE_CXX_COMPILER={COMPILER}", "DRIFTMESH_WERROR=ON",
                           "DRIFTMESH_PORTABLE=ON", f"CMAKE_CXX_FLAGS=-I{self.hide_headers(folder / 'hidden')}",
                           "CMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", *(f"DRIFTMESH_{part}=OFF" for part in PARTS),
                           *(f"CMAKE_DISABLE_FIND_PACKAGE_{package}=TRUE" for package in PACKAGES)])
        run(PYTHON, "-m", "pip", "wheel", "--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", folder, "--config-settings",
            f"define={define}", sdist)
        wheel = next(folder.glob("*.whl"))
        self.assertRegex(wheel.name, r"^driftmesh-[\d.]+-cp3\d+-cp3\d+-manylinux_2_\d+_\w+\.whl$")
        self.assertLess(wheel.stat().st_size, 10e6)
        with zipfile.ZipFile(wheel) as content:
            content.extractall(folder / "site")
        needed = re.findall(r"(\S+) =>", run("ldd", next((folder / "site" / "driftmesh").glob("_native*"))))
        self.assertEqual({name.split(".")[0] for name in needed} - {"libc", "libm", "libdl", "librt", "libpthread"}, set())
        self.check_package(folder / "site", folder / "work")
        if os.geteuid() == 0:  # who else may change the root
            self.check_alone(folder / "site")

    def check_alone(self, package):
        with tempfile.TemporaryDirectory() as place:
            root = pathlib.Path(place)
            bare_root.make_root(root)
            for name in ("libstdc++*", "libmpi*", "libhdf5*", "libcairo*", "mpi4py"):
                self.assertEqual(list(root.rglob(name)), [])
            shutil.copytree(package, root / "site")
            (root / "work").mkdir()
            alone = f"import os, sys; os.chdir('/work'); sys.path.insert(0, '/site')\n{PROGRAM}"
            self.assertIn("all refused by name", run(shutil.which("chroot"), root, "/usr/bin/python3", "-c", alone, env=bare_root.environment(root)))
            self.assertGreater((root / "work" / "a.vtu").stat().st_size, 10_000)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
