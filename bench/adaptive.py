#!/usr/bin/env python3
"""What it costs that a mesh follows a front: a ring in the unit square, a band of short edges that widens from one generation to the next,
with a field at points that is carried along. Each generation is checked and compared with a mesh made anew by the same lengths;
prints a table in Markdown (docs/results/adaptive.md). Processor time on one thread. Needs the Python package on PYTHONPATH. With --ranks,
instead: how even the load of a solver is after each generation on ranks, and what moves for that. With --peer:
generations of which all is made anew, beside FreeFEM's adaptmesh. With --save: how fast a session is written, beside
dd. With --memory: how much a generation takes at its worst moment. With --files: driftmesh adapt of a whole mesh.

usage: adaptive.py [--generations N] [--every N] [--length L]... [--program DRIFTMESH] [--update]
                   [--peer | --save | --memory | --files | --ranks N... | --simulator PROGRAM]
"""

import argparse
import ctypes
import json
import os
import pathlib
import re
import resource
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


def settled(shortest, generation=0, threads=1, transfer="conserve"):
    """A session whose mesh is as the lengths of a ring ask for, with a field."""
    mesh = driftmesh.AdaptiveMesh(square(), max_area=1e-3, threads=threads, gradation=GROWTH)
    for _ in range(12):
        mesh.adapt(ring(mesh.mesh.points, shortest, generation))
    mesh.attach("u", mesh.mesh.points[:, 0], transfer=transfer)
    return mesh


JUMP = round(WIDTH / STEP)  # generations until the ring is where it was not
SHORTER = 0.7
# What changes all at once: factor on all lengths, and generation of the ring.
CHANGES = {f"all lengths times {SHORTER:g}": (SHORTER, 0), "the ring jumps": (1, JUMP)}

PEER = """
func real h(real radius) {{
  return {shortest} + {growth} * max(0., abs(sqrt((x - 0.5)^2 + (y - 0.5)^2) - radius) - {width} / 2);
}}
mesh T = square(10, 10);
for (int k = 0; k < 6; ++k)
  T = adaptmesh(T, h({first}), IsMetric = 1, nbvx = {room}, hmax = 1, verbosity = 0);
fespace V(T, P1);
V u = x;
for (int k = 0; k < {repetitions}; ++k) {{
  real begin = clock();
  mesh N = adaptmesh(T, {factor} * h({second}), IsMetric = 1, nbvx = {room}, hmax = 1, verbosity = 0);
  real made = clock();
  fespace W(N, P1);
  W v = u;
  real there = clock();
  cout << "made " << N.nt << " " << made - begin << " " << there - made << endl;
}}
"""


def by_freefem(program, shortest, factor, generation, room, repetitions):
    """Triangles, seconds of adaptmesh with an isotropic metric, and seconds of interpolating one field. `room`: for
    points, which it takes at once; much more than it needs would cost it time."""
    with tempfile.TemporaryDirectory() as folder:
        script = pathlib.Path(folder, "ring.edp")
        script.write_text(PEER.format(shortest=shortest, growth=GROWTH, width=WIDTH, factor=factor, room=room,
                                      first=RADIUS, second=RADIUS + STEP * generation, repetitions=repetitions))
        said = subprocess.run([program, "-nw", "-v", "0", script], check=True, stdout=subprocess.PIPE, text=True).stdout
    runs = [tuple(map(float, words)) for words in re.findall(r"made (\d+) (\S+) (\S+)", said)]
    triangles, made, interpolated = (statistics.median(column) for column in zip(*runs))
    return int(triangles), made, interpolated


def by_driftmesh(shortest, factor, generation, repetitions):
    """Triangles, those that are new, seconds, and those of them that the conserving transfer of one field took."""
    runs = []
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "settled.h5")
        mesh = settled(shortest)
        mesh.save(path)
        lengths = factor * ring(mesh.mesh.points, shortest, generation)
        for _ in range(repetitions):
            mesh = driftmesh.AdaptiveMesh.load(path, threads=1)
            seconds = timed(lambda: mesh.adapt(lengths))[1]
            runs.append((seconds, seconds * mesh.report["transfer"] / mesh.report["seconds"]))
    seconds, transfer = (statistics.median(column) for column in zip(*runs))
    return len(mesh.mesh.triangles), np.count_nonzero(mesh.stayed_triangles < 0), seconds, transfer


