#!/usr/bin/env python3
"""Kills runs of driftmesh at random moments, and goes on from their checkpoints on another number of ranks.

Each journey makes one mesh, in as many runs as it takes: a run on 2 to 4 ranks is killed (SIGKILL or SIGTERM, to a rank or to
mpirun) at a random moment, and the next one goes on from its checkpoint, or begins anew if there is none yet. Fails unless
each journey ends with the mesh of a run that was never stopped, no run but those that were killed fails, and the work that a
kill costs is that since the last checkpoint, which is at most an interval old. The seed determines what is killed and when.

With --journeys, makes so many of simulated ranks instead, by driftmesh-sim.

usage: kills.py [--program DRIFTMESH] [--kills 300] [--seed 1] [--update]
       kills.py [--program DRIFTMESH] --journeys 100000 [--simulator DRIFTMESH-SIM] [--update]
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.append(str(PROJECT / "scripts" / "tables"))

import results  # noqa: E402
from table import Table  # noqa: E402

KILLS_IN_JOURNEY = 6  # at most
EVERY = 0.5  # seconds between checkpoints
HUNG = 30  # seconds after a kill until mpirun counts as hung
SLACK = 10.0  # for a slice of work, for writing, and for a machine with much other work
REQUEST = ["--generate", "pipe", "--presplit", "off", "-n", "60"]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1",
                   ASAN_OPTIONS="detect_leaks=0")


def ranks_of(launcher):
    """The processes that mpirun has started."""
    found = subprocess.run(["pgrep", "-P", str(launcher)], capture_output=True, text=True, check=False)
    return [int(line) for line in found.stdout.split()]


def is_running(process):
    """Whether it has not ended; what its parent has not asked about yet has."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def await_end(run, what):
    """Waits for a run that has been killed. False if all ranks end, but mpirun does not: that of Open MPI 4.1.4 may wait forever for a
    lock of its own (in PMIx_server_finalize)."""
    try:
        run.communicate(timeout=HUNG)
        return True
    except subprocess.TimeoutExpired:
        pass
    if any(is_running(rank) for rank in ranks_of(run.pid)):
        left = subprocess.run(["ps", "-o", "pid,ppid,stat,wchan:20,time,args", "--ppid", str(run.pid), "-p", str(run.pid)],
                              capture_output=True, text=True, check=False).stdout
        raise SystemExit(f"FAILED: a run did not end after {what}:\n{left}")
    run.kill()
    run.communicate()
    return False


def send(process, number):
    try:
        os.kill(process, number)
        return True
    except ProcessLookupError:
        return False


class Journey:
    def __init__(self, program, folder, area, dice):
        self.program, self.folder, self.dice = program, folder, dice
        self.kept = folder / "run.kept"
        self.request = [*REQUEST, "--area", str(area)]

    def start(self, ranks, number):
        way = ["--resume", "run.kept"] if self.kept.exists() else self.request
        command = ["mpirun", "-n", str(ranks), self.program, "mesh", *way, "--checkpoint", "run.kept", "--every", str(EVERY),
                   "--quiet", "--json", "run.json"]
        grace = "4" if number == signal.SIGTERM else "1"  # until mpirun kills the ranks that it has told to end
        environment = dict(ENVIRONMENT, OMPI_MCA_odls_base_sigkill_timeout=grace)
        return subprocess.Popen(command, cwd=self.folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                text=True, start_new_session=True)

    def kill(self, run, number, after):
        """Sends a signal to something of a run that many seconds after its start. Returns what, or None if the run has ended."""
        begin = time.time()
        try:
            run.wait(timeout=after)
            return None
        except subprocess.TimeoutExpired:
            pass
        ranks = ranks_of(run.pid)
        whom = self.dice.choice(["rank", "mpirun"])
        target = self.dice.choice(ranks) if whom == "rank" and ranks else run.pid
        send(target, number)
        now = time.time()
        made = self.kept.stat().st_mtime if self.kept.exists() else 0
        age = now - made if begin < made < now else None  # if this run has made it, before it was killed
        what = f"{number.name} to {'a rank' if target != run.pid else 'mpirun'}"
        ended = await_end(run, f"{what} of {len(ranks)} ranks")
        for rank in ranks:  # those that nobody waits for, as a batch system would
            send(rank, signal.SIGKILL)
        while any(pathlib.Path(f"/proc/{rank}").exists() for rank in ranks):
            time.sleep(0.01)
        return what, age, ended


def digest_in(folder):
    record = json.loads((folder / "run.json").read_text())
    return record["mesh"]["digest"]


def whole_run(program, folder, area):
    """The digest of a run that is never stopped, and its seconds on two ranks."""
    begin = time.time()
    subprocess.run(["mpirun", "-n", "2", program, "mesh", *REQUEST, "--area", str(area), "--reproducible", "--quiet", "--json",
                    "run.json"], cwd=folder, env=ENVIRONMENT, check=True, capture_output=True)
    return digest_in(folder), time.time() - begin


