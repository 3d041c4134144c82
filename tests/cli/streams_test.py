#!/usr/bin/env python3
"""Standard input and output: as files, full, closed, and with a reader that goes away.

usage: streams_test.py DRIFTMESH [unittest options]
"""

import json
import os
import re
import signal
import subprocess
import time

import program
from program import MESHER_SECONDS, RANKS_ENVIRONMENT, SQUARE, Cli, main


class Streams(Cli):
    def setUp(self):
        super().setUp()
        self.write("square.poly", SQUARE)

    def pipe(self, *arguments, given=b"", code=0, before=(), **more):
        """What the program writes to standard output and error, as bytes and text, when it reads `given`."""
        result = subprocess.run([*before, program.PATH, *map(str, arguments)], cwd=self.folder, input=given,
                                capture_output=True, timeout=MESHER_SECONDS, check=False, **more)
        errors = result.stderr.decode(errors="replace")
        self.assertEqual(result.returncode, code, f"{arguments}\n{result.stdout[:200]}\n{errors}")
        return result.stdout, errors

    def shell(self, line, code=0):
        """The standard error of a shell that runs a line with `driftmesh` in it."""
        result = subprocess.run(["bash", "-c", f"driftmesh() {{ '{program.PATH}' \"$@\"; }}\n{line}"], cwd=self.folder,
                                capture_output=True, text=True, timeout=MESHER_SECONDS, check=False)
        self.assertEqual(result.returncode, code, f"{line}\n{result.stdout}{result.stderr}")
        return result.stderr


class Dashes(Streams):
    def test_a_whole_way_without_files(self):
        poly, said = self.pipe("generate", "pipe", "-o", "-")
        self.assertIn("points", said)
        mesh, said = self.pipe("mesh", "-", "--area", "0.1", "-o", "-", given=poly)
        digest = re.search(r"^digest +([0-9a-f]{16})$", said, re.MULTILINE).group(1)
        self.assertTrue(mesh.startswith(b"<?xml"))
        self.assertIn(digest.encode(), self.pipe("check", "-", given=mesh)[0])
        msh, said = self.pipe("convert", "-", "-.msh", given=mesh)
        self.assertEqual((msh[:11], said), (b"$MeshFormat", ""))
        self.assertIn(digest.encode(), self.pipe("check", "-.msh", given=msh)[0])
        picture, said = self.pipe("plot", "-.msh", "-o", "-", given=msh)
        self.assertEqual((picture[:4], said), (b"\x89PNG", ""))
        picture, said = self.pipe("plot", "-.poly", "-o", "-.svg", given=poly)
        self.assertEqual((picture[:5], said), (b"<?xml", ""))
        self.assertEqual(self.files(), ["square.poly"])

    def test_a_file_in_a_pipe_is_the_same_as_one_on_disk(self):
        self.succeed("mesh", "square.poly", "--area", "0.1", "-o", "square.vtu", "-o", "square.msh")
        for name in "-.vtu", "-.msh":
            mesh, _ = self.pipe("mesh", "-", "--area", "0.1", "-o", name, given=SQUARE.encode())
            self.assertEqual(mesh, (self.folder / f"square{name[1:]}").read_bytes())

    def test_records_and_decompositions(self):
        record, said = self.pipe("mesh", "square.poly", "--json", "-")
        self.assertTrue(json.loads(record)["mesh"]["complete"])
        self.assertIn("triangles", said)
        parts, said = self.pipe("decompose", "-", "-n", "3", "-o", "-", given=SQUARE.encode())
        self.assertTrue(parts.startswith(b"# driftmesh decomposition"))
        self.assertIn("Subdomains", said)
        said, _ = self.pipe("mesh", "square.poly", "--decomposition", "-", "--area", "0.5", given=parts,
                            env=RANKS_ENVIRONMENT)
        self.assertIn(b"subdomains", said)

    def test_ranks_share_what_the_first_reads_and_writes(self):
        mesh, said = self.pipe("mesh", "-", "--area", "0.01", "-n", "9", "-o", "-", given=SQUARE.encode(),
                               before=["mpiexec", "-n", "2"], env=RANKS_ENVIRONMENT)
        digest = re.search(r"^digest +([0-9a-f]{16})$", said, re.MULTILINE).group(1)
        self.assertIn(digest.encode(), self.pipe("check", "-", given=mesh)[0])

    def test_an_experiment(self):
        experiment = b"input: {file: square.poly}\nbounds: {triangles: 2e3}\ncluster: {ranks: 2}\nreport: false\n"
        said, _ = self.pipe("run", "-", given=experiment)
        self.assertIn(b"results in experiment.runs/", said)
        self.assertIn("run-1.json", os.listdir(self.folder / "experiment.runs"))

    def test_a_summary_that_is_not_wanted(self):
        mesh, said = self.pipe("mesh", "-", "--quiet", "-o", "-", given=SQUARE.encode())
        self.assertEqual((mesh[:5], said), (b"<?xml", ""))

    def test_files_that_cannot_be_streams(self):
        mesh = ["mesh", "square.poly", "--area", "1"]
        for arguments, says in ((["-o", "-", "--json", "-"], ["--json and --output"]), (["-o", "-", "-o", "-.msh"], ["twice"]),
                                (["-o", "-.ele"], ["-.ele", "several files"]),
                                (["-n", "2", "-o", "-.pvtu"], ["-.pvtu", "several files"]),
                                (["-o", "-.docx"], [".docx"]), (["--plot", "-.jpg"], ["-.jpg"]),
                                (["--size-mesh", "-"], ["background mesh"]),
                                (["-n", "2", "--size-mesh", "-"], ["background mesh"])):
            with self.subTest(arguments=arguments):
                self.refuse(*mesh, *arguments, says=says)
        self.refuse("convert", "-.ele", "x.vtu", says=["-.ele", "several files"])
        self.refuse("check", "-.pvtu", code=2, says=["-.pvtu", "several files"])
        self.assertEqual(self.files(), ["square.poly"])

    def test_standard_input_is_read_once(self):
        _, said = self.pipe("check", "-", "-", given=b"", code=2)
        self.assertIn("driftmesh: -", said)
        mesh, _ = self.pipe("mesh", "square.poly", "-o", "-")
        _, said = self.pipe("check", "-", "-", given=mesh, code=2)
        self.assertIn("standard input can be read only once", said)

    def test_wrong_input_is_reported_with_its_line(self):
        _, said = self.pipe("mesh", "-", given=SQUARE.replace("3 4 4", "3 nan 4").encode(), code=1)
        self.assertIn("driftmesh: -:4:", said)
        _, said = self.pipe("mesh", "-", given=b"0 2 0 0\n", code=1)
        self.assertIn("standard input", said)

    def test_a_file_may_have_such_a_name(self):
        self.succeed("generate", "pipe", "-o", "./-")
        self.assertEqual(self.files(), ["-", "square.poly"])


