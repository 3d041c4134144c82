#!/usr/bin/env python3
"""Shapefiles and their like, and rasters as sizes and depths.

usage: gis_test.py DRIFTMESH GDAL(ON or OFF: whether it is built with GDAL) [unittest options]
"""

import http.server
import json
import math
import pathlib
import random
import re
import shutil
import subprocess
import sys
import threading
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
        self.refuse(*mesh, "--raster", "depth=depth.asc", "--size", "dept", says=["column 1", "did you mean depth?"])
        self.refuse(*mesh, "--raster", "x=depth.asc", "--size", "1", code=2, says=["--raster has the name 'x'"])
        self.refuse(*mesh, "--raster", "slope=depth.asc", "--size", "1", code=2, says=["slope"])
        self.refuse(*mesh, "--raster", "depth.asc", "--size", "1", code=2, says=["NAME=VALUE"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", code=2, says=["--size and --depth"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", "--depth", "other", code=2, says=["'other'"])
        self.refuse(*mesh, "--raster", "depth=depth.asc", "--size", "depth", "-o", "depth.asc", says=["depth.asc"])
        self.refuse(*mesh, "--layers", "a", says=["has no layers"])
        if not WITH_GDAL:
            self.write("coast.shp", "not looked at")
            self.write("depth.tif", "not looked at")
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
        self.masks()
        self.file("depth.tif", "not a TIFF")
        self.refuse("mesh", "square.poly", "--raster", "depth=depth.tif", *self.SIZE[2:], says=["depth.tif", "gdalinfo"])

    def masks(self):
        """A value that a mask or a band of transparency hides is none, as one that is said to be none."""
        hidden = lambda x, y: -9999.0 if abs(x - 3) < 0.5 and y > 1.5 else depth_at(x, y)
        self.file("none.asc", grid_text(81, 81, 0.05, value=hidden).replace("cellsize 0.05", "cellsize 0.05\nNODATA_value -9999"))
        self.tool("gdalwarp", "-q", "-dstalpha", "none.asc", "alpha.tif")
        mask = ["gdal_translate", "-q", "-b", "1", "-mask", "2", "alpha.tif"]
        self.tool(*mask, "beside.tif")
        self.assertTrue((self.folder / "beside.tif.msk").exists())
        self.tool(*mask, "inside.tif", "--config", "GDAL_TIFF_INTERNAL_MASK", "YES")
        self.assertFalse((self.folder / "inside.tif.msk").exists())
        self.tool("gdalbuildvrt", "-q", "joined.vrt", "inside.tif")
        expected = self.digest("square.poly", "--raster", "depth=none.asc", *self.SIZE[2:])
        self.assertNotEqual(expected, self.digest("square.poly", *self.SIZE))
        for other in ("alpha.tif", "beside.tif", "inside.tif", "joined.vrt"):
            self.assertEqual(self.digest("square.poly", "--raster", "depth=" + other, *self.SIZE[2:]), expected, other)

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


class Coordinates(Cli):
    @needs_gdal
    def test_files_in_any_system_of_the_epsg_come_back(self):
        shutil.copy(BAY, self.folder / "bay.geojson")
        self.succeed("mesh", "bay.geojson", "--area", "4M", "--open-boundary", "3", "--crs", "EPSG:5070", "-o", "m.14", "-o", "m.vtu",
                     "-o", "m.h5")
        self.assertTrue((self.folder / "m.14").read_text().startswith("driftmesh EPSG:5070 from UTM zone 18N from lonlat\n"))
        for file in ("m.14", "m.vtu", "m.h5"):
            self.assertIn("accepted", self.succeed("check", file, "bay.geojson", "--area", "4M"))
        self.refuse("mesh", "bay.geojson", "--crs", "EPSG:999999", "-o", "n.14", says=["EPSG:999999"])
        # PROJ's way back from areas and from azimuths is up to a millimeter off, and a domain may lie far from where a system is used.
        for code in (2163, 3035, 3571, 3575, 6933, 3413, 2154, 2284):
            self.succeed("convert", "m.vtu", "other.vtu", "--crs", f"EPSG:{code}")
            self.assertIn("accepted", self.succeed("check", "other.vtu", "bay.geojson", "--area", "4M"), code)
        # The code of the zone itself needs nobody.
        self.succeed("convert", "m.vtu", "zone.14", "--crs", "EPSG:32618")
        self.succeed("convert", "m.vtu", "plane.14", "--crs", "projected")
        nodes = [[line.split()[1:3] for line in (self.folder / name).read_text().splitlines()[2:100]] for name in ("zone.14", "plane.14")]
        self.assertEqual(nodes[0], nodes[1])


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
        self.refuse("mesh", "polygons.gpkg", "--layers", "water,water", says=["layer 'water' is named twice", "--layers"])
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
        self.tool("ogr2ogr", "-t_srs", "EPSG:2284", *where, "feet.shp", BAY)
        self.assertEqual({**self.features("utm.shp"), "file": ""}, {**degrees, "file": ""})
        self.assertEqual(self.features("feet.shp")["projection"], zone)
        self.tool("ogr2ogr", "-t_srs", "EPSG:3035", *where, "laea.shp", BAY)
        self.assertNotIn("UTM", self.features("laea.shp").get("projection") or "")

    def test_mercator(self):
        """Its meters are none: areas would be 58 % too large here. It becomes meters by way of degrees."""
        where = ["-where", "OGR_GEOMETRY='POLYGON'"]
        self.tool("ogr2ogr", "-f", "GeoJSON", *where, "water.geojson", BAY)
        degrees = self.features("water.geojson")
        area = self.area("of.vtu")
        for code in ("EPSG:3857", "EPSG:3395", "ESRI:102100", "EPSG:3832"):
            for made in ("mercator.shp", "mercator.gpkg"):
                self.tool("ogr2ogr", "-overwrite", "-t_srs", code, *where, made, BAY)
                self.assertEqual(self.features(made)["projection"], degrees["projection"], (code, made))
                self.assertAlmostEqual(self.area("of.vtu") / area, 1, delta=1e-6)
        for code in (3857, 3395, 900913, 102100):
            named = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:EPSG::{code}"}}
            (self.folder / "own.geojson").unlink(missing_ok=True)
            source = "EPSG:3395" if code == 3395 else "EPSG:3857"
            self.tool("ogr2ogr", "-f", "GeoJSON", "-lco", "COORDINATE_PRECISION=6", "-t_srs", source, *where, "own.geojson", BAY)
            self.file("own.geojson", json.dumps({**json.loads((self.folder / "own.geojson").read_text()), "crs": named}))
            self.assertEqual(self.features("own.geojson")["projection"], degrees["projection"], code)

    def test_geojson_names_a_system_that_gdal_knows(self):
        """Other projections of Mercator's kind, and feet, mean the same in GeoJSON and in other files."""
        where = ["-where", "OGR_GEOMETRY='POLYGON'"]
        for code in (3832, 3994, 5641, 2284, 3035):
            self.tool("ogr2ogr", "-overwrite", "-t_srs", f"EPSG:{code}", *where, "other.gpkg", BAY)
            (self.folder / "own.geojson").unlink(missing_ok=True)
            self.tool("ogr2ogr", "-f", "GeoJSON", "-lco", "COORDINATE_PRECISION=9", "-t_srs", f"EPSG:{code}", *where, "own.geojson", BAY)
            named = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:EPSG::{code}"}}
            self.file("own.geojson", json.dumps({**json.loads((self.folder / "own.geojson").read_text()), "crs": named}))
            expected = self.features("other.gpkg")
            area = self.area("of.vtu")
            self.assertEqual(self.features("own.geojson").get("projection"), expected.get("projection"), code)
            self.assertAlmostEqual(self.area("of.vtu") / area, 1, delta=1e-6, msg=str(code))
            self.assertAlmostEqual(self.area("of.vtu") / area, 1, delta=1e-6)

    def test_geojson_in_a_system_that_nobody_knows(self):
        """GDAL takes degrees for granted then. Coordinates are those of a plane, and the summary says so."""
        ring = [[0, 0], [4, 0], [4, 4], [0, 0]]
        for scale, looks in ((1, True), (1000, False)):
            polygon = {"type": "Polygon", "coordinates": [[[x * scale, y * scale] for x, y in ring]]}
            for crs in ({"type": "name", "properties": {"name": "EPSG:99999"}}, {"type": "name", "properties": {"name": "local"}},
                        {"type": "link", "properties": {"href": "http://127.0.0.1:9/crs", "type": "proj4"}}):
                self.file("in.geojson", json.dumps({**polygon, "crs": crs}))
                result = self.run_program("mesh", "in.geojson", "-o", "of.vtu")
                self.assertEqual(result.returncode, 0, result.stderr)
                said = result.stdout + result.stderr
                self.assertIn(f"system '{next(iter(crs['properties'].values()))}' are taken for those of a plane", said)
                self.assertIn("look like degrees" if looks else "not known", said)
                self.assertAlmostEqual(self.area("of.vtu"), 8 * scale * scale)
        degrees = {"type": "Polygon", "coordinates": [ring]}
        for name in ("WGS84", "+proj=longlat +datum=WGS84 +no_defs", "urn:ogc:def:crs:OGC:2:84", "NAD83", "EPSG:4979"):
            self.file("in.geojson", json.dumps({**degrees, "crs": {"type": "name", "properties": {"name": name}}}))
            self.assertIn("UTM", self.features("in.geojson").get("projection") or "", name)

    def area(self, mesh):
        return float(re.search(r"(?m)^area +([0-9.e+]+)$", self.succeed("check", mesh)).group(1))

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
        self.tool("ogr2ogr", "-a_srs", "EPSG:3035", "-f", "GPKG", "as_is.gpkg", "nad27.gpkg")
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


class Listener(http.server.BaseHTTPRequestHandler):
    """A server that remembers what it was asked for."""

    asked = []

    def do_GET(self):  # pylint: disable=invalid-name
        self.asked.append(self.path)
        self.send_response(404)
        self.end_headers()

    do_HEAD = do_POST = do_GET

    def log_message(self, *_):  # pylint: disable=arguments-differ
        pass


@needs_gdal
class Doors(Gis):
    """A file is what its extension says, and leads neither to other folders nor into a network."""

    VECTORS = ("shp", "gpkg", "fgb", "gml", "kml", "gmt")
    RASTERS = ("tif", "tiff", "nc", "grd", "dem", "hgt", "bil", "grb", "xyz", "bag", "vrt")

    def setUp(self):
        super().setUp()
        Listener.asked.clear()
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Listener)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        self.server = f"http://127.0.0.1:{server.server_port}"
        (self.folder / "elsewhere").mkdir()
        shutil.copy(BAY, self.folder / "elsewhere/secret.geojson")
        self.file("elsewhere/depth.asc", grid_text(81, 81, 0.05))
        self.tool("gdal_translate", "-q", "elsewhere/depth.asc", "elsewhere/depth.tif")
        (self.folder / "here").mkdir()
        self.square()

    def leads(self):
        """Texts that GDAL takes for descriptions of data elsewhere, whatever their files are called."""
        vector = ["../elsewhere/secret.geojson", str(self.folder / "elsewhere/secret.geojson"), f"/vsicurl/{self.server}/a.geojson",
                  f"{self.server}/a.geojson", f"/vsicurl_streaming/{self.server}/b.json", f"WFS:{self.server}/wfs"]
        raster = ["../elsewhere/depth.tif", str(self.folder / "elsewhere/depth.tif"), f"/vsicurl/{self.server}/a.tif"]
        for source in vector:
            yield (f'<OGRVRTDataSource><OGRVRTLayer name="secret"><SrcDataSource>{source}</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>')
        yield f'<OGRWFSDataSource><URL>{self.server}/wfs</URL></OGRWFSDataSource>'
        for source in raster:
            yield ('<VRTDataset rasterXSize="81" rasterYSize="81"><GeoTransform>0,0.05,0,4,0,-0.05</GeoTransform>'
                   f'<VRTRasterBand dataType="Float32" band="1"><SimpleSource><SourceFilename>{source}</SourceFilename>'
                   '<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>')
        yield (f'<GDAL_WMS><Service name="TMS"><ServerUrl>{self.server}/${{z}}/${{x}}/${{y}}.png</ServerUrl></Service><DataWindow>'
               '<UpperLeftX>0</UpperLeftX><UpperLeftY>4</UpperLeftY><LowerRightX>4</LowerRightX><LowerRightY>0</LowerRightY>'
               '<TileLevel>1</TileLevel></DataWindow><Projection>EPSG:3857</Projection><BandsCount>1</BandsCount></GDAL_WMS>')
        yield f'<WCS_GDAL><ServiceURL>{self.server}/wcs?</ServiceURL><CoverageName>a</CoverageName></WCS_GDAL>'
        yield f'{{"type": "FeatureCollection", "features": [], "links": [{{"rel": "next", "href": "{self.server}/next"}}]}}'

    def nothing_was_asked(self):
        self.assertEqual(Listener.asked, [])

    def test_a_file_is_what_its_extension_says(self):
        """Every description, by a random name of every kind."""
        seed = random.randrange(1 << 32)
        print(f"seed {seed}", flush=True)
        draw = random.Random(seed)
        for text in self.leads():
            for extension in draw.sample(self.VECTORS, 1):
                self.file(f"here/a.{extension}", text)
                self.refuse("mesh", f"here/a.{extension}", says=[f"here/a.{extension}"])
            for extension in draw.sample(self.RASTERS, 1):
                self.file(f"here/a.{extension}", text)
                self.refuse("mesh", "square.poly", "--raster", f"depth=here/a.{extension}", "--size", "0.3*depth",
                            says=[f"here/a.{extension}"])
        self.nothing_was_asked()

    def test_names_are_those_of_files(self):
        source = self.folder / "elsewhere/secret.geojson"
        for name in (f"/vsicurl/{self.server}/a.gpkg", f"{self.server}/a.shp", "/vsistdin/a.kml", f"/vsizip/{source}.zip/a.shp",
                     f"WFS:{self.server}/a.gml", "none.gpkg"):
            self.refuse("mesh", name, says=["No such file"])
        for name in (f"/vsicurl/{self.server}/a.tif", f"{self.server}/a.nc", f"NETCDF:{self.server}/a.nc", "none.tif"):
            self.refuse("mesh", "square.poly", "--raster", f"depth={name}", "--size", "depth", says=["No such file"])
        self.refuse("mesh", "square.poly", "--raster", "depth=square.poly", "--size", "depth", says=["'.poly'", ".tif", ".nc"])
        self.nothing_was_asked()

    def test_mosaics_join_tiffs_of_their_folder(self):
        size = ["--size", "0.3*depth", "--area", "0.1"]
        self.tool("gdal_translate", "-q", "-srcwin", "0", "0", "41", "81", "elsewhere/depth.tif", "here/west.tif")
        self.tool("gdal_translate", "-q", "-srcwin", "41", "0", "40", "81", "elsewhere/depth.tif", "here/east.tif")
        self.tool("gdalbuildvrt", "-q", "here/all.vrt", "here/west.tif", "here/east.tif")
        self.assertEqual(self.digest("square.poly", "--raster", "depth=here/all.vrt", *size),
                         self.digest("square.poly", "--raster", "depth=elsewhere/depth.tif", *size))
        whole = (self.folder / "here/all.vrt").read_text()
        (self.folder / "here/link.tif").symlink_to("../elsewhere/depth.tif")
        self.file("here/text.tif", whole)
        for source in ("../elsewhere/depth.tif", str(self.folder / "elsewhere/depth.tif"), f"/vsicurl/{self.server}/a.tif", "link.tif", "text.tif",
                       f"{self.server}/a.tif", "all.vrt", "none.tif", "west.nc", "GTIFF_DIR:1:west.tif"):
            self.file("here/bad.vrt", whole.replace("west.tif", source))
            self.refuse("mesh", "square.poly", "--raster", "depth=here/bad.vrt", *size, says=["here/", source])
        for old, new in (('band="1"', 'band="1" subClass="VRTDerivedRasterBand"'), ("</VRTRasterBand>", "<PixelFunctionType>sum</PixelFunctionType></VRTRasterBand>"),
                         ("</VRTRasterBand>", "<Overview><SourceFilename>west.tif</SourceFilename></Overview></VRTRasterBand>"),
                         ("<GeoTransform>", f"<SRS>{self.server}/srs</SRS><GeoTransform>"), ("<GeoTransform>", "<SRS>../elsewhere/a.prj</SRS><GeoTransform>"),
                         ("<GeoTransform>", "<GDALWarpOptions/><GeoTransform>"), ("<GeoTransform>", "<Metadata domain='GEOLOCATION'/><GeoTransform>")):
            self.assertIn(old, whole)
            self.file("here/bad.vrt", whole.replace(old, new))
            self.refuse("mesh", "square.poly", "--raster", "depth=here/bad.vrt", *size, says=["here/bad.vrt", "own folder"])
        self.nothing_was_asked()

    def test_schemas_are_not_fetched(self):
        self.file("here/a.gml", f"""<?xml version="1.0"?>
<wfs:FeatureCollection xmlns:wfs="http://www.opengis.net/wfs" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xsi:schemaLocation="http://ogr.maptools.org/ {self.server}/w?SERVICE=WFS&amp;VERSION=1.0.0&amp;REQUEST=DescribeFeatureType&amp;TYPENAME=ogr:a"
 xmlns:ogr="http://ogr.maptools.org/" xmlns:gml="http://www.opengis.net/gml"><gml:featureMember><ogr:a><ogr:geometryProperty>
<gml:Polygon><gml:outerBoundaryIs><gml:LinearRing><gml:coordinates>0,0 4,0 4,4 0,0</gml:coordinates></gml:LinearRing></gml:outerBoundaryIs>
</gml:Polygon></ogr:geometryProperty></ogr:a></gml:featureMember></wfs:FeatureCollection>""")
        self.succeed("mesh", "here/a.gml", "-o", "a.vtu")
        self.nothing_was_asked()
        self.assertEqual(sorted(path.name for path in (self.folder / "here").iterdir()), ["a.gml"])

    def test_mercator_needs_a_domain_with_a_place(self):
        self.tool("gdal_translate", "-q", "-a_srs", "EPSG:3857", "elsewhere/depth.asc", "m.tif")
        self.refuse("mesh", "square.poly", "--raster", "depth=m.tif", "--size", "0.3*depth", says=["m.tif", "Mercator", "gdalwarp"])


if __name__ == "__main__":
    main()
