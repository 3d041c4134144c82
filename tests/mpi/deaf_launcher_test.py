"""Ranks that have done all their work end well even if mpiexec cannot hear them for a while. usage: MPIEXEC PROGRAM LIBRARY"""

import subprocess
import sys

RUNS = 6  # each with four ranks, of which any may be taken for crashed

launcher, program, library = sys.argv[1:]
command = [launcher, "-n", "4", "--oversubscribe", "-x", f"LD_PRELOAD={library}", program]
runs = [subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) for _ in range(RUNS)]
said = [run.communicate(timeout=60)[0] for run in runs]
if not all("Forwarding signal" in text for text in said):
    sys.exit("mpiexec was not stopped:\n" + "\n".join(said))
failed = [text for run, text in zip(runs, said) if run.returncode != 0]
if failed:
    sys.exit(f"{len(failed)} of {RUNS} runs ended with an error:\n" + "\n".join(failed))
