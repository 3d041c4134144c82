#!/usr/bin/env python3
"""Measures driftmesh on real ranks, and prints tables in Markdown (docs/results/ranks.md).

Each run is a separate mpirun. The figures are medians over repetitions in which the compared cases alternate, so that a
busy moment of the machine affects all of them.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from table import Table  # noqa: E402

ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1")
AREAS = {"pipe": 187530.34, "cylinder_flow": 1399.60745, "chesapeake": 36722004389.78}
GENERATED = {"pipe": "pipe", "cylinder_flow": "cylinder-flow", "chesapeake": "bay", "corner": "rectangle-hole"}
# 90 % of the triangles in 10 % of the area of a rectangle of 2 x 1; about 11 million of them.
CORNER = "x < 0.45 && y < 0.45 ? 0.00025 : 0.0022"
CELLS = 7.04e6  # the area bound is the domain's area over this: about 10.9 million triangles
# From the input in memory to the distributed mesh in memory.
MESHING_STAGES = ("triangulate", "decompose", "map", "share", "refine", "assemble")


class Bench:
    def __init__(self, options, folder):
        self.options = options
        self.folder = pathlib.Path(folder)

    def input_of(self, model):
        path = pathlib.Path(self.options.data) / f"{model}.poly"
        if path.exists():
            return path
        path = self.folder / f"{model}.poly"
        if not path.exists():
            subprocess.run([self.options.program, "generate", GENERATED[model], "-o", path], check=True)
        return path

    def area_of(self, model, cells):
        if (pathlib.Path(self.options.data) / f"{model}.poly").exists():
            return AREAS[model] / cells
        first = self.mesh(1, model, None)
        return first["mesh"]["total_area"] / cells

    def command(self, ranks, model, area, *arguments, binding=(), record="run.json"):
        command = ["mpirun", *binding, "-n", ranks, self.options.program, "mesh", self.input_of(model), "--quiet",
                   "--json", self.folder / record, *arguments]
        return list(map(str, command + (["--area", repr(area)] if area else [])))

    def mesh(self, ranks, model, area, *arguments, output=False):
        command = self.command(ranks, model, area, *arguments)
        if output:
            command += ["-o", str(self.folder / "mesh.pvtu")]
        subprocess.run(command, check=True, env=ENVIRONMENT)
        return json.loads((self.folder / "run.json").read_text())

    def apart(self, jobs, model, area):
        """The records of this many concurrent jobs of one rank, each on its own core: the efficiency that the machine
        allows if ranks do not interact."""
        started = []
        for job in range(jobs):
            binding = ("--bind-to", "core", "--cpu-set", job)
            command = self.command(1, model, area, binding=binding, record=f"job-{job}.json")
            started.append(subprocess.Popen(command, env=ENVIRONMENT))
        if any([process.wait() for process in started]):
            raise RuntimeError("a job failed")
        return [json.loads((self.folder / f"job-{job}.json").read_text()) for job in range(jobs)]

    def experiment(self, kind, ranks, drag, policy, *arguments):
        """The record of one run of configs/two-ranks.yaml, on real or simulated ranks."""
        settings = {"cluster.kind": kind, "cluster.ranks": ranks, "cluster.drag": json.dumps(drag),
                    "balance.policy": policy, "input.generate": '""', "input.file": self.input_of("pipe"),
                    "bounds.triangles": self.options.triangles, "report": "false"}
        command = ["mpirun", "-n", str(ranks)] if kind == "real" else []
        command += [self.options.program, "run", PROJECT / "configs/two-ranks.yaml", "-o", self.folder / "runs",
                    "--quiet", *(word for item in settings.items() for word in ("--set", "{}={}".format(*item))),
                    *arguments]
        subprocess.run(list(map(str, command)), check=True, env=ENVIRONMENT)
        return json.loads((self.folder / "runs" / "run-1.json").read_text())

    def coast(self, kind, drag, policy, *settings):
        """The record of one run on a coast that is graded by the distance to it: uneven subdomains, no presplitting."""
        ranks = len(drag)
        experiment = {"input": {"file": str(self.input_of("chesapeake"))}, "bounds": {"angle": 20},
                      "sizing": {"size": self.options.coast}, "decomposition": {"subdomains": 300, "skew": 0.5},
                      "run": {"presplit": "off"}, "balance": {"policy": policy}, "report": False,
                      "cluster": {"kind": kind, "ranks": ranks, "drag": drag}}
        (self.folder / "coast.yaml").write_text(json.dumps(experiment))
        command = ["mpirun", "--bind-to", "none", "-n", str(ranks)] if kind == "real" else []
        command += [self.options.program, "run", self.folder / "coast.yaml", "-o", self.folder / "coast", "--quiet",
                    *(word for setting in settings for word in ("--set", setting))]
        subprocess.run(list(map(str, command)), check=True, env=ENVIRONMENT)
        return json.loads((self.folder / "coast" / "run-1.json").read_text())

    def take_turns(self, cases):
        """The records of each case, one list per case; cases are functions that make one run."""
        records = [[] for _ in cases]
        for _ in range(self.options.repetitions):
            for case, list_of_case in zip(cases, records):
                list_of_case.append(case())
        return records


def seconds_of_refinement(run):
    return max(sum(rank["seconds"].values()) for rank in run["parts"]["ranks"])


def rate(run):
    return run["mesh"]["triangles"] / seconds_of_refinement(run) / 1e6


def meshing(run):
    return sum(run["work"]["seconds_by_stage"].get(stage, 0) for stage in MESHING_STAGES)


def share_of(kinds, run):
    """The share of the ranks' time, in percent."""
    spent = sum(rank["seconds"][kind] for rank in run["parts"]["ranks"] for kind in kinds)
    return 100 * spent / sum(sum(rank["seconds"].values()) for rank in run["parts"]["ranks"])


