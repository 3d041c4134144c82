#!/usr/bin/env python3
"""Help, the manual page and completion, which derive from the same description of the commands: they agree, man and
shells understand them, and shells complete what they should.

usage: shells_test.py DRIFTMESH [unittest options]
"""

import os
import re
import shutil
import subprocess

import program
from program import Cli, main

KINDS = ["bay", "comb", "cylinder-flow", "fan", "holes", "pipe", "random-points", "random-polygon", "rectangle-hole"]
COMMANDS = ["adapt", "calibrate", "check", "clean", "config", "convert", "decompose", "generate", "help", "mesh", "plot", "replay", "run", "triangle"]


class Help(Cli):
    def setUp(self):
        super().setUp()
        if re.search(r"^  report ", self.succeed("--help"), re.MULTILINE):  # only if npm was there when it was built
            self.addCleanup(COMMANDS.remove, "report")
            COMMANDS.insert(COMMANDS.index("run"), "report")

    def commands(self):
        """Every command with its help."""
        for words in [[], *([c] for c in COMMANDS), *(["generate", kind] for kind in KINDS)]:
            yield words, self.succeed(*words, "--help")

    def test_help_names_every_command(self):
        self.assertEqual(sorted(re.findall(r"^  ([a-z-]+) {2}", self.succeed("--help").split("Commands:")[1],
                                           re.MULTILINE)), COMMANDS)
        self.assertEqual(sorted(re.findall(r"^  ([a-z-]+) {2}", self.succeed("generate", "--help").split("Commands:")[1],
                                           re.MULTILINE)), KINDS)

    def test_help_can_be_asked_for_in_three_ways(self):
        for words, text in self.commands():
            self.assertEqual(self.succeed("help", *words), text)
            self.assertEqual(self.succeed(*words, "-h"), text)
        self.refuse("help", "mseh", code=2, says=["mseh", "did you mean mesh?"])

    def test_the_manual_page_names_every_option(self):
        page = self.succeed("config", "--man").replace("\\-", "-")
        sections = re.split(r"^\.S[HS] ", page, flags=re.MULTILINE)
        for words, text in self.commands():
            name = " ".join(["driftmesh", *words])
            section = next(s for s in sections if s.startswith(f"{name} [") or (not words and s.startswith("OPTIONS")))
            for option in re.findall(r"^  (?:-(\w), )?(--[a-z-]+)", text, re.MULTILINE):
                self.assertIn(f"\\fB{option[1]}\\fR", section, name)
                if option[0]:
                    self.assertIn(f"\\fB-{option[0]}\\fR, ", section, name)

    def test_man_has_no_complaints(self):
        self.write("driftmesh.1", self.succeed("config", "--man"))
        formatters = [["man", "--warnings", "-l", "driftmesh.1"], ["groff", "-ww", "-man", "-Tutf8", "driftmesh.1"]]
        formatters = [command for command in formatters if shutil.which(command[0])]
        if not formatters:
            self.skipTest("NEITHER man NOR groff IS INSTALLED")
        for command in formatters:
            result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=True, timeout=60,
                                    env=dict(os.environ, MANWIDTH="100", LC_ALL="C.UTF-8"))
            self.assertEqual(result.stderr, "")
            self.assertIn("--max-triangles", re.sub(r"(.)\x08\1|\x1b\[[0-9;]*m", r"\1", result.stdout)
                          .replace("‐", "-").replace("−", "-"))

    def test_pages_are_built_with_the_program(self):
        share = os.path.join(os.path.dirname(program.PATH), "share")
        for path, arguments in (("man/man1/driftmesh.1", ["--man"]),
                                ("bash-completion/completions/driftmesh", ["--completion", "bash"]),
                                ("zsh/site-functions/_driftmesh", ["--completion", "zsh"]),
                                ("fish/vendor_completions.d/driftmesh.fish", ["--completion", "fish"])):
            with open(os.path.join(share, path), encoding="utf-8") as file:
                self.assertEqual(file.read(), self.succeed("config", *arguments))


