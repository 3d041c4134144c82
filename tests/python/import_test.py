"""What `import driftmesh` loads, and the module of ranks, which is loaded when it is first asked for."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import driftmesh

FOLDER = pathlib.Path(driftmesh.__file__).parent

LOADED = """\
import sys
import driftmesh
def is_loaded(library):
    return library in open("/proc/self/maps").read()
assert "numpy" not in sys.modules and "mpi4py" not in sys.modules and not is_loaded("libmpi") and not is_loaded("zoltan")
assert driftmesh.check(driftmesh.mesh(driftmesh.generate("rectangle-hole")))
assert "driftmesh._ranks" not in sys.modules and not is_loaded("libmpi")
assert {"mesh_distributed", "simulate", "SimulatedRun"} <= set(dir(driftmesh)) & set(driftmesh.__all__)
assert driftmesh.simulate.__doc__.startswith("simulate(")
assert "driftmesh._ranks" in sys.modules and is_loaded("libmpi") and driftmesh.simulate is driftmesh._ranks.simulate
assert "mpi4py" not in sys.modules
run = driftmesh.simulate(driftmesh.generate("rectangle-hole"), {"ranks": 2}, max_area=1e-2, balance={"own": lambda load: [(s, 1) for s in load.subdomains]})
assert run.triangles > 0
"""


class Import(unittest.TestCase):
    def run_program(self, program, path=FOLDER.parent):
        done = subprocess.run([sys.executable, "-c", program], env={"PYTHONPATH": str(path), "OMPI_ALLOW_RUN_AS_ROOT": "1",
                                                                     "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"},
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        return done.stdout

    def test_loads_ranks_when_they_are_asked_for(self):
        self.run_program(LOADED)

    def test_import_takes_a_tenth_of_a_second(self):
        """In processor time, one of twenty, since others work here, too."""
        timed = "import time; t = time.process_time(); import driftmesh; print(time.process_time() - t)"
        self.assertTrue(any(float(self.run_program(timed)) < 0.1 for _ in range(20)))

    def test_unknown_names(self):
        with self.assertRaisesRegex(AttributeError, "no attribute 'mesh_distribute'"):
            driftmesh.mesh_distribute  # pylint: disable=pointless-statement

    def test_ranks_that_cannot_be_loaded(self):
        program = ("import sys, driftmesh\nsys.modules['driftmesh._ranks'] = None\n"
                   "try: driftmesh.simulate\nexcept ImportError as error: print(error)")
        said = self.run_program(program)
        self.assertIn("driftmesh.simulate needs MPI, which cannot be loaded (", said)
        self.assertEqual(said.count("\n"), 1)

    def test_package_without_ranks(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(FOLDER, pathlib.Path(folder) / "driftmesh", ignore=shutil.ignore_patterns("_ranks*", "__pycache__"))
            said = self.run_program("import driftmesh\nassert 'simulate' not in driftmesh.__all__\nfrom driftmesh import *\nassert mesh\n"
                                    "try: driftmesh.mesh_distributed\nexcept ImportError as error: print(error)", folder)
        self.assertIn("driftmesh.mesh_distributed needs MPI, which this package was built without; ", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