def total(run, counter):
    return sum(rank[counter] for rank in run["parts"]["ranks"])


def median(runs, figure):
    return statistics.median(figure(run) for run in runs)


def models(bench):
    rows = []
    for model in AREAS:
        area = bench.area_of(model, bench.options.cells)
        ranks = bench.options.ranks
        cases = [lambda n=n: bench.mesh(n, model, area, output=True) for n in ranks]
        cases += [lambda n=n: bench.apart(n, model, area * n) for n in ranks]
        records = bench.take_turns(cases)
        alone, alone_at_best = median(records[0], rate), max(map(rate, records[0]))
        for n, runs, jobs in zip(ranks, records, records[len(ranks):]):
            apart = statistics.median(min(map(rate, at_once)) for at_once in jobs)
            digests = {run["mesh"]["digest"] for run in runs}
            rows.append([model, n, runs[0]["parts"]["subdomains"], f"{runs[0]['mesh']['triangles']:,}",
                         f"{median(runs, rate):.1f}", f"{median(runs, rate) / alone * ranks[0] / n:.2f}",
                         f"{max(map(rate, runs)) / alone_at_best * ranks[0] / n:.2f}", f"{apart / alone * ranks[0]:.2f}",
                         f"{median(runs, lambda r: r['work']['seconds_by_stage'].get('decompose', 0)):.3f}",
                         f"{median(runs, lambda r: r['work']['seconds_by_stage']['assemble']):.3f}",
                         f"{median(runs, meshing):.2f}", total(runs[0], "splits_sent"),
                         digests.pop() if len(digests) == 1 else f"{len(digests)} different"])
    return Table("models", "Real ranks, presplit interfaces",
                 ["input", "ranks", "subdomains", "triangles", "million triangles/s", "efficiency", "best run", "independent jobs",
                  "decompose", "assemble", "input to distributed mesh", "SPLITs", "digest"],
                 "Times are those of rank 0, in seconds. Best run: the fastest runs compared. Independent jobs: the efficiency of as many "
                 "jobs of one rank at the same time, each with one rank's share of the work; what the ranks of one run lose beyond that, they "
                 "lose waiting for each other. Input to distributed mesh: everything from the input in memory to the mesh in memory, with "
                 "decomposition.", rows)


