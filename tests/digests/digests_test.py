#!/usr/bin/env python3
"""The meshes of 35 runs are the recorded ones to the last bit: one piece, subdomains, 1 to 4 ranks, every policy,
simulated clusters. What is meant to change no mesh changes none; what is meant to is recorded anew, and says so.

usage: digests_test.py DRIFTMESH [--record]
"""

import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
RECORD = HERE / "digests.json"
INPUT = HERE / "input"
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", ASAN_OPTIONS="detect_leaks=0")

PARTS = ["cylinder.poly", "--area", "0.01", "-n", "44"]
# name: (ranks, or 0 without mpirun, the options of driftmesh mesh)
MESHES = {
    "pipe": (0, ["pipe.poly", "--area", "1"]),
    "pipe at 33 degrees": (0, ["pipe.poly", "--angle", "33"]),
    "cylinder": (0, ["cylinder.poly", "--area", "0.01"]),
    "bay": (0, ["bay.poly", "--area", "300000", "--angle", "28"]),
    "bay without an area": (0, ["bay.poly", "--angle", "30"]),
    "holes": (0, ["holes.poly", "--angle", "25"]),
    "regions": (0, ["regions.poly"]),
    "regions without their areas": (0, ["regions.poly", "--no-region-areas", "--area", "0.01"]),
    "size as an expression": (0, ["regions.poly", "--size", "0.03+0.05*abs(x-2)+0.01*abs(y-1)", "--size-min", "0.04",
                                  "--size-max", "0.1"]),
    "size from a background mesh": (0, ["regions.poly", "--size-mesh", "background.node", "--gradation", "0.01"]),
    "size from a background mesh, ungraded": (0, ["regions.poly", "--size-mesh", "background.node"]),
    "subdomains": (0, ["pipe.poly", "--area", "1", "-n", "37"]),
    "subdomains with the protocol in full": (0, ["pipe.poly", "--area", "1", "-n", "37", "--presplit", "off",
                                                 "--work-order", "backlog"]),
    "uneven subdomains that sleep": (0, ["pipe.poly", "--area", "1", "-n", "25", "--split-skew", "0.7", "--seed", "5",
                                         "--sleep"]),
    "subdomains of a bay": (0, ["bay.poly", "--area", "300000", "-n", "30", "--separator-angle", "50", "--work-order",
                                "largest"]),
    "subdomains of regions": (0, ["regions.poly", "-n", "12", "--presplit", "on"]),
    "subdomains with a size field": (0, ["regions.poly", "--size", "0.03+0.05*abs(x-2)", "-n", "16"]),
    "subdomains on three threads": (0, ["pipe.poly", "--area", "1", "-n", "37", "--presplit", "off", "--work-order",
                                        "backlog", "--threads", "3"]),
    "large enough for threads": (0, ["pipe.poly", "--area", "0.3", "--threads", "2"]),
    "one rank": (1, ["cylinder.poly", "--area", "0.01"]),
    "two ranks": (2, [*PARTS, "--mapping", "block"]),
    "four ranks": (4, [*PARTS, "--mapping", "round-robin"]),
    "regions on two ranks": (2, ["regions.poly", "-n", "12", "--sleep"]),
    **{f"two ranks, {policy}": (2, [*PARTS, "--mapping", "block", "--drag", "1,0.5", "--balance", policy])
       for policy in ("none", "zoltan", "stealing", "greedy", "diffusion")},
    "three ranks of unequal speed": (3, [*PARTS, "--map-by-area", "--speeds", "1,2,1", "--balance", "zoltan"]),
}
# name: the settings of driftmesh run
EXPERIMENTS = {
    **{f"simulated, {policy}": ["bounds.triangles-per-rank=3e3", "decomposition.subdomains-per-rank=10",
                                f"balance.policy={policy}", "balance.look=1e-4", "balance.gap=2e-4"]
       for policy in ("none", "zoltan", "stealing", "greedy", "diffusion")},
    "simulated, the protocol in full": ["bounds.area=0.01", "decomposition.subdomains=30", "run.presplit=off",
                                        "run.aggregation=16", "mapping.method=round-robin"],
}
EXPERIMENT = """input: {{file: {}}}
cluster:
  groups: [{{name: fast, ranks: 3, speed: 8e6}}, {{name: slow, ranks: 3, speed: 2e6}}]
report: false
"""


def call(words):
    result = subprocess.run(words, cwd=INPUT, env=ENVIRONMENT, capture_output=True, text=True, timeout=600, check=False)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}\n{result.stdout}{result.stderr}")


def found(record):
    mesh = json.loads(record.read_text())["mesh"]
    return [mesh["digest"], mesh["triangles"]]


def mesh(program, folder, name):
    ranks, options = MESHES[name]
    record = folder / f"{name}.json"
    start = ["mpiexec", "-n", str(ranks), "--oversubscribe"] if ranks > 0 else []
    call([*start, program, "mesh", *options, "--quiet", "--json", record])
    return found(record)


def experiment(program, folder, name):
    file = folder / f"{name}.yaml"
    file.write_text(EXPERIMENT.format(INPUT / "cylinder.poly"))
    results = folder / f"{name}.runs"
    settings = [word for setting in EXPERIMENTS[name] for word in ("--set", setting)]
    call([program, "run", file, "--quiet", "-o", results, *settings])
    return found(results / "run-1.json")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(2) as pool:
        folder = pathlib.Path(name)
        jobs = {**{name: pool.submit(mesh, program, folder, name) for name in MESHES},
                **{name: pool.submit(experiment, program, folder, name) for name in EXPERIMENTS}}
        digests = {name: job.result() for name, job in jobs.items()}
    if "--record" in sys.argv:
        RECORD.write_text("{\n" + ",\n".join(f"  {json.dumps(n)}: {json.dumps(d)}" for n, d in digests.items()) + "\n}\n")
        return
    recorded = json.loads(RECORD.read_text())
    wrong = [f"{name}: {digests.get(name)}, recorded as {recorded.get(name)}"
             for name in {**recorded, **digests} if digests.get(name) != recorded.get(name)]
    print(*wrong, f"{len(digests)} meshes, {len(wrong)} not as recorded", sep="\n")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
