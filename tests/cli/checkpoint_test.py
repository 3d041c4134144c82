#!/usr/bin/env python3
"""Runs that end before their time, and go on from a checkpoint on other ranks and threads: --checkpoint, --resume.

usage: checkpoint_test.py DRIFTMESH [unittest options]
"""

import json
import os
import signal
import subprocess
import time

import program

REQUEST = ("--generate", "pipe", "--area", "1.5", "--presplit", "off", "-n", "30")
SLOW = ("--generate", "pipe", "--area", "0.05", "--presplit", "off", "-n", "30")


class Checkpoints(program.Cli):
    def record(self):
        return json.loads((self.folder / "run.json").read_text())

    def digest_of(self, *arguments, ranks=None):
        command = ("mesh", *arguments, "--quiet", "--json", "run.json")
        if ranks is None:
            self.succeed(*command)
        else:
            result = self.on_ranks(ranks, *command)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return self.record()["mesh"]["digest"]

    def stopped_by_limit(self, ranks=None):
        """Leaves run.kept with most of a mesh, whose digest and size it returns."""
        whole = self.digest_of(*REQUEST, "--reproducible")
        most = int(self.record()["mesh"]["triangles"] * 0.9)
        command = ("mesh", *REQUEST, "--checkpoint", "run.kept", "--max-triangles", str(most))
        result = self.run_program(*command) if ranks is None else self.on_ranks(ranks, *command)
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        self.assertIn("go on with driftmesh mesh --resume run.kept", result.stderr)
        self.assertIn("--max-triangles", result.stderr)
        self.assertEqual(self.files(), ["run.json", "run.kept"])
        return whole

    def test_what_a_limit_stops_goes_on_anywhere(self):
        whole = self.stopped_by_limit()
        self.assertEqual(self.digest_of("--resume", "run.kept", "--threads", "1"), whole)
        self.assertEqual(self.digest_of("--resume", "run.kept", "--threads", "3", "--sleep"), whole)
        for ranks in (1, 3):
            self.assertEqual(self.digest_of("--resume", "run.kept", ranks=ranks), whole)
        self.assertEqual(self.digest_of("--resume", "run.kept", "--scratch", "."), whole)

    def test_what_ranks_leave_goes_on_anywhere(self):
        whole = self.stopped_by_limit(ranks=3)
        self.assertEqual(self.digest_of("--resume", "run.kept", "--threads", "2"), whole)
        result = self.on_ranks(2, "mesh", "--resume", "run.kept", "-o", "a.pvtu", "-o", "a.msh")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn(whole, result.stdout)
        self.assertIn("mesh --generate pipe", result.stdout)  # the command that repeats it
        self.assertNotIn("--resume", result.stdout)
        for name in ("a.pvtu", "a.msh"):
            self.assertIn("accepted", self.succeed("check", name))

    def start(self, *arguments):
        return subprocess.Popen([program.PATH, "mesh", *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, env=program.RANKS_ENVIRONMENT)

    def test_signals(self):
        whole = self.digest_of(*SLOW, "--reproducible")
        kept = self.folder / "run.kept"
        run = self.start(*SLOW, "--checkpoint", "run.kept", "--every", "0.3", "--json", "first.json", "--quiet")
        while not kept.exists():  # refinement goes on
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        run.send_signal(signal.SIGTERM)
        errors = run.communicate(timeout=program.MESHER_SECONDS)[1]
        self.assertEqual(run.returncode, 3, errors)
        self.assertIn("stopped by SIGTERM", errors)
        self.assertIn("--resume run.kept", errors)
        self.assertEqual(self.files(), ["run.json", "run.kept"])
        before = kept.stat().st_mtime_ns
        run = self.start("--resume", "run.kept", "--checkpoint", "other.kept", "--json", "second.json", "--quiet")
        while not (self.folder / "other.kept").exists() and run.poll() is None:
            run.send_signal(signal.SIGUSR1)  # too early, it ends the run
            time.sleep(0.05)
        errors = run.communicate(timeout=program.MESHER_SECONDS)[1]
        self.assertEqual(kept.stat().st_mtime_ns, before)
        if run.returncode == -signal.SIGUSR1:
            return self.assertEqual(self.digest_of("--resume", "run.kept"), whole)
        self.assertEqual(run.returncode, 0, errors)
        record = json.loads((self.folder / "second.json").read_text())
        self.assertEqual(record["mesh"]["digest"], whole)
        if (self.folder / "other.kept").exists():
            self.assertGreater(record["checkpoints"]["count"], 0)
            self.assertEqual(self.digest_of("--resume", "other.kept"), whole)

    def test_a_rank_that_hangs_is_named_and_given_up_and_the_rest_goes_on(self):
        whole = self.digest_of(*SLOW, "--reproducible")
        kept = self.folder / "run.kept"
        command = ["mpiexec", "-n", "3", program.PATH, "mesh", *SLOW, "--checkpoint", "run.kept", "--every", "0.3", "--silence", "1", "--give-up", "4",
                   "--quiet"]
        run = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env=program.RANKS_ENVIRONMENT)
        while not kept.exists():
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        ranks = subprocess.run(["pgrep", "-P", str(run.pid)], capture_output=True, text=True, check=True).stdout.split()
        os.kill(int(ranks[1]), signal.SIGSTOP)
        errors = run.communicate(timeout=program.MESHER_SECONDS)[1]
        self.assertNotEqual(run.returncode, 0, errors)
        doing = r"(refining subdomain \d+|waiting for other ranks|writing a checkpoint) since \d\d:\d\d:\d\d"
        self.assertRegex(errors, rf"rank 1 on \S+ has not answered for 1 s, {doing}; the others wait for it")
        self.assertRegex(errors, rf"rank 1 on \S+ has not answered for 4 s, {doing}; given up after 4 s \(--give-up\)")
        self.assertIn("go on with driftmesh mesh --resume run.kept", errors)
        self.assertEqual(self.digest_of("--resume", "run.kept", ranks=2), whole)

    def test_what_does_not_go_together(self):
        self.stopped_by_limit()
        self.refuse("mesh", "--resume", "run.kept", "--area", "2", code=2, says=["--area is 2", "run.kept has 1.5"])
        self.refuse("mesh", "--resume", "run.kept", "--method", "decoupled", code=2, says=["--method", "--resume"])
        self.write("settings.yaml", "resume: run.kept\narea: 3\n")
        self.refuse("mesh", "--config", "settings.yaml", code=1, says=["settings.yaml:2", "is 3"])
        self.refuse("mesh", *REQUEST, "--checkpoint", "a", "--method", "coupled", code=2, says=["--method", "--checkpoint"])
        self.refuse("mesh", *REQUEST, "--every", "5s", "--reproducible", code=2, says=["--every", "--checkpoint"])
        for time in ("10", "10m"):  # which is the default
            self.refuse("mesh", *REQUEST, "--every", time, code=2, says=["--every", "--checkpoint"])
        self.write("every.yaml", "every: 10m\n")
        self.refuse("mesh", *REQUEST, "--config", "every.yaml", code=1, says=["every.yaml:1:", "checkpoints"])
        self.refuse("mesh", *REQUEST, "--reproducible", "--give-up", "5m", code=2, says=["--give-up", "alone"])
        self.refuse("mesh", *REQUEST, "--checkpoint", "-", code=2, says=["--checkpoint is standard output"])
        self.refuse("mesh", *REQUEST, "--checkpoint", "none/a", code=1, says=["none/a"])
        self.refuse("mesh", "--resume", "none", code=1, says=["none"])
        self.write("text", "no checkpoint")
        self.refuse("mesh", "--resume", "text", code=1, says=["text", "is not an HDF5 file"])
        kept = (self.folder / "run.kept").read_bytes()
        self.write("cut", kept[:len(kept) // 2])
        self.refuse("mesh", "--resume", "cut", code=1, says=["cut"])
        bad = bytearray(kept)
        bad[-len(bad) // 3] ^= 1
        self.write("bad", bytes(bad))
        self.refuse("mesh", "--resume", "bad", code=1, says=["bad", "cannot be loaded"])

    def test_lengths_that_have_changed(self):
        self.write("box.poly", program.SQUARE)
        grid = "ncols 3\nnrows 3\nxllcorner -1\nyllcorner -1\ncellsize 2\n" + "{0} {0} {0}\n" * 3
        self.write("depth.asc", grid.format(4))
        request = ("box.poly", "--raster", "depth=depth.asc", "--size", "0.01*depth", "--checkpoint", "run.kept", "-n", "9")
        whole = self.digest_of(*request)
        most = int(self.record()["mesh"]["triangles"] * 0.9)
        self.refuse("mesh", *request, "--max-triangles", str(most), code=3, says=["--resume run.kept"])
        (self.folder / "box.poly").unlink()  # the domain is in the checkpoint
        self.assertEqual(self.digest_of("--resume", "run.kept"), whole)
        self.write("depth.asc", grid.format(5))
        self.refuse("mesh", "--resume", "run.kept", code=1, says=["run.kept", "other lengths"])

    def test_a_checkpoint_that_cannot_be_written_is_a_warning(self):
        whole = self.digest_of(*REQUEST, "--reproducible")
        result = self.run_program("mesh", *REQUEST, "--checkpoint", "/dev/full", "--every", "0.01", "--json", "run.json")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count("no checkpoint was written"), 1, result.stderr)
        self.assertEqual(self.record()["mesh"]["digest"], whole)


if __name__ == "__main__":
    program.main()
