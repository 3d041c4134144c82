#!/usr/bin/env python3
"""What it costs that a mesh follows a front: a ring in the unit square, a band of short edges that widens from one generation to the next,
with a field at points that is carried along. Each generation is checked and compared with a mesh made anew by the same lengths;
prints a table in Markdown (docs/results/adaptive.md). Processor time on one thread. Needs the Python package on PYTHONPATH. With --ranks,
instead: how even the load of a solver is after each generation on ranks, and what moves for that.

usage: adaptive.py [--generations N] [--every N] [--length L]... [--freefem | --ranks N... | --simulator PROGRAM] [--program DRIFTMESH] [--update]
"""

import argparse
import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from table import Table  # noqa: E402

WIDTH, GROWTH, RADIUS, STEP = 0.06, 0.2, 0.15, 0.003


def ring(points, shortest, generation, center=(0.5, 0.5)):
    """Lengths: short in a band around a circle, growing beyond it."""
    away = np.abs(np.hypot(*(points - center).T) - RADIUS - STEP * generation) - WIDTH / 2
    return shortest + GROWTH * np.maximum(0, away)


def square():
    return driftmesh.Pslg([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]])


def timed(work):
    start = time.process_time()
    result = work()
    return result, time.process_time() - start


class Row:
    """Sums over the generations of a mesh with this shortest length."""

    def __init__(self, shortest, transfer, options):
        self.shortest, self.options = shortest, options
        self.triangles = self.new = self.seconds = self.anew = 0
        self.compared, self.density, self.angle = 0, [], 180.0
        start = driftmesh.mesh(square(), max_area=1e-3)
        for _ in range(6):  # until the ring is found
            size = driftmesh.size_on_mesh(start, ring(start.points, shortest, 0), gradation=GROWTH)
            start = driftmesh.mesh(square(), size=size, size_resolution=1, threads=1)
        self.mesh = driftmesh.AdaptiveMesh(square(), size=size, size_resolution=1, threads=1, gradation=GROWTH)
        self.mesh.attach("u", self.mesh.mesh.points[:, 0], transfer=transfer)
        for generation in range(1, options.generations + 1):
            self.advance(generation)

    def advance(self, generation):
        before = self.mesh.mesh
        lengths = ring(before.points, self.shortest, generation)
        self.seconds += timed(lambda: self.mesh.adapt(lengths))[1]
        stayed = self.mesh.stayed_triangles
        self.triangles += len(stayed)
        self.new += np.count_nonzero(stayed < 0)
        if generation % self.options.every:
            return
        after = self.mesh.mesh
        size = driftmesh.size_on_mesh(before, lengths, gradation=GROWTH)
        report = driftmesh.check(after, square(), size=lambda x, y: size(x, y), size_resolution=1)
        if not report:
            raise SystemExit(f"generation {generation}: {report.text}{report.verdict}")
        self.angle = min(self.angle, report.smallest_angle)
        anew, seconds = timed(lambda: driftmesh.mesh(square(), threads=1, size_resolution=1, size=driftmesh.size_on_mesh(
            before, lengths, gradation=GROWTH)))
        self.compared += len(anew.triangles)
        self.anew += seconds
        self.density.append(len(after.triangles) / len(anew.triangles))

    def cells(self):
        each, anew = self.seconds / self.triangles * 1e6, self.anew / self.compared * 1e6
        generations = self.options.generations
        return [self.triangles // generations, f"{self.new / self.triangles:.3f}", f"{each:.2f}", f"{anew:.2f}", f"{each / anew:.2f}",
                f"{max(self.density):.3f}", f"{self.angle:.1f}"]


def measured(options):
    table = Table("adaptive", f"A ring that widens, {options.generations} generations",
                  ["shortest", "transfer", "triangles", "share that is new", "us for each", "made anew", "ratio", "denser at most", "smallest angle"],
                  "Processor time on one thread, in microseconds for each triangle of a generation, with transfer of one field; made anew: by "
                  f"`size_on_mesh` and `mesh` (`size_resolution=1`). Every {options.every}th generation is checked, and compared with the mesh made anew.")
    for shortest in options.length or [0.002, 0.001]:
        for transfer in ("interpolate", "conserve"):
            table.add(shortest, transfer, *Row(shortest, transfer, options).cells())
    return table


PEER = """
func real h(real radius) {{ return {shortest} + {growth} * max(0., abs(sqrt((x - 0.5)^2 + (y - 0.5)^2) - radius) - {width} / 2); }}
mesh T = square(10, 10);
for (int k = 0; k < 12; ++k) T = adaptmesh(T, h({first}), IsMetric = 1, nbvx = 10000000, hmax = 1, verbosity = 0);
fespace V(T, P1);
V u = x;
real start = clock();
mesh N = adaptmesh(T, h({second}), IsMetric = 1, nbvx = 10000000, hmax = 1, verbosity = 0);
fespace W(N, P1);
W v = u;
cout << "made " << N.nt << " " << clock() - start << endl;
"""
PEERS_RADII = (RADIUS, RADIUS + WIDTH)