def beside_freefem(options):
    program = shutil.which("FreeFem++-nw")
    if program is None:
        raise SystemExit("FreeFem++-nw is not there; install freefem++")
    table = Table("adaptive-peer", "All made anew, beside FreeFEM's adaptmesh",
                  ["shortest", "change", "triangles", "share that is new", "us for each", "of these, transfer",
                   "FreeFEM: triangles", "us for each", "and interpolation", "ratio"],
                  "Both by the same lengths at the points of a mesh that is as the ring before asks for. Processor "
                  "time on one thread, in microseconds for each triangle of the new mesh. Ours includes the transfer "
                  "of one field, whose integral is conserved; what FreeFEM's interpolation of one takes is beside it, "
                  f"and not in the ratio. The ring jumps by its width. Medians of {options.repetitions}.")
    for shortest in options.length or [0.0011]:
        for change, (factor, generation) in CHANGES.items():
            ours, new, *seconds = by_driftmesh(shortest, factor, generation, options.repetitions)
            each, transfer = (value / ours * 1e6 for value in seconds)
            theirs, *seconds = by_freefem(program, shortest, factor, generation, ours,
                                         options.repetitions)
            peer, interpolated = (value / theirs * 1e6 for value in seconds)
            table.add(shortest, change, ours, f"{new / ours:.3f}", f"{each:.2f}", f"{transfer:.2f}", theirs,
                      f"{peer:.1f}", f"{interpolated:.1f}", f"{peer / each:.1f}")
    return table


def said_by(worker, *words, ranks=0):
    """What a worker returns in a process of its own, or its first rank on so many."""
    on = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks else []
    return json.loads(subprocess.run([*on, sys.executable, __file__, "--worker", worker, *map(str, words)], check=True,
                                     stdout=subprocess.PIPE, text=True).stdout)


def world():
    from mpi4py import MPI
    return MPI.COMM_WORLD


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


def follow(options):
    communicator = world()
    rows = [follow_on_ranks(communicator, shortest, subdomains, options.generations)
            for shortest in options.length for subdomains in options.subdomains]
    return rows if communicator.rank == 0 else None


def on_ranks(options):
    table = Table("adaptive-ranks", f"The load of a solver on ranks, {options.generations} generations",
                  ["ranks", "shortest", "triangles", "denser", "subdomains", "fences with moves", "if nothing moved", "largest over mean", "moved", "above", "moved over above"],
                  f"Around {ASIDE}. The solver takes the same time for each triangle. Largest load of a rank over the mean at the worst fence, as it is and as it would be if what "
                  "that fence moved had stayed. Moved: triangles at all fences together; above: sums over ranks of the load beyond 1.05 of the mean before that. "
                  "What is joined is first brought to the rank of the largest of its parts, which counts as moved. Denser: triangles at the end, in those of a mesh in one "
                  "piece that is made anew.")
    lengths = options.length or [0.002, 0.001]
    for ranks in options.ranks:
        words = [word for length in lengths for word in ("--length", length)]
        said = said_by("follow", "--generations", options.generations, *words, "--subdomains", *options.subdomains,
                       ranks=ranks)
        for shortest, rows in zip([length for length in lengths for _ in options.subdomains], said):
            moved, above = (sum(row[key] for row in rows) for key in ("moved", "above"))
            table.add(ranks, shortest, rows[-1]["triangles"], f"{rows[-1]['denser']:.3f}", rows[-1]["subdomains"], sum(row["moved"] > 0 for row in rows),
                      f"{max(row['before'] for row in rows):.3f}", f"{max(row['after'] for row in rows):.3f}", moved, round(above),
                      f"{moved / above:.2f}" if above else "")
    return table


def await_all(communicator):
    """Waits for the other ranks, and leaves the processor to them."""
    there = communicator.Ibarrier()
    while not there.Test():
        time.sleep(0.001)


