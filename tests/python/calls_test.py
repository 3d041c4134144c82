"""Calls back into Python: sizes, progress and warnings, their exceptions, threads, and Ctrl-C."""

import signal
import subprocess
import sys
import textwrap
import threading
import unittest

import driftmesh
import numpy as np

PLATE = driftmesh.generate("rectangle-hole")


class Broken(Exception):
    pass


def breaks(*_):
    raise Broken("on purpose")


class Size(unittest.TestCase):
    def test_size(self):
        size = lambda x, y: 0.02 + 0.1 * np.hypot(x - 1, y - 0.5)
        mesh = driftmesh.mesh(PLATE, size=size, size_resolution=100)
        self.assertGreater(len(mesh.triangles), 2 * len(driftmesh.mesh(PLATE).triangles))
        self.assertTrue(driftmesh.check(mesh, PLATE, size=size, size_resolution=100))

    def test_on_a_mesh(self):
        coarse = driftmesh.mesh(PLATE, max_area=1e-2)
        x, y = coarse.points.T
        size = driftmesh.size_on_mesh(coarse, 0.02 + 0.1 * np.hypot(x - 1, y - 0.5))
        self.assertAlmostEqual(size(*coarse.points[7]), 0.02 + 0.1 * np.hypot(x[7] - 1, y[7] - 0.5), places=12)
        mesh = driftmesh.mesh(PLATE, size=size)
        self.assertTrue(driftmesh.check(mesh, PLATE, size=size))
        self.assertLess(abs(len(driftmesh.mesh(PLATE, size=lambda x, y: 0.02 + 0.1 * np.hypot(x - 1, y - 0.5),
                                               size_resolution=50).triangles) - len(mesh.triangles)), len(mesh.triangles) / 10)
        graded = driftmesh.size_on_mesh(coarse, np.where(x < 0.1, 0.01, 1.0), gradation=0.1)
        self.assertLess(graded(1, 0.1), 0.2)
        threads = [driftmesh.mesh(PLATE, size=size, threads=n, subdomains={"count": 40}).triangles for n in (1, 3)]
        np.testing.assert_array_equal(*threads)

    def test_errors_on_a_mesh(self):
        mesh = driftmesh.mesh(PLATE)
        for lengths in (np.ones(3), np.zeros(len(mesh.points)), np.full(len(mesh.points), np.nan)):
            with self.assertRaises(driftmesh.Error):
                driftmesh.size_on_mesh(mesh, lengths)
        with self.assertRaisesRegex(driftmesh.Error, "gradation"):
            driftmesh.size_on_mesh(mesh, np.ones(len(mesh.points)), gradation=-1)

    def test_grid_of_values_is_as_fine_as_asked(self):
        points = []
        driftmesh.mesh(PLATE, size=lambda x, y: points.append((x, y)) or 1.0, size_resolution=10)
        self.assertLess(len(points), 5000)

    def test_exceptions_come_back_as_they_are(self):
        with self.assertRaisesRegex(Broken, "on purpose"):
            driftmesh.mesh(PLATE, size=breaks)
        with self.assertRaisesRegex(Broken, "on purpose"):
            driftmesh.mesh(PLATE, max_area=1e-3, progress=breaks)
        with self.assertRaisesRegex(TypeError, "takes a number, not str"):
            driftmesh.mesh(PLATE, size=lambda x, y: "small")
        with self.assertRaisesRegex(driftmesh.Error, "must be positive"):
            driftmesh.mesh(PLATE, size=lambda x, y: 0.0)

    def test_by_several_threads(self):
        """Other threads than the calling one can ask only if it has let go of the interpreter."""
        callers = set()

        def size(x, y):
            callers.add(threading.get_ident())
            return 0.02

        options = {"size": size, "size_resolution": 20, "subdomains": {"count": 60}}
        one = driftmesh.mesh(PLATE, **options)
        self.assertEqual(callers, {threading.get_ident()})
        several = driftmesh.mesh(PLATE, threads=3, **options)
        self.assertGreater(len(callers), 1)
        np.testing.assert_array_equal(one.triangles, several.triangles)

    def test_exceptions_of_several_threads(self):
        calling = threading.get_ident()

        def size(x, y):
            if threading.get_ident() != calling:
                breaks()
            return 0.02

        with self.assertRaises(Broken):
            driftmesh.mesh(PLATE, size=size, size_resolution=20, threads=3, subdomains={"count": 60})


class Threads(unittest.TestCase):
    def test_meshes_at_the_same_time(self):
        """Each waits in its first call of progress until both have come that far."""
        both = threading.Barrier(2, timeout=60)
        waited, made = set(), {}

        def work(name, area):
            def progress(_):
                if name not in waited:
                    waited.add(name)
                    both.wait()
            made[name] = driftmesh.mesh(PLATE, max_area=area, progress=progress)

        threads = [threading.Thread(target=work, args=(area, area)) for area in (1e-3, 2e-3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for area, mesh in made.items():
            np.testing.assert_array_equal(mesh.points, driftmesh.mesh(PLATE, max_area=area).points)
        self.assertEqual(len(made), 2)


class Progress(unittest.TestCase):
    def test_progress(self):
        seen = []
        driftmesh.mesh(PLATE, max_area=1e-4, progress=lambda p: seen.append((p.triangles, p.forecast)))
        self.assertGreater(len(seen), 0)
        self.assertGreater(seen[0][1], 10_000)

    def test_cancelled(self):
        with self.assertRaises(driftmesh.Cancelled):
            driftmesh.mesh(PLATE, max_area=1e-4, progress=lambda p: False)
        driftmesh.mesh(PLATE, max_area=1e-2, progress=lambda p: True)


class Warnings(unittest.TestCase):
    LOOSE = driftmesh.Pslg([(0, 0), (1, 0), (0, 1), (5, 5), (6, 6)], [(0, 1), (1, 2), (2, 0), (3, 4)])

    def test_callable(self):
        said = []
        driftmesh.mesh(self.LOOSE, warning=said.append)
        self.assertEqual(len(said), 1)
        self.assertIn("no part of the domain", said[0])

    def test_warnings_of_python(self):
        with self.assertWarnsRegex(driftmesh.InputWarning, "no part of the domain"):
            driftmesh.mesh(self.LOOSE)
        with self.assertRaises(Broken):
            driftmesh.mesh(self.LOOSE, warning=breaks)


class Interrupt(unittest.TestCase):
    """Ctrl-C in a program that would work for hours. It says when it works; the signal is sent then."""

    def interrupted(self, options):
        program = textwrap.dedent(f"""\
            import driftmesh
            plate = driftmesh.generate("rectangle-hole")
            def started(*_):
                print("working", flush=True)
                return True
            try:
                driftmesh.mesh(plate, {options})
            except KeyboardInterrupt:
                print("interrupted", len(driftmesh.mesh(plate).triangles) > 10)
            """)
        with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
            self.assertEqual(run.stdout.readline(), "working\n")
            run.send_signal(signal.SIGINT)
            try:
                output, errors = run.communicate(timeout=120)
            finally:
                run.kill()
        self.assertTrue(output.endswith("interrupted True\n"), output[-200:] + errors)

    def test_while_the_library_works(self):
        self.interrupted("max_area=1e-8, max_memory=10**15, subdomains={'count': 1}, progress=started")

    def test_on_threads(self):
        self.interrupted("max_area=1e-8, max_memory=10**15, threads=2, progress=started")

    def test_while_python_works(self):
        self.interrupted("size=lambda x, y: started() and 2e-4, max_memory=10**15, subdomains={'count': 1}")


if __name__ == "__main__":
    unittest.main(verbosity=2)