def by_freefem(program, shortest):
    """Triangles and seconds of adaptmesh with an isotropic metric, interpolation of one field included."""
    with tempfile.TemporaryDirectory() as folder:
        script = pathlib.Path(folder, "ring.edp")
        script.write_text(PEER.format(shortest=shortest, growth=GROWTH, width=WIDTH, first=PEERS_RADII[0], second=PEERS_RADII[1]))
        said = subprocess.run([program, "-nw", "-v", "0", script], check=True, capture_output=True, text=True).stdout
    triangles, seconds = said[said.index("made "):].split()[1:3]
    return int(triangles), float(seconds)


def by_driftmesh(shortest):
    """The same, with a conserving transfer."""
    first, second = (round((radius - RADIUS) / STEP) for radius in PEERS_RADII)
    mesh = driftmesh.AdaptiveMesh(square(), max_area=1e-3, threads=1, gradation=GROWTH)
    for _ in range(12):
        mesh.adapt(ring(mesh.mesh.points, shortest, first))
    mesh.attach("u", mesh.mesh.points[:, 0], transfer="conserve")
    lengths = ring(mesh.mesh.points, shortest, second)
    seconds = timed(lambda: mesh.adapt(lengths))[1]
    return len(mesh.mesh.triangles), np.count_nonzero(mesh.stayed_triangles < 0), seconds


def beside_freefem(options):
    program = shutil.which("FreeFem++-nw")
    if program is None:
        raise SystemExit("FreeFem++-nw is not there; install freefem++")
    table = Table("adaptive-freefem", "A ring that jumps, beside FreeFEM's adaptmesh",
                  ["shortest", "triangles", "share that is new", "us for each", "FreeFEM: triangles", "us for each", "ratio"],
                  f"From radius {PEERS_RADII[0]:g} to {PEERS_RADII[1]:g}, by the same lengths at points. Processor time on one thread with transfer of one field: ours "
                  f"conserves it, FreeFEM's interpolates; medians of {options.repetitions}.")
    for shortest in options.length or [0.002, 0.001]:
        runs = [(*by_driftmesh(shortest), *by_freefem(program, shortest)) for _ in range(options.repetitions)]
        ours, new, _, peers, _ = runs[0]
        each, peer = statistics.median(run[2] for run in runs) / ours * 1e6, statistics.median(run[4] for run in runs) / peers * 1e6
        table.add(shortest, ours, f"{new / ours:.2f}", f"{each:.2f}", peers, f"{peer:.1f}", f"{peer / each:.0f}")
    return table


ASIDE = (0.2, 0.3)  # what widens around the middle would load all ranks alike


def size_of_ring(shortest, generation):
    """By lengths on a mesh that has them already."""
    start = driftmesh.mesh(square(), max_area=1e-3, threads=1)
    for _ in range(6):
        size = driftmesh.size_on_mesh(start, ring(start.points, shortest, generation, ASIDE), gradation=GROWTH)
        start = driftmesh.mesh(square(), size=size, size_resolution=1, threads=1)
    return size, start


def first_on_ranks(communicator, shortest, subdomains):
    size, _ = size_of_ring(shortest, 0)
    return driftmesh.DistributedAdaptiveMesh(communicator, square(), size=size, size_resolution=1, threads=1, gradation=GROWTH,
                                             subdomains={"count": subdomains} if subdomains else {})


def load_by_subdomain(communicator, mesh):
    """The rank and the triangles of each subdomain: what a solver has to do that takes the same time for every triangle."""
    own = zip(*(part.tolist() for part in np.unique(mesh.piece.mesh.subdomains, return_counts=True)))
    return {s: (rank, load) for rank, part in enumerate(communicator.allgather(list(own))) for s, load in part}


def sums(loads, ranks):
    of_ranks = [0] * ranks
    for rank, load in loads:
        of_ranks[rank] += load
    return of_ranks


def follow_on_ranks(communicator, shortest, subdomains, generations):
    """For each generation: largest load over the mean if nothing moved, and as it is; what moved, and what was above 1.05 of the mean."""
    mesh = first_on_ranks(communicator, shortest, subdomains)
    mesh.attach("u", mesh.piece.mesh.points[:, 0])
    before, rows = load_by_subdomain(communicator, mesh), []
    for generation in range(1, generations + 1):
        mesh.adapt(ring(mesh.piece.mesh.points, shortest, generation, ASIDE))
        after = load_by_subdomain(communicator, mesh)
        # what is joined goes to the rank of the largest of its parts, and what is divided is where it was
        home = {s: before[max(of_one, key=lambda p: before[p][1])][0] for s, of_one in enumerate(mesh.parents)}
        gathered = {p: load for s, of_one in enumerate(mesh.parents) for p in of_one for rank, load in [before[p]] if rank != home[s]}
        stay, now = (sums(loads, communicator.size) for loads in
                     ([(home[s], load) for s, (_, load) in after.items()], after.values()))
        mean = sum(now) / communicator.size
        rows.append({"triangles": sum(now), "subdomains": len(after), "before": max(stay) / mean, "after": max(now) / mean,
                     "moved": sum(load for s, (rank, load) in after.items() if rank != home[s]) + sum(gathered.values()),
                     "above": sum(max(0, load - 1.05 * mean) for load in stay)})
        before = after
    rows[-1]["denser"] = rows[-1]["triangles"] / len(size_of_ring(shortest, generations)[1].triangles)
    return rows