class Completion(Cli):
    """All shells complete the same words."""

    CASES = {
        "driftmesh me": ["mesh"],
        "driftmesh generate ": KINDS,
        "driftmesh generate bay --r": ["--resolution", "--roughness"],
        "driftmesh mesh --ar": ["--area"],
        "driftmesh mesh --work-order ": ["backlog", "given", "largest"],
        "driftmesh mesh --method ": ["coupled", "decoupled", "rounds"],  # not what only experiments have
        "driftmesh mesh --balance ": ["diffusion", "greedy", "none", "stealing", "zoltan"],
        "driftmesh mesh b": ["bay.poly", "bay.vtu"],
        "driftmesh mesh --area 5 bay.p": ["bay.poly"],
        "driftmesh check bay.v": ["bay.vtu"],
        "driftmesh mesh -o my": ["my file.vtu"],
        "driftmesh run bay.poly -o ": ["folder/"],
        "driftmesh config --completion ": ["bash", "fish", "zsh"],
        "driftmesh help con": ["config", "convert"],
        "driftmesh --v": ["--version"],
    }

    def setUp(self):
        super().setUp()
        for name in ("bay.poly", "bay.vtu", "my file.vtu"):
            self.write(name, "")
        (self.folder / "folder").mkdir()

    def script(self, shell, name):
        (self.folder / "folder" / name).write_text(self.succeed("config", "--completion", shell))
        return f"folder/{name}"

    def needed(self, shell):
        if not shutil.which(shell):
            self.skipTest(f"{shell.upper()} IS NOT INSTALLED: its completion is not tested")

    def run_shell(self, *command):
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""), command)
        return sorted(set(result.stdout.splitlines()))

    def test_bash(self):
        script = self.script("bash", "script")
        self.run_shell("bash", "-n", script)
        complete = f'source {script}; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _driftmesh; printf "%s\\n" "${{COMPREPLY[@]}}"'
        for line, expected in self.CASES.items():
            with self.subTest(line=line):
                found = self.run_shell("bash", "-uc", complete, "bash", *line.split(" "))
                self.assertEqual(found, [name.rstrip("/") for name in expected])
        for words, expected in ((["--work-order", "=", "la"], ["largest"]), (["--work-order", "="], ["backlog", "given", "largest"]),
                                (["--area", ""], [""]), (["--area", "b"], [""])):
            self.assertEqual(self.run_shell("bash", "-uc", complete, "bash", "driftmesh", "mesh", *words), expected)

    def test_fish(self):
        self.needed("fish")
        script = self.script("fish", "script")
        for line, expected in {**self.CASES, "driftmesh mesh --work-order=la": ["--work-order=largest"],
                               "driftmesh mesh --area b": []}.items():
            with self.subTest(line=line):
                found = self.run_shell("fish", "--no-config", "-c", f"source {script}; complete -C '{line}'")
                self.assertEqual([candidate.split("\t")[0] for candidate in found], expected)

    # The variables that zsh gives to completion functions. They offer candidates, and zsh keeps those that match.
    ZSH = """
compdef() { : }
compadd() { shift; print -l -- $* }
compset() { words[CURRENT]=${words[CURRENT]#*=} }
_describe() { local name=${@[-1]}; print -l -- ${${(P)name}%%:*} }
_files() { if [[ $* == -/ ]]; then print -l -- *(/N); else print -l -- *(N); fi }
_message() { : }
source $1
shift
words=("$@")
CURRENT=$#
_driftmesh
"""

    def test_zsh(self):
        self.needed("zsh")
        script = self.script("zsh", "_driftmesh")
        self.run_shell("zsh", "-fn", script)
        for line, expected in {**self.CASES, "driftmesh mesh --work-order=la": ["largest"], "driftmesh mesh --area ": []}.items():
            with self.subTest(line=line):
                words = line.split(" ")
                offered = self.run_shell("zsh", "-fuc", self.ZSH, "zsh", script, *words)
                typed = words[-1].rpartition("=")[2]
                self.assertEqual([name for name in offered if name.startswith(typed)],
                                 [name.rstrip("/") for name in expected])


if __name__ == "__main__":
    main()