def aggregation(bench):
    thresholds = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024]
    area = bench.area_of("pipe", bench.options.cells)
    records = bench.take_turns([lambda k=k: bench.mesh(2, "pipe", area, "-n", 4000, "--presplit", "off",
                                                       "--mapping", bench.options.mapping, "--aggregation", k)
                                for k in thresholds])
    rows = [[k, total(runs[0], "splits_sent"), total(runs[0], "split_messages_sent"), f"{median(runs, rate):.1f}",
             f"{median(runs, lambda r: share_of(('sending', 'polling'), r)):.2f} %",
             f"{median(runs, lambda r: share_of(('idle',), r)):.2f} %"] for k, runs in zip(thresholds, records)]
    return Table("aggregation", "Aggregation: pipe in 4,000 subdomains on 2 ranks",
                 ["most SPLITs per message", "SPLITs", "messages", "million triangles/s", "sending and polling", "idle"],
                 f"No presplitting, mapping {bench.options.mapping}; Figure 7 of the paper.", rows)


def breakdown(bench):
    rows = []
    for model in AREAS:
        area = bench.area_of(model, bench.options.cells)
        runs = [bench.mesh(2, model, area, "-n", 4000, "--presplit", "off") for _ in range(bench.options.repetitions)]
        run = sorted(runs, key=seconds_of_refinement)[len(runs) // 2]
        for rank, figures in enumerate(run["parts"]["ranks"]):
            rows.append([model, rank, f"{figures['triangles']:,}", figures["splits_sent"],
                         *(f"{seconds:.3f}" for seconds in figures["seconds"].values())])
    return Table("breakdown", "Time of each rank, in seconds",
                 ["input", "rank", "triangles", "SPLITs sent", "computing", "sending", "polling", "balancing", "idle"],
                 "4,000 subdomains, no presplitting, the median run; Figure 11 of the paper.", rows)


def ideal(run):
    """Seconds of refinement if all ranks finished together: total work over total speed, as measured in the run. A rank
    with drag alternates between computing and sleeping; its time until its work is done accounts for both."""
    speeds = [rank["triangles"] / (sum(rank["seconds"].values()) - rank["seconds"]["idle"])
              for rank in run["parts"]["ranks"] if rank["triangles"]]
    return run["mesh"]["triangles"] / sum(speeds)


def balance(bench):
    policies = {name: ("--balance", name) for name in ("none", "zoltan", "stealing", "greedy", "diffusion")}
    pipe = bench.area_of("pipe", bench.options.cells)
    cases = {
        "pipe, one rank at half speed": ("pipe", pipe, "--drag", "1,0.5"),
        "corner, mapped by area": ("corner", None, "--size", CORNER, "--map-by-area"),
        "corner, mapped by area, one rank at half speed": ("corner", None, "--size", CORNER, "--map-by-area", "--drag",
                                                          "1,0.5"),
        "pipe, nothing to balance": ("pipe", pipe),
    }
    rows = []
    for case, (model, area, *arguments) in cases.items():
        # Speeds are measured while all ranks work: in the same run, mapped by work.
        mapped_by_work = [word for word in arguments if word != "--map-by-area"]
        *records, references = bench.take_turns(
            [lambda p=p: bench.mesh(2, model, area, *arguments, *p) for p in policies.values()] +
            [lambda: bench.mesh(2, model, area, *mapped_by_work)])
        best = median(references, ideal)
        for policy, runs in zip(policies, records):
            seconds = median(runs, seconds_of_refinement)
            rows.append([case, policy, f"{runs[0]['mesh']['triangles']:,}", f"{seconds:.2f}", f"{seconds / best:.2f}",
                         f"{median(runs, lambda r: seconds_of_refinement(r) / ideal(r)):.2f}",
                         f"{median(runs, lambda r: share_of(('balancing',), r)):.2f} %",
                         f"{median(runs, lambda r: share_of(('idle',), r)):.1f} %",
                         f"{median(runs, lambda r: total(r, 'hand_offs')):.0f}"])
    return Table("balance", "Policies on two ranks",
                 ["case", "policy", "triangles", "refinement s", "relative to ideal", "to own ideal", "balancing", "idle",
                  "subdomains moved"],
                 "The ideal is total work over total speed, with speeds measured in a run without balancing and mapped by work (ideal), or in "
                 "the run itself (own ideal): anything above 1 was then spent waiting. One rank is slower because it sleeps as long as it "
                 "works. In the corner cases 90 % of the triangles lie in 10 % of the area, and each rank starts with half of the area. Where "
                 "nothing needs to move, balancing is the overhead of being ready: reports, plans, and needless moves.", rows)


def size(bench):
    rows = []
    for million in bench.options.sizes:
        for presplit in "on", "off":
            run = bench.mesh(2, "pipe", bench.area_of("pipe", CELLS * million / 10.93), "--presplit", presplit)
            rows.append([f"{run['mesh']['triangles']:,}", presplit, run["parts"]["subdomains"],
                         total(run, "splits_sent"), f"{rate(run):.1f}", f"{seconds_of_refinement(run):.1f}",
                         f"{run['work']['peak_bytes_refining'] / run['mesh']['triangles']:.1f}"])
    return Table("size", "Size: pipe on 2 ranks",
                 ["triangles", "presplit", "subdomains", "SPLITs", "million triangles/s", "refinement s", "peak bytes/triangle"],
                 "One run each.", rows)


def growth(bench):
    millions = (1, 10, 100)
    records = bench.take_turns([lambda m=m: bench.mesh(1, "pipe", bench.area_of("pipe", CELLS * m / 10.93), "--subdomains",
                                                       max(1, round(m * 50))) for m in millions])
    first = median(records[0], rate)
    rows = [[f"{runs[0]['mesh']['triangles']:,}", runs[0]["parts"]["subdomains"], f"{median(runs, rate):.2f}",
             f"{100 * (first / median(runs, rate) - 1):+.0f} %",
             f"{median(runs, lambda r: r['work']['peak_bytes_refining'] / r['mesh']['triangles']):.1f}"]
            for runs in records]
    return Table("growth", "Growth: pipe on one rank, in subdomains of 20,000 triangles",
                 ["triangles", "subdomains", "million triangles/s", "time per triangle", "peak bytes/triangle"], "", rows)


def seconds(run):
    """The duration of a run of an experiment, real or simulated."""
    return run["cluster"]["seconds"]


def simulator(bench):
    """The same experiment on real ranks and on simulated ones."""
    cases = [(1, [], "none"), (2, [], "none"), (2, [], "stealing"), (2, [1, 0.5], "none"), (2, [1, 0.5], "stealing")]
    measured = [median(runs, seconds) for runs in
                bench.take_turns([lambda case=case: bench.experiment("real", *case) for case in cases])]
    given = [bench.experiment("simulated", *case) for case in cases]
    # The first case determines the speed of a rank on this machine today; the others are predictions.
    speed = given[0]["cluster"]["speeds"][0] * seconds(given[0]) / measured[0]
    predicted = [seconds(bench.experiment("simulated", *case, "--set", f"cluster.speed={speed}")) for case in cases]
    rows = [[ranks, ", ".join(map(str, drag)) or "none", policy, f"{real:.3f}", f"{seconds(model):.3f}",
             f"{100 * (seconds(model) / real - 1):+.1f} %", f"{simulated:.3f}", f"{100 * (simulated / real - 1):+.1f} %"]
            for (ranks, drag, policy), real, model, simulated in zip(cases, measured, given, predicted)]
    return Table("simulator", "Simulated against real ranks: pipe",
                 ["ranks", "drag", "policy", "measured", "with constants", "error", "calibrated", "error"],
                 f"{given[0]['mesh']['triangles']:,} triangles; seconds of refinement, predicted with the constants of CostModel, and with a "
                 "rank's speed from the first row, "
                 f"{speed / 1e6:.2f} million triangles/s (constants: {given[0]['cluster']['speeds'][0] / 1e6:.2f}).", rows)


def work_speeds(run):
    """Triangles per second of work of each rank."""
    return [rank["triangles"] / rank["seconds"]["computing"] for rank in run["parts"]["ranks"]]


def reality(bench):
    """Predictions for a workload on which nothing was tuned, on ranks whose speeds are measured first: between the other
    runs, by subdomains dealt in turn, so that each rank has some of all regions. A rank that works less of the time is
    slower than that by itself, since it finds its caches cold, and three or four compete for two cores. Simulated, the
    ranks are as fast in that run. Where other programs run, start this with `chrt -r 1`."""
    drags = ([1, 0.3], [0.6, 0.6, 0.3], [0.4, 0.4, 0.3, 0.2])
    policies = ("none", "stealing", "greedy", "zoltan")
    dealt = "mapping.method=round-robin"
    cases = [(drag, *case) for drag in drags for case in [("none", dealt), *((policy,) for policy in policies)]]
    measured = dict(zip(map(str, cases), bench.take_turns([lambda case=case: bench.coast("real", *case) for case in cases])))
    costs = bench.folder / "costs.yaml"
    subprocess.run([str(bench.options.program), "calibrate", "-o", str(costs)], check=True, stdout=subprocess.DEVNULL)

    def simulated(speeds, *case):
        shares = [speed / max(speeds) for speed in speeds]
        return bench.coast("simulated", shares, *case, f"cluster.costs={costs}", f"cluster.speed={max(speeds)}",
                           f"cluster.ranks-per-host={len(speeds)}")

    rows = []
    for drag in drags:
        calibrating = measured[str((drag, "none", dealt))]
        speeds = [statistics.median(of_rank) for of_rank in zip(*map(work_speeds, calibrating))]
        # cluster.speed is that in large subdomains; in these, more of the time goes into starting them.
        again = work_speeds(simulated(speeds, "none", dealt))
        in_large = [speed**2 / seen for speed, seen in zip(speeds, again)]
        for policy in policies:
            runs = measured[str((drag, policy))]
            model = simulated(in_large, policy)
            real = median(runs, seconds)
            spread = (max(map(seconds, runs)) - min(map(seconds, runs))) / 2
            rows.append([len(drag), ", ".join(map(str, drag)), ", ".join(f"{speed / 1e6:.3f}" for speed in speeds), policy,
                         f"{real:.2f} +- {spread:.2f}", f"{seconds(model):.2f}", f"{seconds(model) / real:.3f}",
                         f"{median(runs, lambda r: total(r, 'hand_offs')):.0f}", total(model, "hand_offs")])
    triangles = measured[str(cases[0])][0]["mesh"]["triangles"]
    return Table("reality", "Simulated against real ranks on a coast",
                 ["ranks", "drag", "speeds", "policy", "real, s", "simulated, s", "simulated / real", "moved", "simulated"],
                 f"Size {bench.options.coast}, {triangles:,} triangles in 300 uneven subdomains, interfaces not presplit; seconds of refinement, "
                 "with half of their range. Two cores have to suffice, so some ranks work for a part of the time only. Speeds, in million "
                 "triangles/s, are measured in runs on subdomains dealt in turn, between the others; simulated, the ranks are as fast in those "
                 "runs, and planning costs what driftmesh calibrate measures.", rows)


def main():
    suites = {suite.__name__: suite
              for suite in (models, aggregation, breakdown, balance, size, growth, simulator, reality)}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("suite", nargs="*", help=f"{', '.join(suites)}; default: all")
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh")
    parser.add_argument("--data", default=PROJECT.parent / "shared/data",
                        help="folder of the models; missing ones are replaced by generated inputs")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2], help="models: numbers of ranks")
    parser.add_argument("--cells", type=float, default=CELLS, help="models: the area bound is the area of the domain divided by this")
    parser.add_argument("--mapping", default="graph", help="aggregation: round-robin makes every interface a border")
    parser.add_argument("--sizes", type=float, nargs="+", default=[43, 200], help="size: millions of triangles")
    parser.add_argument("--triangles", type=float, default=10e6, help="simulator: approximate number of triangles")
    parser.add_argument("--coast", default="100 + 0.05*distance()", help="reality: the size, an expression")
    results.add_option(parser)
    options = parser.parse_args()
    if unknown := set(options.suite) - set(suites):
        parser.error(f"unknown suite {', '.join(sorted(unknown))}")
    print(f"{results.processor()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}\n", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options, folder)
        results.show("bench/ranks.py", (suite(bench) for name, suite in suites.items() if not options.suite or name in options.suite),
                     options)


if __name__ == "__main__":
    sys.exit(main())
