#!/usr/bin/env python3
"""scripts/hosts.sh: several hosts on one machine. Its options, its results, and that nothing of it is
left behind, however it ends. Where hosts cannot be made, the runs exit with 77.

usage: hosts_test.py HOSTS_SH DRIFTMESH Options|Runs
"""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SCRIPT, PROGRAM = None, None


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.results = self.folder / "results"
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()

    def start(self, *arguments):
        return subprocess.Popen([SCRIPT, "--program", PROGRAM, "-o", self.results, *arguments], text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                env={**os.environ, "TMPDIR": str(self.temporary)})

    def run_script(self, *arguments, code=0):
        script = self.start(*arguments)
        said = script.communicate()[0]
        if script.returncode == 77:
            self.skipTest(said)
        self.assertEqual(script.returncode, code, said)
        return said


class Options(Case):
    def test_help_names_every_option(self):
        said = self.run_script("--help")
        for option in ("--hosts", "--latency", "--rate", "--loss", "--slow", "--dry-run"):
            self.assertIn(option, said)

    def test_wrong_options_are_reported(self):
        self.assertIn("unknown option '--host'", self.run_script("--host", "3", code=2))
        self.assertIn("--hosts is a whole number from 2 to 99, not 'many'", self.run_script("--hosts", "many", code=2))
        self.assertIn("--loss is a number from 0 to 50, not '-1'", self.run_script("--loss", "-1", code=2))
        self.assertIn("--slow needs a value", self.run_script("--slow", code=2))
        self.assertIn("--input needs --area", self.run_script("--input", "a.poly", code=2))

    def test_a_missing_program_is_reported(self):
        self.assertIn("no /nowhere/driftmesh", self.run_script("--program", "/nowhere/driftmesh", code=1))

    def test_a_dry_run_prints_and_does_nothing(self):
        said = self.run_script("--dry-run", "--hosts", "2", "--slots", "2", "--latency", "3", "--slow", "0.25")
        self.assertIn("$ ip netns add host2\n", said)
        self.assertIn("netem delay 3ms rate 1000mbit loss 0.1%", said)
        self.assertIn("host2 slots=2", said)
        self.assertIn("mpirun --hostfile hostfile -n 4", said)
        self.assertIn("--drag 1,1,0.25,0.25", said)
        self.assertFalse(self.results.exists())
        self.assertEqual(list(self.temporary.iterdir()), [])


class Runs(Case):
    """Each with a look at what the machine has before and after."""

    def setUp(self):
        super().setUp()
        before = self.network()
        self.addCleanup(lambda: self.assertEqual(self.network(), before))
        self.addCleanup(lambda: self.assertEqual(list(self.temporary.iterdir()), []))
        self.addCleanup(lambda: self.assertEqual(self.processes_soon(), []))

    @staticmethod
    def network():
        names = pathlib.Path("/run/netns")
        return sorted(os.listdir("/sys/class/net")), sorted(os.listdir(names)) if names.exists() else None

    def processes(self):
        """The processes that the script has started, identified by their environment."""
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if bytes(self.temporary) in (process / "environ").read_bytes():
                    found.append((process.name, (process / "cmdline").read_bytes()))
            except OSError:
                pass
        return found

    def processes_soon(self):
        """What is left after the kernel has had time to end everything."""
        for _ in range(100):
            if not self.processes():
                break
            time.sleep(0.1)
        return self.processes()

    def test_several_hosts_make_the_same_mesh_as_one(self):
        subprocess.run([PROGRAM, "generate", "pipe", "-o", self.folder / "pipe.poly"], check=True)
        said = self.run_script("--input", self.folder / "pipe.poly", "--area", "2", "--loss", "1")
        for host in ("host1", "host2", "host3"):
            self.assertRegex(said, rf">:{host}\n")
            self.assertRegex(said, rf"{host}: \d+\.\d+ MB in [1-9]\d* packets")
        self.assertIn("on 3 ranks", said)
        self.assertIn("accepted: constrained Delaunay", said)
        self.assertRegex(said, r"digest of the mesh: ([0-9a-f]{16}) by 3 hosts, \1 by one")
        self.assertNotIn("may differ", said)
        self.assertEqual(sorted(p.name for p in self.results.iterdir()),
                         ["hostfile", "hosts.json", "hosts.pvtu", "hosts_0.vtu", "hosts_1.vtu", "hosts_2.vtu",
                          "one-host.json"])

    def test_points_on_shared_edges_travel(self):
        said = self.run_script("--hosts", "2", "--slots", "2", "--area", "20000", "--loss", "2", "--presplit", "off")
        self.assertRegex(said, r"[1-9][0-9,]* sent between ranks")
        self.assertIn("accepted: constrained Delaunay", said)
        self.assertIn("may differ", said)

    def test_an_error_of_the_program_is_one_of_the_script(self):
        wrong = self.folder / "wrong.poly"
        wrong.write_text("no numbers\n")
        said = self.run_script("--input", str(wrong), "--area", "1", code=1)
        self.assertIn("wrong.poly:1", said)

    def stop(self, signal_number):
        """Stops a run in the middle of refining, which takes minutes."""
        script = self.start("--area", "0.1")
        said = ""
        for line in script.stdout:
            said += line
            if "--json hosts.json" in line:
                break
        else:
            script.stdout.close()
            (self.skipTest if script.wait() == 77 else self.fail)(said)
        time.sleep(1)
        self.assertNotEqual(self.processes(), [])
        script.send_signal(signal_number)
        script.stdout.read()  # until nobody can write there any more
        script.stdout.close()
        return script.wait()

    def test_ctrl_c_takes_everything_down(self):
        self.assertEqual(self.stop(signal.SIGINT), 130)
        self.assertEqual([p.name for p in self.results.iterdir() if "hosts_" in p.name], [])

    def test_ending_takes_everything_down(self):
        self.assertEqual(self.stop(signal.SIGTERM), 143)

    def test_not_even_a_script_that_was_killed_leaves_hosts(self):
        self.assertEqual(self.stop(signal.SIGKILL), -signal.SIGKILL)
        self.assertEqual(self.processes_soon(), [])
        for folder in self.temporary.iterdir():  # files alone are left: nobody was there to remove them
            subprocess.run(["rm", "-r", folder], check=True)


if __name__ == "__main__":
    SCRIPT, PROGRAM = (os.path.abspath(sys.argv.pop(1)) for _ in range(2))
    run = unittest.main(exit=False).result
    sys.exit(1 if not run.wasSuccessful() else 77 if len(run.skipped) == run.testsRun else 0)