def travel(program, area, expected, seconds, dice, tally, kills):
    """One journey. Returns the number of kills."""
    killed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        journey = Journey(program, folder, area, dice)
        ranks = dice.randint(2, 4)
        while True:
            number = dice.choice([signal.SIGKILL, signal.SIGTERM])
            run = journey.start(ranks, number)
            met = journey.kill(run, number, dice.uniform(0.2, seconds)) if killed < kills else None
            if met is None:
                _, errors = run.communicate(timeout=600)
                if run.returncode != 0:
                    raise SystemExit(f"FAILED: a run that nobody killed ended with {run.returncode}:\n{errors}")
                if digest_in(folder) != expected:
                    raise SystemExit(f"FAILED: another mesh: {digest_in(folder)} instead of {expected}")
                left = sorted(path.name for path in folder.iterdir())
                if left != ["run.json", "run.kept"]:
                    raise SystemExit(f"FAILED: files are left: {left}")
                return killed
            what, age, ended = met
            killed += 1
            tally["launchers"] += not ended
            tally[what, "resumed" if journey.kept.exists() else "anew"] += 1
            print(f"{what} of {ranks}" + ("" if age is None else f", a checkpoint {age:.2f} s old") + ("" if ended else "; mpirun hung"), flush=True)
            if age is not None:
                tally["age"] = max(tally["age"], age)
                tally["ages"] += 1
                if age > EVERY + SLACK:
                    raise SystemExit(f"FAILED: the last checkpoint was {age:.1f} s old")
            ranks = dice.choice([n for n in (2, 3, 4) if n != ranks])


def kills_table(options):
    program = os.path.abspath(options.program)
    print(f"kills: seed {options.seed}", flush=True)
    with tempfile.TemporaryDirectory() as name:
        expected, seconds = whole_run(program, pathlib.Path(name), options.area)
    print(f"a whole run: digest {expected}, {seconds:.1f} s on 2 ranks", flush=True)
    tally = collections.Counter()
    kills = journeys = 0
    while kills < options.kills:
        dice = random.Random(f"{options.seed} {journeys}")
        kills += travel(program, options.area, expected, seconds, dice, tally, min(KILLS_IN_JOURNEY, options.kills - kills))
        journeys += 1
    table = Table("kills", "Kills", ["killed", "times", "gone on with", "begun anew: no checkpoint yet"],
                  f"{kills} kills in {journeys} journeys (seed {options.seed}), each of which ended with the mesh of a run that was never "
                  f"stopped. The last checkpoint of a run that had made some ({tally['ages']}) was at most {tally['age']:.2f} s old, where "
                  f"one was due every {EVERY} s. mpirun itself did not end {tally['launchers']} times, when all ranks had, and was killed after {HUNG} s.")
    for what in sorted({key[0] for key in tally if isinstance(key, tuple)}):
        resumed, anew = tally[what, "resumed"], tally[what, "anew"]
        table.add(what, resumed + anew, resumed, anew)
    return table


def travel_simulated(simulator, first, last):
    """What driftmesh-sim counts in these journeys, by its words."""
    run = subprocess.run([simulator, "--faults", "--seeds", f"{first}..{last}"], env=ENVIRONMENT, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise SystemExit(f"FAILED:\n{run.stdout}{run.stderr}")
    counts = run.stdout.strip().splitlines()[-1]
    return collections.Counter({words: int(number) for number, words in re.findall(r"(\d+) ([a-z ]+)", counts.rsplit(";", 1)[0])})


def journeys_table(options):
    simulator = os.path.abspath(options.simulator or pathlib.Path(options.program).parent / "driftmesh-sim")
    part = 250
    tally = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        parts = [(first, min(first + part - 1, options.journeys)) for first in range(1, options.journeys + 1, part)]
        for counts in pool.map(lambda seeds: travel_simulated(simulator, *seeds), parts):
            tally += counts
            print(f"{tally['journeys']} journeys", flush=True)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = used.ru_utime + used.ru_stime
    table = Table("journeys", "Simulated ranks", ["what", "times"],
                  f"{tally['journeys']:,} journeys, {tally['in rounds']:,} of them in rounds and the others coupled, in {tally['runs']:,} runs: {tally['resumed']:,} "
                  f"went on from a checkpoint, {tally['begun anew']:,} began anew. None failed. They took {seconds:,.0f} s of processor time, {options.journeys / seconds:.0f} journeys a "
                  f"second of a core; 100,000 take {1e5 / options.journeys * seconds / 60:.0f} minutes of one.")
    for what in ("killed", "killed at a write", "hung", "told to end", "paused", "slowed down", "sent late", "refused bytes by the disk"):
        table.add(f"a rank is {what}" if not what.startswith("sent") else "a rank's messages take long", tally[what])
    table.add("a checkpoint is completed", tally["checkpoints"])
    table.add("one cannot be written", tally["refused"])
    table.add("a rank that hangs is given up by the others", tally["given up"])
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh")
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--journeys", type=int, default=0, help="so many on simulated ranks, instead")
    parser.add_argument("--simulator", help="driftmesh-sim; without it, that beside the program")
    parser.add_argument("--area", type=float, default=0.05)
    results.add_option(parser)
    options = parser.parse_args()
    results.show("scripts/kills.py", map(journeys_table if options.journeys > 0 else kills_table, [options]), options)


if __name__ == "__main__":
    main()
