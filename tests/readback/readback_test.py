#!/usr/bin/env python3
"""Other programs read what driftmesh writes: counts, area, markers and regions are those of the mesh.

usage: readback_test.py [--update] DRIFTMESH MPIRUN PROJECT_FOLDER

One mesh, of two regions and five markers, is written in every format by one process and by ranks. Each reader (reader_*.py
beside this file) says in JSON what it finds, in a process of its own, on one rank or on several. The table "Read back" in
docs/file-formats.md says who reads what; --update writes it, otherwise it is compared. Readers that are not installed are
skipped, which the output says; without any of them the exit code is 77.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- readback_test.py --update -->\n", "<!-- end of the table -->\n"
PYTHON = "/usr/bin/python3"  # whose packages are Debian's

INPUT = """8 2 1 1
1 0 0 1 1
2 2 0 2 1
3 2 1 3 1
4 0 1 4 1
5 1 0 5 0
6 1 1 6 0
7 0.3 0.3 7 3
8 0.6 0.3 8 3
8 1
1 1 5 1
2 5 2 1
3 2 3 2
4 3 6 1
5 6 4 1
6 4 1 4
7 5 6 0
8 7 8 9
0
2
1 0.2 0.5 10 0
2 1.5 0.5 20 0
"""

NAMES = {"inlet": 2, "in the middle": 9, "land": 10}  # of two markers and a region
INSIDE = ("0", "9")  # markers of segments inside the domain

# Reader, its version's module, file, ranks that read, and what it can tell. "one": by one process; "ranks": by three.
ALL = ("points", "triangles", "area", "regions", "markers")
NAMED = (*ALL, "names")
GRID = ("points", "triangles", "area")
CASES = [
    ("vtk", "one.vtu", 1, NAMED), ("vtk", "ranks.pvtu", 1, NAMED), ("vtk", "ghosts.pvtu", 1, NAMED),
    ("vtk", "one.h5", 1, ALL), ("vtk", "ranks.h5", 1, ALL),
    ("meshio", "one.vtu", 1, NAMED), ("meshio", "one.msh", 1, NAMED), ("meshio", "ranks.msh", 1, NAMED),
    ("meshio", "text.msh", 1, NAMED),
    ("meshio", "plain.su2", 1, (*GRID, "boundary")),
    ("gmsh", "ranks.msh", 1, NAMED), ("gmsh", "text.msh", 1, NAMED),
    ("petsc", "ranks.msh", 1, NAMED), ("petsc", "text.msh", 1, NAMED),
    *[("petsc", file, ranks, NAMED) for file in ("one.h5", "ranks.h5") for ranks in (1, 2, 3)],
    *[("dolfinx", file, ranks, ALL) for file in ("one.xdmf", "ranks.xdmf") for ranks in (1, 2, 3)],
    ("h5py", "ranks.h5", 1, NAMED),
]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMP_NUM_THREADS="1")


def run(*words, folder):
    done = subprocess.run([str(word) for word in words], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))} ended with {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def write_meshes(program, mpirun, folder):
    (folder / "in.poly").write_text(INPUT)
    words = [program, "mesh", "in.poly", "-n", "6", "--area", "0.002", "--quiet", "--marker-name", "2=inlet",
             "--marker-name", "9=in the middle", "--region-name", "10=land"]
    run(*words, "-o", "one.vtu", "-o", "one.msh", "-o", "one.h5", folder=folder)
    run(program, "convert", "one.vtu", "plain.ele", folder=folder)
    run(program, "convert", "plain.ele", "plain.su2", folder=folder)  # without names, which meshio does not take there
    run(program, "convert", "one.vtu", "text.msh", "--ascii", folder=folder)
    run(mpirun, "-n", 3, *words, "-o", "ranks.pvtu", "-o", "ranks.msh", "-o", "ranks.h5", folder=folder)
    run(mpirun, "-n", 3, *words, "--ghost-layer", "-o", "ghosts.pvtu", folder=folder)


def facts_of_text(folder):
    """From our own text files, which Triangle's format explains, by a reader of ten lines."""
    rows = lambda name: [[float(word) for word in line.split()] for line in (folder / name).read_text().splitlines()
                         if line.strip() and not line.startswith("#")]
    points = [row[1:3] for row in rows("plain.node")[1:]]
    triangles = rows("plain.ele")[1:]
    regions, markers, area = {}, {}, 0
    for _, *corners, region in triangles:
        (ax, ay), (bx, by), (cx, cy) = (points[int(c) - 1] for c in corners)
        area += ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2
        regions[str(int(region))] = regions.get(str(int(region)), 0) + 1
    for _, _, _, marker in (row for row in rows("plain.poly")[2:] if len(row) == 4):
        if marker != -1000000:
            markers[str(int(marker))] = markers.get(str(int(marker)), 0) + 1
    return {"points": len(points), "triangles": len(triangles), "area": area, "regions": regions, "markers": markers,
            "names": NAMES, "boundary": {marker: count for marker, count in markers.items() if marker not in INSIDE}}


