#!/usr/bin/env python3
"""The files of a run: nothing that is read is written over, and outputs appear together or not at all.

usage: files_test.py DRIFTMESH [unittest options]
"""

import json
import os
import random
import shutil
import socket
import subprocess
import time

import program
from program import MESHER_SECONDS, RANKS_ENVIRONMENT, SQUARE, Cli, main

# A background mesh of the square: two triangles, with a length at each point.
BACKGROUND_NODES = "4 2 1 0\n1 0 0 1\n2 4 0 1\n3 4 4 1\n4 0 4 1\n"
BACKGROUND_TRIANGLES = "2 3 0\n1 1 2 3\n2 1 3 4\n"


class Files(Cli):
    def setUp(self):
        super().setUp()
        self.write("square.poly", SQUARE)

    def contents(self):
        return {str(path.relative_to(self.folder)): path.read_bytes()
                for path in sorted(self.folder.rglob("*")) if path.is_file()}

    def refuse_and_touch_nothing(self, *arguments, says):
        before = self.contents()
        self.refuse(*arguments, says=says)
        self.assertEqual(self.contents(), before)


class NothingReadIsOverwritten(Files):
    def background(self, stem="bg", area=False):
        self.write(f"{stem}.node", BACKGROUND_NODES)
        self.write(f"{stem}.ele", BACKGROUND_TRIANGLES)
        if area:
            self.write(f"{stem}.area", "2\n1 0.5\n2 0.5\n")

    def test_the_background_mesh(self):
        self.background(area=True)
        for given in ("bg.node", "bg", "bg.ele", "bg.area"):
            self.refuse_and_touch_nothing("mesh", "square.poly", "--size-mesh", given, "-o", "bg.ele",
                                          says=["bg.node", "--output", "--size-mesh"])
        self.refuse_and_touch_nothing("mesh", "square.poly", "--size-mesh", "bg.area", "--json", "bg.area",
                                      says=["bg.area", "--json", "--size-mesh"])
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "--size-mesh", "bg.node", "-o", "bg.ele",
                                      says=["bg.ele", "--output", "--size-mesh"])

    def test_the_settings(self):
        self.write("run.yaml", "input: square.poly\narea: 0.5\n")
        self.refuse_and_touch_nothing("mesh", "--config", "run.yaml", "--json", "run.yaml",
                                      says=["run.yaml", "--json", "--config"])
        self.write("own.yaml", "input: square.poly\noutput: [own.vtu]\njson: ./own.yaml\n")
        self.refuse_and_touch_nothing("mesh", "--config", "own.yaml", says=["own.yaml", "--json", "--config"])

    def test_the_decomposition(self):
        self.succeed("decompose", "square.poly", "-n", "2", "-o", "d.txt")
        self.refuse_and_touch_nothing("mesh", "square.poly", "--decomposition", "d.txt", "--json", "d.txt",
                                      says=["d.txt", "--json", "--decomposition"])
        result = self.on_ranks(2, "mesh", "square.poly", "--decomposition", "d.txt", "--json", "./d.txt")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("--decomposition", result.stderr)
        self.assertTrue((self.folder / "d.txt").read_text().startswith("# driftmesh decomposition"))

    def test_the_input_by_other_names(self):
        os.link(self.folder / "square.poly", self.folder / "hard.vtu")
        (self.folder / "soft.vtu").symlink_to("square.poly")
        (self.folder / "sub").mkdir()
        (self.folder / "there").symlink_to("sub")
        for name in ("square.poly", "./square.poly", "sub/../square.poly", "there/../square.poly", "hard.vtu",
                     "soft.vtu", self.folder / "square.poly"):
            self.refuse_and_touch_nothing("mesh", "square.poly", "--json", name, says=["--json", "INPUT"])
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "--plot", "square.poly", says=["not a picture"])
        (self.folder / "picture.png").symlink_to("square.poly")
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "--plot", "picture.png",
                                      says=["picture.png", "--plot", "INPUT"])
        self.refuse_and_touch_nothing("plot", "square.poly", "-o", "picture.png", says=["--output", "INPUT"])

    def test_vertices_beside_the_input(self):
        lines = SQUARE.splitlines(keepends=True)
        self.write("split.poly", "0 2 0 0\n" + "".join(lines[5:]))
        self.write("split.node", "".join(lines[:5]))
        self.refuse_and_touch_nothing("mesh", "split.poly", "--json", "split.node", says=["split.node", "--json", "INPUT"])

    def test_pieces(self):
        self.succeed("mesh", "square.poly", "-n", "4", "-o", "m.pvtu", "--area", "0.1")
        self.refuse_and_touch_nothing("convert", "m.pvtu", "m_0.vtu", says=["m_0.vtu", "OUTPUT", "INPUT"])
        (self.folder / "m.png").symlink_to("m_0.vtu")
        self.refuse_and_touch_nothing("plot", "m.pvtu", says=["m.png", "--output", "INPUT"])

    def test_two_outputs_in_one_file(self):
        (self.folder / "to").symlink_to(".")
        (self.folder / "alias.svg").symlink_to("later.vtu")
        for outputs, uses in ((["-o", "a.vtu", "--json", "a.vtu"], ["--output", "--json"]),
                              (["-o", "a.vtu", "-o", "to/a.vtu"], ["--output", "twice"]),
                              (["-o", "later.vtu", "--plot", "alias.svg"], ["--output", "--plot"]),
                              (["-o", "a.msh", "-o", "a.node", "--json", "a.neigh"], ["--output", "--json"]),
                              (["-o", "-", "--json", "-"], ["--output", "--json"])):
            self.refuse_and_touch_nothing("mesh", "square.poly", *outputs, says=uses)
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "-o", "a.svg", "--plot", "./a.svg",
                                      says=["--output", "--plot"])

    def test_the_files_of_an_experiment(self):
        self.background("run-1")
        experiment = "input: {file: square.poly}\nbounds: {triangles: 2e3}\ncluster: {ranks: 2}\nlb-statistics: 1\n"
        self.write("experiment.yaml", experiment)
        self.refuse_and_touch_nothing("run", "experiment.yaml", "-o", ".", says=["experiment.yaml", "results"])
        self.write("e.yaml", experiment)
        os.rename(self.folder / "square.poly", self.folder / "table.csv")
        self.write("square.node", BACKGROUND_NODES)
        for name in ("table.csv", "run-1.json", "report.html", "run-1.decisions.jsonl", "run-1.trace.json",
                     "run-1.lb-stats/data.1.json"):
            (self.folder / "run-1.lb-stats").mkdir(exist_ok=True)
            self.write(name, SQUARE)
            self.refuse_and_touch_nothing("run", "e.yaml", "-o", ".", "--set", f"input.file={name}",
                                          says=[name, "results", "input.file"])

    def test_a_device_has_any_number_of_uses(self):
        self.succeed("mesh", "square.poly", "--json", "/dev/null", "--area", "0.5", "-o", "a.vtu")
        (self.folder / "b.vtu").symlink_to("/dev/null")
        self.succeed("mesh", "square.poly", "--json", "/dev/null", "-o", "b.vtu")
        self.succeed("mesh", "square.poly", "-o", "/dev/null", "--plot", "/dev/null", "--json", "/dev/null")
        self.succeed("mesh", "square.poly", "-n", "3", "-o", "/dev/null")
        self.succeed("generate", "pipe", "-o", "/dev/null")


