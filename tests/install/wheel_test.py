#!/usr/bin/env python3
"""The wheel: pip installs it without a network, and the package works there.

usage: wheel_test.py BUILD_FOLDER VERSION PYTHON
"""

import pathlib
import shutil
import sys
import tempfile
import unittest

from command import ENVIRONMENT, run

BUILD, VERSION, PYTHON = sys.argv[1:4]

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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
