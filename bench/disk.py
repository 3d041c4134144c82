#!/usr/bin/env python3
"""Compares writing by ranks with the speed of the disk, and their memory with an even share; prints a table in Markdown (docs/results/disk.md).

Ranks make a mesh and write it, as .h5 into one file and as .pvtu into a file each. After each, dd writes as many bytes to the same
folder: one process one file, and as many processes as ranks their parts of one file, the latter also while as much memory is held as
the ranks had, which the system cannot use to put off writing. Seconds include those of `sync`. Memory is the
peak of each rank's process, from its start to its end.

usage: disk.py [--program DRIFTMESH] [--triangles N] [--ranks N] [--rounds N] [--folder FOLDER] [--update]
"""

import argparse
import json
import mmap
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from table import Table  # noqa: E402

MEGABYTE = 1 << 20
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
# Starts the rest of its arguments, and says how much memory they took.
PEAK = ("import os, resource, subprocess, sys; code = subprocess.call(sys.argv[1:]);"  # a line at once: the other rank prints, too
        "os.write(1, b'PEAK %d\\n' % (resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024)); sys.exit(code)")


def synced(start):
    subprocess.run(["sync"], check=True)
    return time.monotonic() - start


def mesh(options, folder, extension):
    """Seconds to write, bytes, peaks of the ranks."""
    record = folder / "record.json"
    done = subprocess.run(["mpirun", "-n", str(options.ranks), "--bind-to", "none", "--oversubscribe", sys.executable, "-c", PEAK,
                           options.program, "mesh", "--generate", "pipe", "--triangles", options.triangles, "--quiet", "-o",
                           folder / f"mesh.{extension}", "--json", record],
                          env=ENVIRONMENT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    seconds = json.loads(record.read_text())["work"]["seconds_by_stage"]["write"] + synced(time.monotonic())
    files = list(folder.glob("mesh*"))
    total = sum(path.stat().st_size for path in files)
    for path in files:
        path.unlink()
    return seconds, total, [int(line.split()[1]) for line in done.stdout.splitlines() if line.startswith("PEAK")]


def dd(folder, total, processes, held=0):
    """Seconds of processes that write their parts of one file, while this one holds some bytes of memory."""
    memory = bytearray(held)
    memory[::mmap.PAGESIZE] = bytes([1]) * len(range(0, held, mmap.PAGESIZE))
    target, each = folder / "dd.bin", total // processes // MEGABYTE
    subprocess.run(["sync"], check=True)
    start = time.monotonic()
    running = [subprocess.Popen(["dd", "if=/dev/zero", f"of={target}", "bs=1M", f"count={each}", f"seek={k * each}", "conv=notrunc"],
                                stderr=subprocess.DEVNULL) for k in range(processes)]
    if any(process.wait() for process in running):
        sys.exit("dd failed")
    seconds = synced(start)
    target.unlink()
    return seconds


def measured(options):
    rows = {extension: [] for extension in ("h5", "pvtu")}
    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        folder = pathlib.Path(name)
        for _ in range(options.rounds):
            for extension, row in rows.items():
                seconds, total, peaks = mesh(options, folder, extension)
                row.append((seconds, dd(folder, total, 1), dd(folder, total, options.ranks),
                            dd(folder, total, options.ranks, sum(peaks)), total,
                            max(peaks) * len(peaks) / sum(peaks), sum(peaks)))
    table = Table("disk", f"{options.triangles} triangles on {options.ranks} ranks",
                  ["file", "GB", "written in", "dd, one process", "dd, a process for each rank, one file",
                   "the same beside as much memory", "peak of all ranks", "largest over even share"],
                  f"Medians of {options.rounds} in turn; seconds include those of sync.")
    for extension, row in rows.items():
        seconds, one, parts, beside, total, share, peak = (statistics.median(column) for column in zip(*row))
        table.add(f"`.{extension}`", f"{total / 1e9:.2f}", *(f"{value:.1f} s" for value in (seconds, one, parts, beside)),
                  f"{peak / 1e9:.2f} GB", f"{share:.3f}")
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh", help="default: build/release/driftmesh")
    parser.add_argument("--triangles", default="100M")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--folder", help="on the disk in question; default: that of temporary files")
    results.add_option(parser)
    options = parser.parse_args()
    options.program = pathlib.Path(options.program).resolve()
    results.show("bench/disk.py", map(measured, [options]), options)


if __name__ == "__main__":
    main()