class TogetherOrNotAtAll(Files):
    """Old files are there before; whatever goes wrong later, they stay as they are and no new one joins them."""

    OUTPUTS = ["-o", "a.vtu", "-o", "a.ele", "--plot", "a.svg", "--json", "a.json"]
    WRITTEN = ["a.edge", "a.ele", "a.json", "a.neigh", "a.node", "a.poly", "a.svg", "a.vtu"]

    def setUp(self):
        super().setUp()
        for full in ("full.vtu", "full.png", "full.json"):
            (self.folder / full).symlink_to("/dev/full")

    def old_outputs(self):
        for name in self.WRITTEN:
            self.write(name, "old")

    def test_a_full_disk(self):
        self.old_outputs()
        for full in (["-o", "full.vtu"], ["--plot", "full.png"], ["--json", "full.json"]):
            for parts in ([], ["-n", "4", "-o", "pieces.pvtu"]):
                self.refuse_and_touch_nothing("mesh", "square.poly", "--area", "0.1", *parts, "-o", "a.vtu", "-o", "a.ele",
                                              *full, says=["full", "No space left"])
        self.refuse_and_touch_nothing("decompose", "square.poly", "-n", "2", "-o", "a.vtu", "--plot", "full.png",
                                      says=["full.png", "No space left"])

    def test_a_full_disk_on_ranks(self):
        before = self.contents()
        for full in (["-o", "full.vtu"], ["--plot", "full.png"], ["--json", "full.json"]):
            result = self.on_ranks(2, "mesh", "square.poly", "--area", "0.1", "-n", "4", "-o", "ok.pvtu", *full)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("No space left", result.stderr)
            self.assertEqual(self.contents(), before)

    def blocked(self, *arguments, before=(), staged=()):
        """A run that waits at out.neigh, the last file to be opened, until that is read; `staged` have been begun, too."""
        os.mkfifo(self.folder / "out.neigh")
        run = subprocess.Popen([*before, program.PATH, "mesh", "square.poly", *arguments, "-o", "out.ele"],
                               cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                               env=RANKS_ENVIRONMENT)
        self.addCleanup(run.stderr.close)
        self.addCleanup(lambda: run.poll() is None and run.kill())
        deadline = time.monotonic() + MESHER_SECONDS
        # At its start the run tries each output alone, so that only files side by side show that it has got there.
        begun = {"out.node", "out.edge", *staged}
        while not begun <= {name.split(".tmp-")[0] for name in self.files() if ".tmp-" in name}:
            self.assertLess(time.monotonic(), deadline)
            self.assertIsNone(run.poll())
            time.sleep(0.01)
        return run

    def test_a_rank_that_cannot_rename(self):
        self.write("m_0.vtu", "old")
        run = self.blocked("--area", "0.1", "-n", "4", "-o", "m.pvtu", "--json", "m.json", before=["mpiexec", "-n", "2"],
                           staged=["m_1.vtu"])
        before = self.files()
        (self.folder / "m_1.vtu").mkdir()
        reader = os.open(self.folder / "out.neigh", os.O_RDONLY | os.O_NONBLOCK)  # what is written fits into the pipe
        self.addCleanup(os.close, reader)
        self.assertNotEqual(run.wait(MESHER_SECONDS), 0)
        self.assertIn("rank 1: m_1.vtu", run.stderr.read())
        self.assertEqual((self.folder / "m_0.vtu").read_text(), "old")
        self.assertEqual(self.files(), sorted([name for name in before if ".tmp-" not in name] + ["m_1.vtu"]))

    def test_interrupted_runs(self):
        self.old_outputs()
        call = [program.PATH, "mesh", "square.poly", "--area", "0.001", *self.OUTPUTS]
        begin = time.monotonic()
        subprocess.run(call, cwd=self.folder, stdout=subprocess.DEVNULL, check=True, timeout=MESHER_SECONDS)
        seconds = time.monotonic() - begin
        ends = {"old": 0, "new": 0}
        for i in range(200):  # later and later, until some are complete
            if i >= 25 and min(ends.values()) > 0:
                break
            self.old_outputs()
            run = subprocess.Popen(call, cwd=self.folder, stdout=subprocess.DEVNULL)
            time.sleep(seconds * i / 20)
            run.terminate()
            run.wait(MESHER_SECONDS)
            states = {"old" if (self.folder / name).read_bytes() == b"old" else "new" for name in self.WRITTEN}
            self.assertEqual(len(states), 1, f"after {i}/20 of the time, some files are new and others old")
            self.assertFalse([name for name in self.files() if ".tmp-" in name])
            ends[states.pop()] += 1
        self.assertGreater(min(ends.values()), 0, f"{ends}: not all of the run was interrupted")

    def test_what_a_killed_run_leaves_is_removed_by_the_next(self):
        run = self.blocked("-o", "m.vtu", staged=["m.vtu"])
        run.kill()
        run.wait()
        os.unlink(self.folder / "out.neigh")
        left = [name for name in self.files() if ".tmp-" in name]
        self.assertIn("m.vtu", {name.split(".tmp-")[0] for name in left})
        other_host, alive = left[0].replace(".tmp-", ".tmp-other"), left[0].replace(f"-{run.pid}-", f"-{os.getpid()}-")
        self.write(other_host, "of another host")
        self.write(alive, "of a process that is alive")
        self.write("m.vtu.tmp-mine", "of somebody else")
        self.succeed("mesh", "square.poly", "-o", "another.vtu")
        self.assertEqual([name for name in self.files() if ".tmp-" in name], sorted([other_host, alive, "m.vtu.tmp-mine"]))

    def test_a_rewritten_file_keeps_its_mode(self):
        os.umask(0o022)
        for mode in (0o600, 0o664, 0o755):
            self.write("a.vtu", "old")
            os.chmod(self.folder / "a.vtu", mode)
            self.succeed("mesh", "square.poly", "-o", "a.vtu", "-o", "new.vtu")
            self.assertEqual(os.stat(self.folder / "a.vtu").st_mode & 0o777, mode)
            self.assertEqual(os.stat(self.folder / "new.vtu").st_mode & 0o777, 0o644)
            os.unlink(self.folder / "new.vtu")

    def test_long_names(self):
        name = "n" * 251 + ".vtu"
        self.succeed("mesh", "square.poly", "-o", name)
        self.assertIn(name, self.files())
        self.refuse_and_touch_nothing("mesh", "square.poly", "-o", "n" + name, says=["too long"])

    def test_sizes_in_the_record(self):
        self.succeed("mesh", "square.poly", "--area", "0.1", *self.OUTPUTS)
        result = self.on_ranks(2, "mesh", "square.poly", "--area", "0.1", "-n", "4", "-o", "m.pvtu", "--json", "m.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        for record in ("a.json", "m.json"):
            files = json.loads((self.folder / record).read_text())["files"]
            self.assertGreater(len(files), 2)
            for file in files:
                self.assertEqual(file["bytes"], os.path.getsize(self.folder / file["name"]), file)


class NoWayOut(Files):
    """Names in files lead out of their folder only when the command line says so."""

    EXPERIMENT = "input: {file: square.poly}\nbounds: {triangles: 2e3}\ncluster: {ranks: 2}\nreport: false\n"

    def setUp(self):
        super().setUp()
        for folder in ("work", "other"):
            (self.folder / folder).mkdir()
        self.write("work/square.poly", SQUARE)
        self.outer, self.folder = self.folder, self.folder / "work"

    def everything(self):
        return sorted(str(path.relative_to(self.outer)) for path in self.outer.rglob("*"))

    def test_the_name_of_an_experiment(self):
        for name in ("../other/x", str(self.outer / "other/x"), "link/x"):
            (self.folder / "link").unlink(missing_ok=True)
            (self.folder / "link").symlink_to("../other")
            self.write("e.yaml", f"name: {name}\n" + self.EXPERIMENT)
            before = self.everything()
            self.refuse("run", "e.yaml", says=["other/x.runs" if "other" in name else "link/x.runs", "outside",
                                               "--allow-outside"])
            self.assertEqual(self.everything(), before)
            self.succeed("run", "e.yaml", "--quiet", "-o", "mine")
            self.assertTrue((self.folder / "mine/table.csv").exists())
            self.succeed("run", "e.yaml", "--quiet", "--allow-outside")
            self.assertTrue((self.outer / "other/x.runs/table.csv").exists())
            for path in (self.outer / "other/x.runs", self.folder / "mine"):
                shutil.rmtree(path)
        self.write("e.yaml", "name: sub/x\n" + self.EXPERIMENT)
        self.succeed("run", "e.yaml", "--quiet")
        self.assertTrue((self.folder / "sub/x.runs/table.csv").exists())

    def test_links_among_the_results(self):
        self.write("e.yaml", self.EXPERIMENT)
        (self.folder / "e.runs").symlink_to("../other")
        self.refuse("run", "e.yaml", says=["e.runs", "outside"])
        os.unlink(self.folder / "e.runs")
        (self.folder / "e.runs").mkdir()
        for name in ("table.csv", "run-1.json"):
            (self.folder / "e.runs" / name).symlink_to("../../other/file")
            self.refuse("run", "e.yaml", says=[name, "outside"])
            self.refuse("run", "e.yaml", "-o", "e.runs", says=[name, "outside"])
            os.unlink(self.folder / "e.runs" / name)
        self.assertEqual(list((self.outer / "other").iterdir()), [])
        (self.folder / "e.runs" / "table.csv").symlink_to("real.csv")
        self.succeed("run", "e.yaml", "--quiet")
        self.assertTrue((self.folder / "e.runs/real.csv").read_text().startswith("run"))

    def test_pieces(self):
        self.succeed("mesh", "square.poly", "-n", "2", "--area", "0.1", "-o", "m.pvtu")
        piece, elsewhere = self.folder / "m_0.vtu", self.outer / "other/m_0.vtu"
        pvtu = (self.folder / "m.pvtu").read_text()
        os.rename(piece, elsewhere)
        reads = [("check", "m.pvtu"), ("convert", "m.pvtu", "copy.vtu"), ("plot", "m.pvtu")]
        for source in ("../other/m_0.vtu", str(elsewhere), "x/../../other/m_0.vtu", "m_0.vtu"):
            piece.unlink(missing_ok=True)
            (self.folder / "x").mkdir(exist_ok=True)
            if source == "m_0.vtu":
                piece.symlink_to(elsewhere)
            self.write("m.pvtu", pvtu.replace('Source="m_0.vtu"', f'Source="{source}"'))
            for read in reads:
                self.refuse(*read, code=2 if read[0] == "check" else 1, says=["m.pvtu:", source, "--allow-outside"])
                self.succeed(*read, "--allow-outside")
        piece.unlink()
        (self.folder / "sub").mkdir()
        os.rename(elsewhere, self.folder / "sub/m_0.vtu")
        self.write("m.pvtu", pvtu.replace('Source="m_0.vtu"', 'Source="sub/m_0.vtu"'))
        self.succeed("check", "m.pvtu")


class Settings(Cli):
    """A settings file does not choose what is overwritten: its outputs stay in its folder."""

    KEYS = {"output": "'output.meshes'", "plot": "'output.picture'", "json": "'output.record'"}

    def test_outputs_stay_in_the_folder_of_the_file(self):
        seed = random.randrange(1 << 32)
        print(f"seed {seed}", flush=True)
        draw = random.Random(seed)
        (self.folder / "sub/deeper").mkdir(parents=True)
        (self.folder / "outside").mkdir()
        self.write("sub/square.poly", SQUARE)
        for _ in range(25):
            key, in_list = draw.choice(list(self.KEYS)), draw.random() < 0.5
            name = {"output": "m.vtu", "plot": "m.png", "json": "m.json"}[key]
            victim = draw.choice([self.folder / "outside" / name, self.folder / name])
            victim.write_text("precious")
            link, folder_link = self.folder / "sub" / ("link-" + name), self.folder / "sub/way"
            for path in (link, folder_link):
                path.unlink(missing_ok=True)
            link.symlink_to(victim)
            folder_link.symlink_to(victim.parent)
            spelled = draw.choice([str(victim), os.path.relpath(victim, self.folder / "sub"), f"deeper/../../{os.path.relpath(victim, self.folder)}",
                                   link.name, f"way/{name}", f"./deeper/../way/./{name}"])
            value = f"[ok.msh, '{spelled}']" if key == "output" and in_list else f"'{spelled}'"
            self.write("sub/run.yaml", f"input: square.poly\narea: 0.5\n{key}: {value}\n")
            self.refuse("mesh", "--config", "sub/run.yaml", says=["sub/run.yaml:3:", self.KEYS[key], spelled, "outside", "command line"])
            self.assertEqual(victim.read_text(), "precious", spelled)
        self.assertFalse((self.folder / "sub/ok.msh").exists())

    def test_names_are_relative_to_the_file(self):
        (self.folder / "sub/deeper").mkdir(parents=True)
        self.write("sub/square.poly", SQUARE)
        self.write("m.vtu", "precious")
        self.write("sub/run.yaml", "input: square.poly\noutput: [m.vtu, deeper/m.msh]\njson: m.json\n")
        self.succeed("mesh", "--config", "sub/run.yaml")
        self.assertEqual((self.folder / "m.vtu").read_text(), "precious")
        for made in ("sub/m.vtu", "sub/deeper/m.msh", "sub/m.json"):
            self.assertTrue((self.folder / made).exists(), made)
        self.succeed("mesh", "--config", "sub/run.yaml", "-o", "m.vtu", "--json", "outer.json")
        self.assertNotEqual((self.folder / "m.vtu").read_bytes(), b"precious")
        piped = subprocess.run([program.PATH, "mesh", "--config", "-"], cwd=self.folder / "sub", check=False, capture_output=True, text=True,
                               input="input: square.poly\noutput: [../m.vtu]\n")
        self.assertEqual(piped.returncode, 1, piped.stderr)
        self.assertIn("outside", piped.stderr)


class Contradictions(Cli):
    """What is given twice, or asked for and not there."""

    def test_a_name_given_twice(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "-o", "m.vtu")
        for raster in ("a.asc", "b.asc"):
            self.write(raster, "ncols 2\nnrows 2\nxllcorner -1\nyllcorner -1\ncellsize 3\n1 1\n1 1\n")
        self.write("e.yaml", "input: {generate: pipe}\nbounds: {triangles: 1000}\ncluster: {ranks: 2}\nreport: false\n")
        self.succeed("run", "e.yaml", "--quiet")
        twice = [(("mesh", "square.poly", "--size", "c"), "--raster", "c", "a.asc", "b.asc"),
                 (("check", "m.vtu", "square.poly", "--size", "c"), "--raster", "c", "a.asc", "b.asc"),
                 (("decompose", "square.poly", "-n", "2", "--size", "c"), "--raster", "c", "a.asc", "b.asc"),
                 (("mesh", "square.poly"), "--marker-name", "1", "a", "b"), (("mesh", "--generate", "pipe"), "--generate-with", "radius", "1", "2"),
                 (("mesh", "square.poly"), "--balance-with", "gain", "1", "2"), (("convert", "m.vtu", "n.vtu"), "--marker-name", "1", "a", "b"),
                 (("convert", "m.vtu", "n.vtu"), "--region-name", "0", "a", "b"), (("replay", "e.runs/run-1.json"), "--parameter", "x", "1", "2")]
        for call, option, name, one, other in twice:
            with self.subTest(call=call, option=option):
                result = self.refuse(*call, option, f"{name}={one}", option, f"{name}={other}", code=2,
                                     says=[option, name, one, "remove one of them"])
                self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.refuse("mesh", "square.poly", "--marker-name", "1=a", "--marker-name", "01=b", code=2, says=["--marker-name", "twice"])
        self.succeed("mesh", "square.poly", "--marker-name", "1=a", "--marker-name", "1=a", "-o", "m.vtu")

    def test_markers_and_regions_that_are_not_there(self):
        self.write("square.poly", SQUARE)  # markers 1 to 4, no regions
        self.succeed("mesh", "square.poly", "-o", "m.vtu")
        for option, value, what in (("--open-boundary", "9", "marker 9"), ("--open-boundary", "2,9", "marker 9"), ("--marker-name", "7=x", "marker 7"),
                                    ("--region-name", "10=x", "region 10")):
            for call in (("mesh", "square.poly", "-o", "m.14"), ("mesh", "square.poly", "-n", "3", "-o", "m.14"), ("convert", "m.vtu", "m.14")):
                result = self.refuse(*call, option, value, says=["has no ", what])
                self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.refuse("mesh", "square.poly", "--open-boundary", "9", "-o", "m.14", says=["1, 2, 3, 4"])
        self.assertFalse((self.folder / "m.14").exists())
        self.succeed("mesh", "square.poly", "--open-boundary", "2,3", "--marker-name", "4=wall", "-o", "m.14")
        self.succeed("convert", "m.vtu", "m.14", "--open-boundary", "2,3", "--marker-name", "4=wall")

    def test_unknown_extensions(self):
        """The list has each extension that there is."""
        self.write("square.poly", SQUARE)
        known = [".vtu", ".pvtu", ".msh", ".h5", ".su2", ".mesh", ".pmesh", ".14", ".grd", ".gr3", ".node", ".ele", ".poly", ".edge", ".neigh"]
        for call in (("mesh", "square.poly", "-o", "m.docx"), ("convert", "m.docx", "m.vtu"), ("convert", "m.vtu", "m.docx")):
            self.refuse(*call, says=["m.docx", "unknown extension", *known])
        for wrong in ("m.docx", "m"):
            said = self.run_program("check", wrong).stderr
            for extension in known:
                self.assertIn(extension, said)

    def test_options_of_other_formats(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "-o", "m.vtu")
        for option, formats in ((("--ascii",), ".msh"), (("--open-boundary", "2"), ".14, .grd or .gr3"), (("--open-from", "5"), ".14, .grd or .gr3"),
                                (("--ghost-layer",), ".pvtu")):
            for outputs in ((), ("-o", "x.vtu"), ("-o", "x.vtu", "-o", "x.su2")):
                self.refuse("mesh", "square.poly", *outputs, *option, code=2, says=[f"{option[0]} is about {formats}", "--output"])
            if option[0] != "--ghost-layer":
                self.refuse("convert", "m.vtu", "x.su2", *option, code=2, says=[f"{option[0]} is about {formats}", "x.su2"])
        self.assertFalse((self.folder / "x.vtu").exists() or (self.folder / "x.su2").exists())

    def test_domains_are_generated_as_poly_alone(self):
        for name, extension in (("x.geojson", ".geojson"), ("-.vtu", ".vtu")):
            self.refuse("generate", "pipe", "-o", name, says=[f"{name}: has the extension '{extension}'", ".poly", "driftmesh mesh"])
        self.assertEqual(list(self.folder.iterdir()), [])
        for name in ("x.poly", "x"):
            self.succeed("generate", "pipe", "-o", name)
        self.assertIn("\n", self.succeed("generate", "pipe", "-o", "-"))

    def test_empty_names(self):
        self.write("square.poly", SQUARE)
        self.refuse("mesh", "square.poly", "-o", "", code=2, says=["--output is empty"])
        self.write("run.yaml", "input: square.poly\noutput: ['']\n")
        self.refuse("mesh", "--config", "run.yaml", says=["run.yaml:2:10", "is empty"])

    def test_a_run_that_writes_nothing_says_so(self):
        self.write("square.poly", SQUARE)
        for more in ((), ("-n", "3"), ("--json", "r.json")):
            said = self.succeed("mesh", "square.poly", *more)
            self.assertRegex(said, r"(?m)^written +no mesh; -o FILE writes one: \.vtu, ")
        self.assertNotIn("no mesh", self.succeed("mesh", "square.poly", "-o", "m.vtu"))
        self.assertNotIn("no mesh", self.succeed("mesh", "square.poly", "--plot", "m.png"))


class NoFiles(Cli):
    """What is no file cannot be read: one error, at once."""

    READERS = (("mesh", "{}.poly"), ("mesh", "{}.geojson"), ("mesh", "{}.gpkg"), ("mesh", "--config", "{}.yaml"), ("run", "{}.yaml"),
               ("check", "{}.vtu"), ("convert", "{}.msh", "x.vtu"), ("convert", "{}.h5", "x.vtu"), ("convert", "{}.su2", "x.vtu"),
               ("convert", "{}.14", "x.vtu"), ("convert", "{}.pvtu", "x.vtu"), ("convert", "{}.node", "x.vtu"),
               ("plot", "{}.vtu", "-o", "x.png"), ("mesh", "square.poly", "--size-mesh", "{}.node"),
               ("mesh", "square.poly", "--decomposition", "{}.txt"), ("replay", "{}.json"),
               ("mesh", "square.poly", "--raster", "a={}.asc", "--size", "a"), ("mesh", "square.poly", "--raster", "a={}.tif", "--size", "a"))

    def test_pipes_devices_and_folders(self):
        self.write("square.poly", SQUARE)
        self.write("square.ele", "0 3 0\n")
        makers = {"pipe": os.mkfifo, "device": lambda path: path.symlink_to("/dev/zero"), "folder": lambda path: path.mkdir(),
                  "socket": lambda path: socket.socket(socket.AF_UNIX).bind(str(path))}
        for what, make in makers.items():
            for reader in self.READERS:
                call = [word.format("odd") for word in reader]
                name = next(word for word in call if "odd" in word).split("=")[-1]
                with self.subTest(what=what, call=call):
                    if not (self.folder / name).is_symlink() and not (self.folder / name).exists():
                        make(self.folder / name)
                    if name == "odd.node":
                        self.write("odd.ele", "0 3 0\n")
                    result = subprocess.run([program.PATH, *call], cwd=self.folder, capture_output=True, text=True, timeout=20, check=False,
                                            env=program.RANKS_ENVIRONMENT)
                    self.assertIn(result.returncode, (1, 2), result.stderr)
                    self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                    self.assertIn(name, result.stderr)
                    self.assertIn(f"is a {what}", result.stderr)
            for path in self.folder.glob("odd.*"):
                path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink()

    def test_pipes_of_the_shell_are_read(self):
        self.write("square.poly", SQUARE)
        self.succeed("mesh", "square.poly", "-o", "m.vtu")
        whole = subprocess.run(["bash", "-c", f"'{program.PATH}' check <(cat m.vtu)"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertIn("has no extension", whole.stderr)  # as always: a pipe has no name that tells its format
        meshed = subprocess.run(["bash", "-c", f"'{program.PATH}' mesh --config <(echo 'input: {self.folder}/square.poly')"], cwd=self.folder,
                                capture_output=True, text=True, check=False)
        self.assertEqual(meshed.returncode, 0, meshed.stderr)


if __name__ == "__main__":
    main()