class Rim(Streams):
    """The program's own output."""

    PRINTING = ("--help", "--version", "config --schema", "config --man", "config --completion bash", "help mesh",
                "mesh square.poly", "mesh square.poly -o - --quiet", "mesh square.poly --json -",
                "mesh square.poly --plot -.svg", "generate bay -o -", "decompose square.poly -n 2")

    def test_a_full_standard_output_is_an_error(self):
        for arguments in self.PRINTING:
            with self.subTest(arguments=arguments):
                self.assertIn("driftmesh: standard output: cannot write: No space left on device",
                              self.shell(f"driftmesh {arguments} > /dev/full", code=1))

    def test_a_closed_standard_output_is_an_error(self):
        for arguments in self.PRINTING:
            with self.subTest(arguments=arguments):
                self.assertIn("driftmesh: standard output: cannot write: Bad file descriptor",
                              self.shell(f"driftmesh {arguments} >&-", code=1))
        self.assertEqual(self.files(), ["square.poly"])

    def test_check_that_cannot_print_its_verdict_does_not_reject(self):
        self.succeed("mesh", "square.poly", "-o", "square.vtu")
        self.shell("driftmesh check square.vtu > /dev/full", code=2)

    def test_a_program_that_prints_nothing_needs_no_standard_output(self):
        for streams in (">&-", "> /dev/full", "<&- >&- 2>&-"):
            with self.subTest(streams=streams):
                self.shell(f"driftmesh mesh square.poly --area 1 --quiet -o out.vtu {streams}")
                self.shell("driftmesh check out.vtu square.poly --area 1")
                (self.folder / "out.vtu").unlink()

    def test_errors_set_the_exit_code_even_without_standard_error(self):
        self.shell("driftmesh mesh none.poly 2>&-", code=1)

    def test_a_reader_that_goes_away_ends_the_program_quietly(self):
        for ignored in "", "trap '' PIPE; ":
            for arguments in ("generate bay -o -", "mesh square.poly --area 0.0005 -o -"):
                with self.subTest(arguments=arguments, ignored=ignored):
                    said = self.shell(f"{ignored}driftmesh {arguments} | head -c 100 > /dev/null; "
                                      "exit ${PIPESTATUS[0]}", code=128 + signal.SIGPIPE)
                    self.assertEqual(said, "")
        self.assertEqual(self.files(), ["square.poly"])

    def test_a_reader_that_goes_away_leaves_no_half_files(self):
        os.mkfifo(self.folder / "summary")
        with subprocess.Popen([program.PATH, "mesh", "square.poly", "--area", "0.002", "-o", "-", "-o", "whole.ele"],
                              cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as mesher:
            mesher.stdout.close()
            self.assertEqual(mesher.wait(MESHER_SECONDS), -signal.SIGPIPE)
        self.assertFalse([name for name in self.files() if "tmp" in name], self.files())


class Progress(Streams):
    """Progress of a long run. Here it waits for its input, which costs nothing."""

    def wait_for_input(self, seconds, *arguments, **more):
        with subprocess.Popen([program.PATH, "mesh", "-", *arguments], cwd=self.folder, text=True,
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more) as mesher:
            time.sleep(seconds)
            _, said = mesher.communicate(SQUARE, MESHER_SECONDS)
            self.assertEqual(mesher.returncode, 0, said)
        return said

    def test_plain_lines_where_there_is_no_terminal(self):
        said = self.wait_for_input(11)
        self.assertEqual(said, "[5 s] read  5 s\n[10 s] read  10 s\n")

    def test_no_lines_if_quiet(self):
        self.assertEqual(self.wait_for_input(6, "--quiet"), "")

    def test_a_terminal_shows_one_line_that_is_rewritten(self):
        try:
            control, terminal = os.openpty()
        except OSError as error:
            self.skipTest(f"no pseudo terminal can be opened here: {error}")
        with subprocess.Popen([program.PATH, "mesh", "-"], cwd=self.folder, stdin=subprocess.PIPE,
                              stdout=subprocess.DEVNULL, stderr=terminal, env=dict(os.environ, TERM="vt100")) as mesher:
            time.sleep(1.5)
            mesher.communicate(SQUARE.encode(), MESHER_SECONDS)
        os.close(terminal)
        said = os.read(control, 10000).decode()
        self.assertIn("\rread", said)
        self.assertTrue(said.endswith("\r\x1b[K"), said)
        self.assertNotIn("\n", said)


if __name__ == "__main__":
    main()
