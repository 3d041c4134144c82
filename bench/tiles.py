#!/usr/bin/env python3
"""A coast with depths in many tiles: how long sizes by five rules and a mesh of millions of points take, and how much memory; prints a
table in Markdown (docs/results/tiles.md). The tiles are GeoTIFFs of longitudes and latitudes that this makes, with a shelf, channels and
noise, and the coast is a line through them. Reading is measured once more alone, by one thread.

usage: tiles.py [--program DRIFTMESH] [--across N] [--upward N] [--side N] [--points N] [--threads N] [--folder FOLDER] [--update]
"""

import argparse
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(PROJECT / "scripts" / "tables"))
import results  # noqa: E402
from table import Table  # noqa: E402

try:
    import numpy as np
except ImportError:  # --help works without
    np = None

WEST, SOUTH, TILE = -76.0, 27.0, 0.25  # degrees
TIDE, SLOPE, COAST, DEEP, CFL = ("44714*sqrt(9.81*depth)/400", "0.4*depth/max(slope(depth), 0.001)", "120 + 0.05*distance(1)",
                                 "100 + 2*depth", "4*sqrt(9.81*depth)/0.5")
RULES = f"max({CFL}, min({TIDE}, min({SLOPE}, min({COAST}, {DEEP}))))"


COARSE = 3  # by how much lengths are multiplied to find out how many points there will be; few enough of them must be the coast's


def write_geotiff(path, west, north, step, values):
    """One strip of single precision, in degrees on WGS 84; `values` from the northernmost row on."""
    rows, columns = values.shape
    data = values.astype("<f4").tobytes()
    scale, place = struct.pack("<3d", step, step, 0), struct.pack("<6d", 0, 0, 0, west, north, 0)
    keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326)
    entries = [(256, 4, 1, columns), (257, 4, 1, rows), (258, 3, 1, 32), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 1, None), (277, 3, 1, 1),
               (278, 4, 1, rows), (279, 4, 1, len(data)), (339, 3, 1, 3), (33550, 12, 3, None), (33922, 12, 6, None), (34735, 3, 16, None)]
    behind = 8 + 2 + 12 * len(entries) + 4
    places = {33550: behind, 33922: behind + len(scale), 34735: behind + len(scale) + len(place)}
    places[273] = behind + len(scale) + len(place) + len(keys)
    head = b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", len(entries))
    for tag, kind, count, value in entries:
        head += struct.pack("<HHII", tag, kind, count, places[tag] if value is None else value)
    path.write_bytes(head + struct.pack("<I", 0) + scale + place + keys + data)


def depths(x, y):
    """Deeper to the east, with channels and noise of several lengths."""
    shelf = 5 + 900 * np.clip((x - WEST) / 3, 0, 1) ** 2
    channels = 40 * np.exp(-(np.sin(3 * y + np.sin(2 * x)) / 0.15) ** 2)
    noise = sum(np.sin(k * x * 1.3 + 2 * np.cos(k * y)) / k for k in (7, 31, 101, 397))
    return np.maximum(shelf + channels + 3 * noise, 1)


def write_tiles(folder, across, upward, side):
    paths, step = [], TILE / side
    for i in range(across):
        for j in range(upward):
            west, north = WEST + TILE * i, SOUTH + TILE * (j + 1)
            x, y = np.meshgrid(west + step * (np.arange(side) + 0.5), north - step * (np.arange(side) + 0.5))
            paths.append(folder / f"tile_{i}_{j}.tif")
            write_geotiff(paths[-1], west, north, step, depths(x, y))
    return paths


def write_coast(path, across, upward):
    """From the coast, a rough line, to the frame."""
    random = np.random.default_rng(1)
    south, north, east = SOUTH + 0.05, SOUTH + TILE * upward - 0.05, WEST + TILE * across - 0.05
    y = np.linspace(north, south, 400 * upward)
    x = WEST + 0.15 + 0.05 * np.sin(9 * y) + np.cumsum(random.normal(0, 2e-4, len(y)))
    x = np.clip(x, WEST + 0.05, WEST + 0.4)
    ring = [[float(a), float(b)] for a, b in zip(x, y)] + [[east, float(south)], [east, float(north)], [float(x[0]), float(y[0])]]
    sea = [ring[len(y) - 1], *ring[len(y):]]
    features = [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [ring]}},
                {"type": "Feature", "properties": {"boundary": "open"}, "geometry": {"type": "LineString", "coordinates": sea}}]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))


def own_memory(process):
    """What the system cannot write back into a file; 0 for a process that has ended."""
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return 1024 * sum(int(line.split()[1]) for line in status.splitlines() if line.startswith("RssAnon:"))


def run(command, record):
    """Measures, and looks every tenth of a second how much memory is not that of files, which the system can write back and give to others."""
    process = subprocess.Popen([*map(str, command), "--json", record, "--quiet"])
    own, ended = 0, 0
    while not ended:
        own = max(own, own_memory(process.pid))
        time.sleep(0.1)
        ended, status, usage = os.wait4(process.pid, os.WNOHANG)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{command[:3]} ... ended with {process.returncode}")
    made = json.loads(record.read_text())
    return {"seconds": made["work"]["seconds"], "stages": made["work"]["seconds_by_stage"],
            "processor": usage.ru_utime + usage.ru_stime, "peak": usage.ru_maxrss * 1024, "own": own, "points": made["mesh"]["vertices"]}


def measured(options):
    tiles = options.across * options.upward
    table = Table("tiles", f"{tiles} tiles of {options.side:,} by {options.side:,} values, five rules",
                  ["threads", "points", "seconds", "of these reading rasters", "processor seconds", "most memory", "of it not of files"],
                  f"`--size \"{RULES}\"`, lengths divided so that {options.points:,} points are made. Large grids of depths are "
                  "mapped from temporary files, of which the system keeps in memory what it has room for; the last column is without them.")
    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        folder = pathlib.Path(name)
        paths = write_tiles(folder, options.across, options.upward, options.side)
        write_coast(folder / "coast.geojson", options.across, options.upward)
        plain = [options.program, "mesh", folder / "coast.geojson", "--raster", "depth=" + ",".join(map(str, paths)), "--depth", "depth"]
        factor = 1.0
        if options.points > 0:
            first = run([*plain, "--size", f"{COARSE}*({RULES})", "--threads", options.threads], folder / "first.json")
            factor = COARSE * (first["points"] / options.points) ** 0.5
        for threads in sorted({1, options.threads}):
            made = run([*plain, "--size", f"{factor:.4g}*({RULES})", "--threads", threads, "-o", folder / "mesh.vtu"], folder / "run.json")
            table.add(threads, f"{made['points']:,}", f"{made['seconds']:.0f}", f"{made['stages']['rasters']:.1f}", f"{made['processor']:.0f}",
                      f"{made['peak'] / 1e6:,.0f} MB", f"{made['own'] / 1e6:,.0f} MB")
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=PROJECT / "build/release/driftmesh")
    parser.add_argument("--across", type=int, default=11, help="tiles from west to east")
    parser.add_argument("--upward", type=int, default=41, help="tiles from south to north")
    parser.add_argument("--side", type=int, default=400, help="values along a side of a tile")
    parser.add_argument("--points", type=int, default=10_000_000, help="of the mesh, about; 0: as the rules are")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--folder", help="for the files (default: that for temporary files)")
    results.add_option(parser)
    options = parser.parse_args()
    results.show("bench/tiles.py", map(measured, [options]), options)


if __name__ == "__main__":
    main()
