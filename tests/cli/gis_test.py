#!/usr/bin/env python3
"""Shapefiles and their like, and rasters as sizes and depths.

usage: gis_test.py DRIFTMESH GDAL(ON or OFF: whether it is built with GDAL) [unittest options]
"""

import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from program import SQUARE, Cli, main

WITH_GDAL = sys.argv.pop(2) == "ON"
BAY = pathlib.Path(__file__).parents[2] / "examples/coast/bay.geojson"
needs_gdal = unittest.skipUnless(WITH_GDAL and shutil.which("ogr2ogr") and shutil.which("gdal_translate"),
                                 "needs GDAL and its programs")


def depth_at(x, y):
    """Of a basin of 4 by 4 with a trench."""
    return 0.5 + 0.1 * x + (2.0 if abs(x - 2.05) < 0.06 else 0.0) + 0.03 * y * y


def grid_text(columns, rows, step, first=(0.0, 0.0), value=depth_at):
    lines = [f"ncols {columns}", f"nrows {rows}", f"xllcenter {first[0]}", f"yllcenter {first[1]}", f"cellsize {step}"]
    for row in reversed(range(rows)):
        lines.append(" ".join(repr(value(first[0] + column * step, first[1] + row * step)) for column in range(columns)))
    return "\n".join(lines) + "\n"


def bilinear(columns, rows, step, x, y):
    u, v = min(max(x / step, 0), columns - 1), min(max(y / step, 0), rows - 1)
    i, j = min(int(u), columns - 2), min(int(v), rows - 2)
    value = lambda a, b: depth_at(a * step, b * step)
    low = value(i, j) + (value(i + 1, j) - value(i, j)) * (u - i)
    high = value(i, j + 1) + (value(i + 1, j + 1) - value(i, j + 1)) * (u - i)
    return low + (high - low) * (v - j)


