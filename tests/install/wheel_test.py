#!/usr/bin/env python3
"""The wheel: pip installs it without a network, and the package works there; with the libraries that it takes carried along, also in a root
with nothing but Python and numpy, where it does what packaging/wheel/try.py asks of a wheel: mesh, check, draw, write and read.

usage: wheel_test.py BUILD_FOLDER VERSION PYTHON
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

BUILD, VERSION, PYTHON = sys.argv[1:4]
TRY = pathlib.Path(__file__).parents[2] / "packaging" / "wheel" / "try.py"

PROGRAM = """\
import driftmesh
plate = driftmesh.generate("rectangle-hole")
assert driftmesh.check(driftmesh.mesh(plate, max_area=1e-3), plate, max_area=1e-3)
print(driftmesh.__version__, driftmesh.__file__)
"""


class Wheel(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_wheel(self):
        wheel = pathlib.Path(run("cmake", "--build", BUILD, "--target", "wheel").split()[-1])
        self.assertRegex(wheel.name, rf"driftmesh-{VERSION}-cp3\d+-cp3\d+-linux_\w+.whl")
        first = wheel.read_bytes()
        shutil.copy(wheel, self.folder)
        run(PYTHON, "-m", "venv", "--system-site-packages", self.folder / "venv")  # numpy is Debian's
        python = self.folder / "venv" / "bin" / "python"
        run(python, "-m", "pip", "install", "--no-index", self.folder / wheel.name)
        said = run(python, "-c", PROGRAM, cwd=self.folder, env=ENVIRONMENT | {"PYTHONPATH": ""})
        self.assertEqual(said.split()[0], VERSION)
        self.assertIn(str(self.folder / "venv"), said.split()[1])
        files = run(python, "-m", "pip", "show", "--files", "driftmesh")
        for name in ("driftmesh/__init__.pyi", "driftmesh/py.typed", "driftmesh/_native.", "driftmesh/_ranks.", "dist-info/LICENSE"):
            self.assertIn(name, files)
        self.assertIn("Requires: numpy", files)
        run(python, "-m", "pip", "uninstall", "-y", "driftmesh")
        run("cmake", "--build", BUILD, "--target", "wheel")
        self.assertEqual(wheel.read_bytes(), first)

    @unittest.skipIf(os.geteuid() != 0, "only root may change the root")
    def test_bare_root(self):
        wheel = pathlib.Path(run("cmake", "--build", BUILD, "--target", "wheel").split()[-1])
        root = self.folder / "root"
        bare_root.make_root(root)
        with zipfile.ZipFile(wheel) as content:
            content.extractall(root / "site")
        carried = root / "carried"
        carried.mkdir()
        for library in re.findall(r"=> (/\S+)", run("ldd", next((root / "site" / "driftmesh").glob("_native*")))):
            if not list(root.rglob(pathlib.Path(library).name)):
                shutil.copy(library, carried)
        for name in ("mpirun", "mpi4py", "c++", "cmake"):
            self.assertEqual(list(root.rglob(name)), [])
        (root / "work").mkdir()
        shutil.copy(TRY, root)
        environment = bare_root.environment(root)
        environment |= {"PYTHONPATH": "/site", "LD_LIBRARY_PATH": f"{environment['LD_LIBRARY_PATH']}:/carried"}
        said = run(shutil.which("chroot"), root, "/usr/bin/python3", "-c", "import os, runpy; os.chdir('/work'); runpy.run_path('/try.py')", env=environment)
        self.assertIn(f"driftmesh {VERSION} on Python", said)
        self.assertGreater((root / "work" / "bay.svg").stat().st_size, 10_000)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