def mixed(bits):
    """The finalizer of splitmix64."""
    bits = (bits ^ bits >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ bits >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return bits ^ bits >> np.uint64(31)


def digest(communicator, mesh):
    """Of all ranks: triangles, and a sum of what coordinates and values of the field at their corners mix to."""
    columns = (*mesh.piece.mesh.points.T, mesh.field("u").ravel())
    x, y, u = (np.ascontiguousarray(values + 0.0).view(np.uint64) for values in columns)
    corners = mixed(mixed(mixed(x + np.uint64(0x9E3779B97F4A7C15)) + y) + u)
    a, b, c = (corners[of_triangle] for of_triangle in mesh.piece.mesh.triangles.T)
    edges = sum(mixed(p + np.uint64(2) * q) for p, q in ((a, b), (b, c), (c, a)))
    all_sums = communicator.allgather((len(a), int(mixed(edges).sum())))
    return [sum(count for count, _ in all_sums), sum(part for _, part in all_sums) % 2**64]


def seconds_to_write(path, write):
    """Until write() returns, and until what it wrote is on the disk."""
    start = time.monotonic()
    write()
    returned = time.monotonic() - start
    with open(path, "rb") as file:
        os.fsync(file.fileno())
    return returned, time.monotonic() - start


def by_dd(path, size):
    subprocess.run(["dd", "if=/dev/zero", f"of={path}", "bs=1M", f"count={size}", "iflag=count_bytes"], check=True,
                   stderr=subprocess.DEVNULL)


def save(options):
    """Ranks save, and the first one of them calls dd, in turn. The last file stays."""
    communicator = world()
    mesh = driftmesh.DistributedAdaptiveMesh(communicator, square(), triangles=options.triangles, threads=1)
    mesh.attach("u", mesh.piece.mesh.points[:, 0], transfer="conserve")
    file, other = pathlib.Path(options.folder, "session.h5"), pathlib.Path(options.folder, "dd.bin")
    rounds = []
    for _ in range(options.repetitions):
        if communicator.rank == 0:
            file.unlink(missing_ok=True)
            subprocess.run(["sync"], check=True)
        await_all(communicator)
        ours = seconds_to_write(file, lambda: mesh.save(file))
        await_all(communicator)
        if communicator.rank == 0:
            size = file.stat().st_size
            rounds.append((*ours, *seconds_to_write(other, lambda: by_dd(other, size))))
            other.unlink()
    told = digest(communicator, mesh)
    return {"digest": told, "bytes": size, "rounds": rounds} if communicator.rank == 0 else None


def load(options):
    communicator = world()
    mesh = driftmesh.DistributedAdaptiveMesh.load(communicator, pathlib.Path(options.folder, "session.h5"), threads=1)
    told = digest(communicator, mesh)
    return told if communicator.rank == 0 else None


LOADING_RANKS = (1, 2, 3)


def beside_dd(options):
    table = Table("adaptive-save", "A session that is saved, beside dd",
                  ["ranks", "triangles", "GB", "saved in", "dd", "speed over dd's", "saved, and on the disk",
                   "dd, and on the disk", "speed over dd's", "the same on ranks that load it"],
                  "Seconds by the clock, with one field. One process of dd writes as many bytes to the same folder "
                  f"while the ranks hold the session; medians of {options.repetitions} in turn. Neither asks for the "
                  "disk by itself; then `fsync` of the file, for both. The same: the mesh and the field, by a digest.")
    for ranks in options.savers:
        with tempfile.TemporaryDirectory(dir=options.folder) as folder:
            said = said_by("save", "--triangles", options.triangles, "--folder", folder,
                           "--repetitions", options.repetitions, ranks=ranks)
            loads = [said_by("load", "--folder", folder, ranks=loading) for loading in LOADING_RANKS]
        if any(told != said["digest"] for told in loads):
            raise SystemExit(f"{ranks} ranks saved {said['digest']}, loaded: {loads}")
        ours, ours_on_disk, dd, dd_on_disk = (statistics.median(column) for column in zip(*said["rounds"]))
        table.add(ranks, said["digest"][0], f"{said['bytes'] / 1e9:.2f}",
                  f"{ours:.2f} s", f"{dd:.2f} s", f"{dd / ours:.2f}",
                  f"{ours_on_disk:.2f} s", f"{dd_on_disk:.2f} s", f"{dd_on_disk / ours_on_disk:.2f}",
                  ", ".join(map(str, LOADING_RANKS)))
    return table


MOVES = {"the ring moves on": (1, 2), "the ring jumps": (1, JUMP), f"all lengths times {SHORTER:g}": (SHORTER, 1),
         f"all lengths over {SHORTER:g}": (1 / SHORTER, 1)}  # as CHANGES, from generation 1


def lengths_of_change(folder, change):
    return pathlib.Path(folder, f"{change}.npy")


def prepare(options):
    """Saves a session, and lengths for its next generation and for each change then: who measures needs no points."""
    shortest, = options.length
    mesh = settled(shortest, threads=options.threads)
    mesh.save(pathlib.Path(options.folder, "session.h5"))
    np.save(lengths_of_change(options.folder, "first"), ring(mesh.mesh.points, shortest, 1))
    mesh.adapt(ring(mesh.mesh.points, shortest, 1))
    for change, (factor, generation) in MOVES.items():
        np.save(lengths_of_change(options.folder, change), factor * ring(mesh.mesh.points, shortest, generation))
    return len(mesh.mesh.triangles)


def memory_of_process(key):
    """VmRSS: what it has, without what is free; VmHWM: the most that it had."""
    if key == "VmRSS":
        ctypes.CDLL(None).malloc_trim(0)
    return int(re.search(rf"{key}:\s*(\d+) kB", pathlib.Path("/proc/self/status").read_text())[1]) * 1024


def change_once(options):
    """Memory that a session takes before and after a change, and at most meanwhile, without that of Python."""
    settled(0.05)  # so that all of the program is in memory
    first, lengths = (np.load(lengths_of_change(options.folder, change)) for change in ("first", options.change))
    alone = memory_of_process("VmRSS") - first.nbytes - lengths.nbytes
    mesh = driftmesh.AdaptiveMesh.load(pathlib.Path(options.folder, "session.h5"), threads=options.threads)
    mesh.adapt(first)
    del first
    before = memory_of_process("VmRSS")
    pathlib.Path("/proc/self/clear_refs").write_text("5")  # VmHWM begins anew
    mesh.adapt(lengths)
    most = memory_of_process("VmHWM")
    after = memory_of_process("VmRSS")
    return {"before": before - alone, "after": after - alone, "most": most - alone,
            "triangles": len(mesh.mesh.triangles),
            "fates": [mesh.report[fate] for fate in ("kept", "mended", "remade")]}


def at_worst(options):
    table = Table("adaptive-memory", "Memory at the worst moment of a generation",
                  ["change", "triangles before", "after", "subdomains kept, mended, remade", "held before", "after",
                   "at most", "over before", "over the larger of both"],
                  f"Resident memory of a process (threads: {options.threads}) that loads a session with one field, "
                  "whose integral is conserved, and moves on twice, without what Python takes; the second time counts. "
                  "Held: after `malloc_trim`, with the lengths that it is given; at most: VmHWM. The old mesh is not "
                  "kept.")
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        words = ["--folder", folder, "--threads", options.threads]
        triangles = said_by("prepare", *words, "--length", (options.length or [0.00033])[0])
        for change in MOVES:
            said = said_by("change", *words, "--change", change)
            held = max(said["before"], said["after"])
            table.add(change, triangles, said["triangles"], ", ".join(map(str, said["fates"])),
                      *(f"{said[key] / 1e6:.0f} MB" for key in ("before", "after", "most")),
                      f"{said['most'] / said['before']:.2f}", f"{said['most'] / held:.2f}")
    return table


def run_program(options, folder, *words):
    """Seconds by the clock and of processor time, and what it said."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    said = subprocess.run([options.program, *map(str, words)], cwd=folder, check=True, capture_output=True, text=True).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.perf_counter() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, said


def in_files(options):
    """A mesh in a file that is made anew as a whole."""
    table = Table("adaptive-files", "A mesh in a file, all made anew",
                  ["triangles before", "after", "threads", "seconds", "us for each", "mesh: seconds", "us for each"],
                  "`driftmesh adapt` of a mesh of `generate bay` with triangles of one area, to lengths of 30 at most, and `driftmesh mesh` "
                  "of as many triangles of one area: seconds by the clock, and processor time of the whole process for each triangle made, "
                  f"with reading and writing .vtu. Medians of {options.repetitions}.")
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        run_program(options, folder, "generate", "bay", "-o", "bay.poly")
        run_program(options, folder, "mesh", "bay.poly", "--area", 600, "-o", "old.vtu")
        for threads in 1, 2:
            adapts, meshes = [], []
            for _ in range(options.repetitions):
                adapts.append(run_program(options, folder, "adapt", "old.vtu", "--max-length", 30, "--threshold", 1,
                                          "--threads", threads, "-o", "new.vtu"))
                before, after = map(int, re.search(r"(\d+) before, (\d+) now", adapts[-1][2]).groups())
                meshes.append(run_program(options, folder, "mesh", "bay.poly", "--triangles", after, "--threads", threads, "-o", "mesh.vtu"))
            row = [before, after, threads]
            for runs in adapts, meshes:
                row += [f"{statistics.median(run[0] for run in runs):.1f}",
                        f"{statistics.median(run[1] for run in runs) / after * 1e6:.2f}"]
            table.add(*row)
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


WORKERS = {"follow": follow, "save": save, "load": load, "prepare": prepare, "change": change_once}


def work(options):
    said = WORKERS[options.worker](options)
    if said is not None:
        print(json.dumps(said))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\nusage")[0])
    parser.add_argument("--generations", type=int, default=20)
    parser.add_argument("--every", type=int, default=10, help="check and compare only every N-th generation")
    parser.add_argument("--length", type=float, action="append",
                        help="shortest in the ring; 0.0005 makes about a million triangles")
    parser.add_argument("--repetitions", type=int, default=3, help="beside FreeFEM and dd")
    suites = parser.add_mutually_exclusive_group()
    suites.add_argument("--peer", action="store_true", help="compare with FreeFEM's adaptmesh instead")
    suites.add_argument("--save", action="store_true", help="compare saving with dd instead")
    suites.add_argument("--memory", action="store_true", help="measure memory instead")
    suites.add_argument("--files", action="store_true", help="measure driftmesh adapt instead")
    suites.add_argument("--ranks", type=int, nargs="+", metavar="N", help="on so many ranks instead")
    suites.add_argument("--simulator", metavar="PROGRAM",
                        help="driftmesh_bench_adaptive_ranks: on simulated ranks instead")
    suites.add_argument("--worker", choices=WORKERS, help=argparse.SUPPRESS)  # a process of one of these
    parser.add_argument("--subdomains", type=int, nargs="+", default=[0, 120, 400], metavar="N",
                        help="of ranks; 0: by default")
    parser.add_argument("--savers", type=int, nargs="+", default=[1, 2], metavar="N", help="ranks that save")
    parser.add_argument("--triangles", type=float, default=20e6, help="that are saved")
    parser.add_argument("--folder", help="for files, on the disk in question; default: that of temporary files")
    parser.add_argument("--threads", type=int, default=1, help="whose memory is measured")
    parser.add_argument("--change", help=argparse.SUPPRESS)
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh", help="says which compiler it was")
    results.add_option(parser)
    options = parser.parse_args()
    global driftmesh, np  # only to measure: --help does without
    if not options.simulator and not options.files:
        import driftmesh
        import numpy as np
    if options.worker:
        return work(options)
    suite = (beside_freefem if options.peer else beside_dd if options.save else at_worst if options.memory else in_files if options.files
             else on_ranks if options.ranks else simulated if options.simulator else measured)
    results.show("bench/adaptive.py", map(suite, [options]), options)


if __name__ == "__main__":
    main()