class Gis(Cli):
    def file(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def square(self):
        return self.file("square.poly", SQUARE)

    def digest(self, *arguments, ranks=0):
        record = f"record{len(list(self.folder.iterdir()))}.json"
        if ranks:
            self.together(ranks, "mesh", *arguments, "--json", record)
        else:
            self.succeed("mesh", *arguments, "--json", record)
        return json.loads((self.folder / record).read_text())["mesh"]["digest"]

    def together(self, ranks, *arguments):
        result = self.on_ranks(ranks, *arguments)
        self.assertEqual(result.returncode, 0, f"{arguments}\n{result.stdout}{result.stderr}")

    def tool(self, *arguments):
        result = subprocess.run([*map(str, arguments)], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, f"{arguments}\n{result.stdout}{result.stderr}")


class Rasters(Gis):
    SIZE = ["--raster", "depth=depth.asc", "--size", "max(0.02, 0.05*sqrt(9.81*depth)/(1 + slope(depth)))"]

    def basin(self):
        self.file("depth.asc", grid_text(81, 81, 0.05))
        return self.square()

    def test_sizes(self):
        """check accepts what was made, by the same option, and rejects it where less is asked for."""
        self.basin()
        self.succeed("mesh", "square.poly", *self.SIZE, "-o", "m.vtu")
        self.succeed("check", "m.vtu", "square.poly", *self.SIZE)
        self.succeed("check", "m.vtu", *self.SIZE)
        finer = ["--raster", "depth=depth.asc", "--size", "0.8*(" + self.SIZE[3] + ")"]
        self.assertEqual(self.run_program("check", "m.vtu", "square.poly", *finer).returncode, 1)

    def test_the_same_everywhere(self):
        self.basin()
        parts = ["square.poly", *self.SIZE, "-n", "12"]
        first = self.digest(*parts, "--threads", "1")
        self.assertEqual(self.digest(*parts, "--threads", "3"), first)
        self.succeed("mesh", *parts, "-o", "m.vtu")
        for ranks in (1, 2, 3):
            self.together(ranks, "mesh", *parts, "--balance", "stealing", "-o", f"r{ranks}.pvtu", "--depth", "depth")
            self.succeed("check", f"r{ranks}.pvtu", "square.poly", *self.SIZE)

    def test_gradation_and_regions(self):
        """The least of a raster, a region's area and an upper limit counts, and lengths grow slowly."""
        self.basin()
        self.file("two.poly", "6 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 3 0\n6 3 4\n7 1\n1 1 5 1\n2 5 2 1\n3 2 3 1\n4 3 6 1\n5 6 4 1\n"
                              "6 4 1 1\n7 5 6 2\n0\n2\n1 1 1 1 -1\n2 3.5 1 2 0.001\n")
        bounds = ["--raster", "depth=depth.asc", "--size", "min(0.3*depth, 0.05 + 0.5*distance(2))", "--gradation", "0.3", "--size-max", "0.3"]
        self.succeed("mesh", "two.poly", *bounds, "-o", "m.vtu")
        self.succeed("check", "m.vtu", "two.poly", *bounds)
        self.succeed("mesh", "two.poly", "--raster", "depth=depth.asc", "--size", "0.3*depth", "-n", "6", "-o", "n.vtu")
        self.succeed("check", "n.vtu", "two.poly", "--raster", "depth=depth.asc", "--size", "0.3*depth")

    def test_settings(self):
        """In a file, names of rasters are relative to the file; the record repeats the run."""
        self.basin()
        (self.folder / "sub").mkdir()
        shutil.move(self.folder / "depth.asc", self.folder / "sub/depth.asc")
        self.file("sub/run.yaml", "input: {file: ../square.poly, rasters: {depth: depth.asc}}\nsizing: {size: 0.3*depth}\n")
        yaml = self.digest("--config", "sub/run.yaml")
        line = self.digest("square.poly", "--raster", "depth=sub/depth.asc", "--size", "0.3*depth")
        self.assertEqual(yaml, line)

    def test_depths(self):
        """Each point of a grid has the value of the raster there, however the mesh was made."""
        self.basin()
        common = ["square.poly", "--raster", "depth=depth.asc", "--depth", "depth", "--area", "0.02"]
        self.succeed("mesh", *common, "-o", "one.14")
        self.succeed("mesh", *common, "-n", "7", "-o", "parts.14")
        self.together(2, "mesh", *common, "-n", "7", "-o", "ranks.14")
        self.succeed("mesh", *common, "-n", "7", "-o", "pieces.pvtu")
        self.succeed("check", "pieces.pvtu", "square.poly", "--area", "0.02")
        for grid in ("one.14", "parts.14", "ranks.14"):
            lines = (self.folder / grid).read_text().splitlines()
            points = int(lines[1].split()[1])
            self.assertGreater(points, 300)
            for line in lines[2:2 + points]:
                _, x, y, depth = map(float, line.split())
                self.assertAlmostEqual(depth, bilinear(81, 81, 0.05, x, y), delta=1e-6)

    def test_warnings(self):
        self.square()
        self.file("depth.asc", grid_text(41, 81, 0.05))
        result = self.run_program("mesh", "square.poly", "--raster", "depth=depth.asc", "--size", "0.3*depth")
        self.assertIn("2 lie outside of depth.asc", result.stdout + result.stderr)
        self.refuse("mesh", "square.poly", "--raster", "depth=depth.asc", "--size", "0.3*depth", "--strict", says=["outside of depth.asc"])

    def test_errors(self):
        self.basin()
        mesh = ["mesh", "square.poly"]
        text = (self.folder / "depth.asc").read_text()
        self.file("bad.asc", text.replace("\n", "\nx ", 8).replace("x ", "", 7))
        self.refuse(*mesh, "--raster", "depth=bad.asc", "--size", "depth", says=["bad.asc:9:", "'x'"])
        self.file("cut.asc", text[:len(text) // 2])
        self.refuse(*mesh, "--raster", "depth=cut.asc", "--size", "depth", says=["cut.asc:"])
        self.refuse(*mesh, "--raster", "depth=none.asc", "--size", "depth", says=["none.asc"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", "--size", "slope(dept)", says=["'dept'", "--raster dept=FILE"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", "--size", "slope(depth, 2)", says=["column 12", "slope(depth)"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", "--size", "dept", says=["column"])
        self.refuse(*mesh, "--raster", "x=depth.asc", "--size", "1", code=2, says=["--raster has the name 'x'"])
        self.refuse(*mesh, "--raster", "slope_a=depth.asc", "--size", "1", code=2, says=["slope_a"])
        self.refuse(*mesh, "--raster", "depth.asc", "--size", "1", code=2, says=["NAME=VALUE"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", code=2, says=["--size and --depth"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", "--depth", "other", code=2, says=["'other'"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", "--size", "depth", "-o", "depth.asc", says=["depth.asc"])
        self.refuse(*mesh, "--layers", "a", says=["has no layers"])
        if not WITH_GDAL:
            self.refuse("mesh", "coast.shp", says=["coast.shp", "libgdal-dev"])
            self.refuse(*mesh, "--raster", "depth=depth.tif", "--size", "depth", says=["depth.tif", "libgdal-dev"])

    @needs_gdal
    def test_formats(self):
        """Of the same values, all formats make the same mesh."""
        self.basin()
        self.tool("gdal_translate", "-q", "-ot", "Float64", "-co", "TILED=YES", "-co", "BLOCKXSIZE=16", "-co", "BLOCKYSIZE=16", "depth.asc", "depth.tif")
        self.tool("gdal_translate", "-q", "-of", "netCDF", "depth.tif", "depth.nc")
        text = self.digest("square.poly", *self.SIZE)
        for other in ("depth.tif", "depth.nc"):
            self.assertEqual(self.digest("square.poly", "--raster", "depth=" + other, *self.SIZE[2:]), text)
        self.file("depth.tif", "not a TIFF")
        self.refuse("mesh", "square.poly", "--raster", "depth=depth.tif", *self.SIZE[2:], says=["depth.tif", "gdalinfo"])

    def test_degrees(self):
        """A grid in degrees serves a domain in degrees, which is in meters when it is meshed."""
        outline = json.loads(BAY.read_text())
        corners = [p for f in outline["features"] for p in re.findall(r"\[(-?[0-9.]+), (-?[0-9.]+)\]", json.dumps(f["geometry"]))]
        west, south = min(float(x) for x, _ in corners), min(float(y) for _, y in corners)
        east, north = max(float(x) for x, _ in corners), max(float(y) for _, y in corners)
        step = (east - west) / 120
        rows = 3 + int((north - south) / step)
        value = lambda x, y: 5 + 40 * (x - west) / (east - west)
        self.file("depth.asc", grid_text(123, rows, step, (west - step, south - step), value))
        size = ["--raster", "depth=depth.asc", "--size", "100*depth"]
        self.succeed("mesh", BAY, *size, "--depth", "depth", "-o", "m.vtu", "-o", "m.14")
        self.succeed("check", "m.vtu", BAY, *size)
        lines = (self.folder / "m.14").read_text().splitlines()
        depths = [float(line.split()[3]) for line in lines[2:2 + int(lines[1].split()[1])]]
        self.assertAlmostEqual(min(depths), 5, delta=0.05)
        self.assertAlmostEqual(max(depths), 45, delta=0.05)
        if not (WITH_GDAL and shutil.which("gdal_translate")):
            return
        # In degrees that name their system, and in another projection.
        self.tool("gdal_translate", "-q", "-a_srs", "EPSG:4326", "-ot", "Float64", "depth.asc", "degrees.tif")
        self.tool("gdalwarp", "-q", "-r", "bilinear", "-t_srs", "EPSG:3035", "degrees.tif", "meters.tif")
        for raster in ("degrees.tif", "meters.tif"):
            self.succeed("mesh", BAY, "--raster", "depth=" + raster, "--size", "100*depth", "--depth", "depth", "-o", "o.14")
            own = (self.folder / "o.14").read_text().splitlines()
            depths = [float(line.split()[3]) for line in own[2:2 + int(own[1].split()[1])]]
            self.assertAlmostEqual(min(depths), 5, delta=0.5)
            self.assertAlmostEqual(max(depths), 45, delta=0.5)


@needs_gdal
class Vectors(Gis):
    def features(self, *arguments):
        """What a run says of its input."""
        self.succeed("mesh", *arguments, "--area", "5M", "--json", "of.json", "-o", "of.vtu")
        return json.loads((self.folder / "of.json").read_text())["input"]

    def test_the_same_as_geojson(self):
        """A GeoPackage keeps all of GeoJSON; a shapefile turns rings around, and has only one kind of geometry."""
        self.tool("ogr2ogr", "polygons.gpkg", BAY, "-nlt", "POLYGON", "-where", "OGR_GEOMETRY='POLYGON'", "-nln", "water")
        self.tool("ogr2ogr", "-update", "polygons.gpkg", BAY, "-nlt", "LINESTRING", "-where", "OGR_GEOMETRY='LINESTRING'", "-nln", "open")
        original = self.digest(BAY, "--area", "5M")
        self.assertEqual(self.digest("polygons.gpkg", "--layers", "water,open", "--area", "5M"), original)
        self.refuse("mesh", "polygons.gpkg", says=["2 layers: water, open", "--layers"])
        self.refuse("mesh", "polygons.gpkg", "--layers", "watr", says=["'watr'", "water, open"])
        self.tool("ogr2ogr", "-where", "OGR_GEOMETRY='POLYGON'", "water.shp", BAY)
        self.tool("ogr2ogr", "-f", "GeoJSON", "water.geojson", "water.shp")
        expected = self.features("water.geojson")
        self.assertEqual({**self.features("water.shp"), "file": ""}, {**expected, "file": ""})
        self.succeed("check", "of.vtu", "water.shp", "--area", "5M")
        self.succeed("plot", "water.shp", "-o", "water.png")

    def test_projected(self):
        """Meters remain meters, other units do not, and a UTM zone is known for rasters in degrees."""
        where = ["-where", "OGR_GEOMETRY='POLYGON'"]
        self.tool("ogr2ogr", "-f", "GeoJSON", *where, "water.geojson", BAY)
        degrees = self.features("water.geojson")
        zone = degrees["projection"]
        code = (32600 if zone.endswith("N") else 32700) + int(re.search(r"\d+", zone).group())
        self.tool("ogr2ogr", "-t_srs", f"EPSG:{code}", *where, "utm.shp", BAY)
        self.tool("ogr2ogr", "-t_srs", "EPSG:3857", *where, "mercator.shp", BAY)
        self.tool("ogr2ogr", "-t_srs", "EPSG:2284", *where, "feet.shp", BAY)
        self.assertEqual({**self.features("utm.shp"), "file": ""}, {**degrees, "file": ""})
        self.assertEqual(self.features("feet.shp")["projection"], zone)
        self.assertNotIn("UTM", self.features("mercator.shp").get("projection") or "")

    def test_other_datum(self):
        """A UTM zone on another datum has other coordinates for the same places, by a hundred meters and more."""
        self.tool("ogr2ogr", "-f", "GeoJSON", "-where", "OGR_GEOMETRY='POLYGON'", "water.geojson", BAY)
        zone = self.features("water.geojson")["projection"]
        here = self.corner("of.vtu")
        code = 26700 + int(re.search(r"\d+", zone).group())  # NAD 27
        for made in ("nad27.shp", "nad27.gpkg"):
            self.tool("ogr2ogr", "-t_srs", f"EPSG:{code}", "-nlt", "PROMOTE_TO_MULTI", made, "water.geojson")
            self.assertEqual(self.features(made)["projection"], zone)
            self.assertLess(math.dist(self.corner("of.vtu"), here), 0.01, made)
        self.tool("ogr2ogr", "-a_srs", "EPSG:3857", "-f", "GPKG", "as_is.gpkg", "nad27.gpkg")
        self.features("as_is.gpkg")
        self.assertGreater(math.dist(self.corner("of.vtu"), here), 50, "the two datums must differ for this test to mean anything")

    def corner(self, mesh):
        """The least coordinates of a mesh."""
        self.succeed("convert", mesh, "corner.node")
        points = [tuple(map(float, line.split()[1:3])) for line in (self.folder / "corner.node").read_text().splitlines()[1:]
                  if not line.startswith("#")]
        return tuple(map(min, zip(*points)))

    def test_attributes(self):
        """Fields of any case are tags; empty ones are none."""
        square = lambda x: [[[x, 0], [x + 1, 0], [x + 1, 1], [x, 1], [x, 0]]]
        feature = lambda x, **fields: {"type": "Feature", "properties": fields, "geometry": {"type": "Polygon", "coordinates": square(x)}}
        self.file("tags.geojson", json.dumps({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:32618"}},
                                              "features": [feature(0, REGION=3.0, MAX_AREA=0.01, BOUNDARY=""), feature(1, REGION=4.0, MARKER=7, BOUNDARY="open")]}))
        self.tool("ogr2ogr", "tags.shp", "tags.geojson")
        self.succeed("mesh", "tags.shp", "--area", "0.1", "-o", "m.ele", "--json", "m.json")
        regions = [line.split()[4] for line in (self.folder / "m.ele").read_text().splitlines()[1:] if not line.startswith("#")]
        self.assertGreater(regions.count("3"), 100)
        self.assertLess(regions.count("4"), 60)
        markers = {line.split()[3] for line in (self.folder / "m.poly").read_text().splitlines() if len(line.split()) == 4 and not line.startswith("#")}
        self.assertTrue({"1", "7"} <= markers, markers)
        self.tool("ogr2ogr", "-sql", "SELECT *, 'sea' AS boundary2 FROM tags", "bad.shp", "tags.shp")
        self.file("wrong.geojson", json.dumps({"type": "FeatureCollection", "features": [feature(0), feature(1, BOUNDARY="sea")]}))
        self.tool("ogr2ogr", "wrong.shp", "wrong.geojson")
        self.refuse("mesh", "wrong.shp", says=["wrong.shp", "feature 2", "boundary"])

    def test_damaged(self):
        self.tool("ogr2ogr", "-where", "OGR_GEOMETRY='POLYGON'", "water.shp", BAY)
        whole = (self.folder / "water.shp").read_bytes()
        (self.folder / "water.shp").write_bytes(whole[:len(whole) // 2])
        self.refuse("mesh", "water.shp", says=["water.shp"])
        self.file("text.gpkg", "no database")
        self.refuse("mesh", "text.gpkg", says=["text.gpkg"])
        self.refuse("mesh", "none.shp", says=["none.shp", "No such file"])


if __name__ == "__main__":
    main()