def worker(options):
    from mpi4py import MPI
    rows = [follow_on_ranks(MPI.COMM_WORLD, shortest, subdomains, options.generations)
            for shortest in options.length for subdomains in options.subdomains]
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps(rows))


def on_ranks(options):
    table = Table("adaptive-ranks", f"The load of a solver on ranks, {options.generations} generations",
                  ["ranks", "shortest", "triangles", "denser", "subdomains", "fences with moves", "if nothing moved", "largest over mean", "moved", "above", "moved over above"],
                  f"Around {ASIDE}. The solver takes the same time for each triangle. Largest load of a rank over the mean at the worst fence, as it is and as it would be if what "
                  "that fence moved had stayed. Moved: triangles at all fences together; above: sums over ranks of the load beyond 1.05 of the mean before that. "
                  "What is joined is first brought to the rank of the largest of its parts, which counts as moved. Denser: triangles at the end, in those of a mesh in one "
                  "piece that is made anew.")
    lengths = options.length or [0.002, 0.001]
    for ranks in options.ranks:
        said = subprocess.run(["mpirun", "--oversubscribe", "-n", str(ranks), sys.executable, __file__, "--worker", "--generations",
                               str(options.generations), *(word for length in lengths for word in ("--length", str(length))),
                               "--subdomains", *map(str, options.subdomains)],
                              check=True, capture_output=True, text=True).stdout
        for shortest, rows in zip([length for length in lengths for _ in options.subdomains], json.loads(said)):
            moved, above = (sum(row[key] for row in rows) for key in ("moved", "above"))
            table.add(ranks, shortest, rows[-1]["triangles"], f"{rows[-1]['denser']:.3f}", rows[-1]["subdomains"], sum(row["moved"] > 0 for row in rows),
                      f"{max(row['before'] for row in rows):.3f}", f"{max(row['after'] for row in rows):.3f}", moved, round(above),
                      f"{moved / above:.2f}" if above else "")
    return table


def simulated(options):
    table = Table("adaptive-simulated", f"512 simulated ranks, {options.generations} generations",
                  ["generations", "triangles", "placing", "efficiency", "largest over mean", "triangles moved", "largest subdomain"],
                  "16 subdomains for each rank, and a solver of 1 us for a triangle and a step, 20 steps in a generation. Efficiency: its time on ranks that have equally "
                  "much, over that of all generations so far: each is made by those who hold it (times of this machine, one thread), subdomains move (1 GB/s, "
                  "0.1 us to pack and unpack a triangle), and all wait for the slowest; without the time of planning. Largest load of a rank over the mean at the "
                  "worst fence so far; largest subdomain in means of a rank. Placing: none; ours: few moves, or Zoltan's repartition and few moves; repartition: "
                  "Zoltan's alone; from scratch: the same without regard to where subdomains are.")
    said = subprocess.run([options.simulator, "512", "16", str((options.length or [0.0005])[0]), str(options.generations)], check=True,
                          capture_output=True, text=True).stdout
    for line in said.splitlines():
        table.add(*line.strip("| ").split(" | "))
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\nusage")[0])
    parser.add_argument("--generations", type=int, default=20)
    parser.add_argument("--every", type=int, default=10, help="check and compare only every N-th generation")
    parser.add_argument("--length", type=float, action="append", help="shortest length in the ring; 0.0005 makes about 2 million triangles")
    parser.add_argument("--repetitions", type=int, default=3, help="beside FreeFEM")
    parser.add_argument("--freefem", action="store_true", help="compare with FreeFEM's adaptmesh instead")
    parser.add_argument("--ranks", type=int, nargs="+", metavar="N", help="on so many ranks instead")
    parser.add_argument("--subdomains", type=int, nargs="+", default=[0, 120, 400], metavar="N", help="of ranks; 0: by default")
    parser.add_argument("--simulator", metavar="PROGRAM", help="driftmesh_bench_adaptive_ranks: on simulated ranks instead")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)  # one of these ranks
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh", help="says which compiler it was")
    results.add_option(parser)
    options = parser.parse_args()
    global driftmesh, np  # only to measure: --help does without
    if not options.simulator:
        import driftmesh
        import numpy as np
    if options.worker:
        return worker(options)
    suite = beside_freefem if options.freefem else on_ranks if options.ranks else simulated if options.simulator else measured
    results.show("bench/adaptive.py", map(suite, [options]), options)


if __name__ == "__main__":
    main()