def answer_of(reader, file, ranks, mpirun, folder):
    """What the reader says; None if it is not installed."""
    start = [mpirun, "-n", ranks] if ranks > 1 else []
    said = run(*start, PYTHON, HERE / f"reader_{reader}.py", file, folder=folder)
    answers = [line for line in said.splitlines() if line.startswith("{")]
    if not answers:
        raise AssertionError(f"{reader} said of {file}: {said}")
    return json.loads(answers[-1])


def same(found, expected):
    if isinstance(expected, float):
        return abs(found - expected) < 1e-9
    return found == expected


def table(versions):
    rows = {}
    for reader, file, ranks, facts in CASES:
        key = (reader, file.split(".")[1], file.split(".")[0], facts)
        rows.setdefault(key, []).append(str(ranks))
    by = {"one": "one process", "ranks": "three ranks", "ghosts": "`--ghost-layer`", "text": "`--ascii`", "plain": "one process"}
    lines = ["| reader | file | written by | on ranks | compared |\n", "|---|---|---|---|---|\n"]
    for (reader, extension, origin, facts), ranks in rows.items():
        lines.append(f"| {reader} {versions.get(reader, '')} | `.{extension}` | {by[origin]} | {', '.join(ranks)} "
                     f"| {', '.join(facts)} |\n")
    return "".join(lines)


def main():
    update = "--update" in sys.argv
    program, mpirun, project = [word for word in sys.argv[1:] if word != "--update"]
    versions, missing, failures, compared = {}, {}, [], 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_meshes(pathlib.Path(program).resolve(), mpirun, folder)
        expected = facts_of_text(folder)
        for reader, file, ranks, facts in CASES:
            if reader in missing:
                continue
            try:
                found = answer_of(reader, file, ranks, mpirun, folder)
            except AssertionError as error:
                failures.append(str(error))
                continue
            if "missing" in found:
                missing[reader] = found["missing"]
                continue
            versions[reader] = found["version"]
            wrong = [f"{fact} {found.get(fact)}, not {expected[fact]}" for fact in facts
                     if not same(found.get(fact), expected[fact])]
            failures += [f"{reader} finds in {file} on {ranks} ranks: {', '.join(wrong)}"] * bool(wrong)
            compared += 1
            print(f"{reader} {found['version']} reads {file} on {ranks} ranks: {', '.join(facts)}", flush=True)
    for reader, why in missing.items():
        print(f"SKIPPED: {reader}: {why}; scripts/setup.sh readers installs it")
    page = pathlib.Path(project) / "docs/file-formats.md"
    text = page.read_text()
    before, rest = text.split(BEGIN)
    old, after = rest.split(END)
    if not missing and not failures and old != table(versions):
        if update:
            page.write_text(before + BEGIN + table(versions) + END + after)
        else:
            failures.append(f"{page} needs its table written: readback_test.py --update")
    print(*failures, sep="\n")
    print(f"{compared} read, {len(failures)} failed, {len(missing)} readers skipped")
    return 1 if failures else 77 if compared == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
