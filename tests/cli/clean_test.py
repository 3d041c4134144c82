#!/usr/bin/env python3
"""What killed runs leave in a folder, and driftmesh clean.

usage: clean_test.py DRIFTMESH [unittest options]
"""

import os
import re
import signal
import socket
import subprocess
import time

import program

HOST = re.sub(r"[^A-Za-z0-9._]", "_", socket.gethostname()) + "." + str(os.stat("/proc/self/ns/pid").st_ino)
ELSEWHERE = "node7.4026531836"


def ended_process():
    process = subprocess.Popen(["true"])
    process.wait()
    return process.pid


class Clean(program.Cli):
    def leave(self, host, process, hours=0.0):
        name = self.write(f"a.vtu.tmp-{host}-{process}-0", "half a mesh")
        written = time.time() - 3600 * hours
        os.utime(self.folder / name, (written, written))
        return name

    def run_until_it_writes(self):
        """A run with a temporary file, stopped in the middle."""
        command = [program.PATH, "mesh", "--generate", "pipe", "--area", "0.02", "-o", "mesh.msh", "--quiet"]
        run = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while run.poll() is None:
            if any(".tmp-" in name for name in self.files()):
                run.send_signal(signal.SIGSTOP)
                return run
            time.sleep(0.002)
        self.fail("the run has ended before it was seen to write")

    def test_what_a_killed_run_leaves_goes_and_what_a_living_one_writes_stays(self):
        run = self.run_until_it_writes()
        try:
            (name,) = self.files()
            kept = self.succeed("clean", ".", "--older", "0")
            self.assertRegex(kept, rf"^kept +./{re.escape(name)}.* which is running\n0 files removed")
            self.assertEqual(self.files(), [name])
        finally:
            run.kill()
            run.wait()
        said = self.succeed("clean", ".", "--dry-run")
        self.assertRegex(said, rf"^would go +./{re.escape(name)}.* has ended\n1 file would go")
        self.assertEqual(self.files(), [name])
        self.assertIn("1 file removed", self.succeed("clean", "."))
        self.assertEqual(self.files(), [])

    def test_other_hosts_keep_what_is_not_old(self):
        process = ended_process()
        fresh, old = self.leave(ELSEWHERE, process, 23), self.leave(ELSEWHERE, process + 1, 25)
        said = self.succeed("clean", ".")
        self.assertIn(f"kept     ./{fresh}", said)
        self.assertIn(f"of process {process} on {ELSEWHERE}, written to 23 h 00 min ago", said)
        self.assertIn(f"removed  ./{old}", said)
        self.assertEqual(self.files(), [fresh])
        self.assertIn("1 file removed", self.succeed("clean", ".", "--older", "22"))
        self.leave(ELSEWHERE, process)
        self.assertIn("1 file removed", self.succeed("clean", ".", "--older", "0"))
        self.assertEqual(self.files(), [])

    def test_files_of_others_stay(self):
        names = [f"a.vtu.tmp-{HOST}-{os.getpid()}-0", "data.tmp-2024-01-02", "a.tmp-host-1-2", f"a.tmp-{HOST}-7x-0", f"a.tmp-{HOST}--0",
                 f"a.tmp-{ELSEWHERE}-0-0", "a.tmp", f".tmp-{ELSEWHERE}-1-0", "run.kept"]
        for name in names:
            self.write(name, "")
            os.utime(self.folder / name, (0, 0))
        (self.folder / f"folder.tmp-{ELSEWHERE}-1-0").mkdir()
        before = self.files()
        self.assertIn("0 files removed", self.succeed("clean", ".", "--older", "0"))
        self.assertEqual(self.files(), before)

    def test_the_next_run_on_any_host_removes_what_is_old(self):
        process = ended_process()
        self.leave(HOST, process)
        self.leave(ELSEWHERE, process, 25)
        fresh = self.leave(ELSEWHERE, process + 1, 1)
        self.succeed("generate", "pipe", "-o", "pipe.poly")
        self.assertEqual(self.files(), sorted([fresh, "pipe.poly"]))

    def test_a_folder_that_is_none(self):
        self.refuse("clean", "nowhere", says=["nowhere", "is no folder"])
        self.refuse("clean", code=2, says=["FOLDER"])
        self.refuse("clean", ".", "--older", "-1", code=2, says=["--older"])


if __name__ == "__main__":
    program.main()
