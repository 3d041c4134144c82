#!/usr/bin/env python3
"""Measures on this machine what the paper's formula needs: the time of a sequential mesher, and of real ranks.

usage: measure.py DRIFTMESH FOLDER TRIANGLES REPETITIONS

Writes FOLDER/measured.json. The sequential mesher is the program triangle if it is on the PATH, else driftmesh itself. Programs
take turns, so that a busy machine slows all of them down; medians.
"""

import json
import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import time

import published

RANKS = (1, 2)  # real ones
SUBDOMAINS = 4000  # of the paper, for the time of decomposition
TRIANGLES_IN_CACHE = 20_000  # of a subdomain; PCDM's were as large as its 4,000 made them


def timed(command, folder):
    """Seconds on the clock, and of the processor."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return {"seconds": wall, "processor": after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime}


class Model:
    """The runs of one model."""

    def __init__(self, program, folder, name, triangles):
        self.program, self.folder, self.name, self.triangles = program, folder, name, triangles
        subprocess.run([program, "generate", name, "-o", f"{name}.poly"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        self.area = self.record("first", ["-n", "1"])["bounds"]["max_area"]

    def mesh_command(self, name, words):
        return [self.program, "mesh", f"{self.name}.poly", "--angle", "20", "--quiet", "--json",
                f"{self.name}-{name}.json", *words]

    def record(self, name, words, triangles=None, launcher=()):
        words = [*words, "--triangles", str(triangles or self.triangles)]
        subprocess.run([*launcher, *self.mesh_command(name, words)], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL)
        return json.loads((self.folder / f"{self.name}-{name}.json").read_text())

    def experiment(self, method, triangles):
        """A run on two real ranks by a method that only experiments have."""
        file, results = self.folder / f"{self.name}-{method}.yaml", self.folder / f"{self.name}-{method}.runs"
        file.write_text(f"input: {{file: {self.name}.poly}}\nbounds: {{angle: 20, triangles: {triangles}}}\n"
                        f"cluster: {{kind: real}}\nrun: {{method: {method}}}\n")
        subprocess.run(["mpirun", "-n", "2", self.program, "run", str(file), "--quiet", "-o", str(results), "--allow-outside"],
                       cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        return json.loads((results / "run-1.json").read_text())

    def own(self):
        return timed(self.mesh_command("own", ["--threads", "1", "-n", "1", "--area", repr(self.area)]), self.folder)

    def triangle(self):
        return timed(["triangle", f"-pq20a{self.area:.12f}QNEP", f"{self.name}.poly"], self.folder)

    def ranks(self, count):
        """Stages of a run on real ranks, with points told to neighbors, for as many triangles on each."""
        subdomains = max(20 * count, self.triangles * count // TRIANGLES_IN_CACHE)
        record = self.record(f"{count}-ranks", ["--presplit", "off", "--threads", "1", "-n", str(subdomains)],
                             self.triangles * count, ["mpirun", "-n", str(count)])
        stages = record["work"]["seconds_by_stage"]
        before = {name: stages.pop(name) for name in ("triangulate", "decompose")}
        for name in ("inspect", "assemble", "write"):
            stages.pop(name, 0)
        return {"triangulation": before["triangulate"], "decomposition": before["decompose"],
                "rest": sum(stages.values())}

    def cutting(self):
        record = self.record("cut", ["-n", str(SUBDOMAINS)], max(self.triangles, 20 * SUBDOMAINS))
        stages = record["work"]["seconds_by_stage"]
        return {"triangulation": stages["triangulate"], "decomposition": stages["decompose"]}


    def method(self, words):
        """Refinement on two real ranks: its time, that of each rank, and what they tell each other. Nothing if the decoupled
        method needs points that no neighbor has (docs/paper.md)."""
        try:
            if words == ["pdr"]:
                record = self.experiment("pdr", 2 * self.triangles)
            else:
                record = self.record("-".join(["method", *words]).replace("--", ""),
                                     ["--threads", "1", "--method", *words], 2 * self.triangles, ["mpirun", "-n", "2"])
        except subprocess.CalledProcessError:
            if words[0] == "decoupled":
                return {}
            raise
        ranks = record["parts"]["ranks"]
        stages = record["work"]["seconds_by_stage"]
        return {"seconds": stages["refine"],
                "computing": max(rank["seconds"]["computing"] for rank in ranks),
                "idle": statistics.mean(rank["seconds"]["idle"] for rank in ranks),
                "points": sum(rank["splits_sent"] for rank in ranks),
                "messages": sum(rank["split_messages_sent"] for rank in ranks),
                "triangles": record["mesh"]["triangles"]}

    def methods(self):
        parts = ["-n", str(max(40, 2 * self.triangles // TRIANGLES_IN_CACHE))]
        return {"PCDM": ["coupled", "--presplit", "off", *parts], "presplit": ["coupled", *parts],
                "decoupled": ["decoupled", *parts], "PDR": ["pdr"]}


def medians(runs):
    return {key: statistics.median(run[key] for run in runs) for key in runs[0]}


def measure(model, repetitions):
    """{name: medians} of everything that is measured of a model."""
    actions = {"own": model.own, "cutting": model.cutting}
    if shutil.which("triangle"):
        actions["triangle"] = model.triangle
    actions |= {f"ranks {count}": lambda count=count: model.ranks(count) for count in RANKS}
    actions |= {f"method {name}": lambda words=words: model.method(words) for name, words in model.methods().items()}
    runs = {name: [] for name in actions}
    for _ in range(repetitions):
        for name, action in actions.items():
            runs[name].append(action())
    return {name: medians(results) for name, results in runs.items()}


def main():
    program, folder = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
    triangles, repetitions = int(float(sys.argv[3])), int(sys.argv[4])
    work = folder / "measured"
    work.mkdir(parents=True, exist_ok=True)
    models = {name: measure(Model(program, work, name, triangles), repetitions) for name in published.MODELS}
    result = {"triangles": triangles, "repetitions": repetitions, "processors": os.cpu_count(),
              "load": os.getloadavg()[0], "models": models}
    (folder / "measured.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
