#!/usr/bin/env python3
"""Asks whether the tests notice faults: puts those of tests/mutation/faults into a copy of the sources, each behind a switch, builds the
copy once, and runs for each fault the tests that pass its place, shortest first, until one fails.

usage: mutation.py [--box NAME ...] [--changed BASE] [--line FILE:LINE ...] [-j N] [--update] ...

The copy and its build are build/mutation, or what --copy names. The exit code is 0 if the tests notice at least 98 % of the faults that somebody could
notice (with --changed or --line: all), 1 if not, and 2 if something is wrong with the faults, the build or the tests themselves.
"""

import argparse
import ast
import collections
import concurrent.futures
import itertools
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

sys.dont_write_bytecode = True

import faults  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "scripts/tables"))

import results  # noqa: E402
from table import Table, percent  # noqa: E402

COPY = ROOT / "build/mutation"
BUILD = COPY / "build/ci"  # where it would lie beside the sources: a compiler cache then knows what no fault has changed
PLACES = 1 << 16
MOST_CLOSE = 20  # tests: those that pass few other places than a fault's are likely to be about it
FOLDERS = ["unit", "property", "protocol", "regression", "sim", "mutants", "cli", "digests", "c", "mpi", "python"]
BYTES = 4 << 30
NOTICED = pathlib.Path(__file__).resolve().with_name("noticed.json")  # what noticed each fault, by its number: what to try first anywhere
PAGE = """# Results: do the tests notice?

By `tests/mutation/mutation.py --update`: faults of one line each are put into the sources one at a time, and the tests that pass the
place run until one fails. [Mutated sources](../development.md#mutated-sources) says how.
"""


def say(text):
    print(text, flush=True)


class Unit:
    """What can be run alone: a test case of a doctest program, or a test of ctest as it is."""

    def __init__(self, name, command, environment, folder, doctest, is_case=False):
        self.name, self.command, self.environment, self.folder, self.doctest, self.is_case = name, command, environment, folder, doctest, is_case
        self.seconds, self.places, self.fails = 0.0, frozenset(), False

    def run(self, timeout, **environment):
        """'passed', 'failed' or 'timeout', and what it says."""
        with tempfile.TemporaryDirectory(prefix="driftmesh-mutation-", ignore_cleanup_errors=True) as scratch, tempfile.TemporaryFile() as output:
            process = subprocess.Popen(self.command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                                       env={**os.environ, **self.environment, "TMPDIR": scratch, **environment}, start_new_session=True,
                                       preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES)))
            try:
                code = process.wait(timeout)
            except subprocess.TimeoutExpired:
                return "timeout", b""
            finally:
                try:
                    os.killpg(process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
                process.wait()
            output.seek(0)
            said = output.read()
        ran = not self.doctest or re.search(rb"test cases: +[1-9]", said) is not None
        return "passed" if code == 0 and ran else "failed", said


def joined(some):
    """Cases of one program as one unit: a program may take longer to start than a case."""
    first = some[0]
    cases, files = (",".join(dict.fromkeys(u.command[i].split("=", 1)[1] for u in some)) for i in (1, 2))
    command = [first.command[0], f"--test-case={cases}", f"--source-file={files}", *first.command[3:]]
    unit = Unit(first.name, command, first.environment, first.folder, True)
    unit.seconds = sum(u.seconds for u in some)
    return unit


def batches(passing):
    """Them, the shortest first, each time as many as take twice as long: the cases of a program, and the unit that runs them."""
    seconds, passing = 2, collections.deque(passing)
    while passing:
        now, left = [], seconds
        while passing and (not now or passing[0].seconds <= left):
            left -= passing[0].seconds
            now.append(passing.popleft())
        seconds *= 2
        by_program = collections.defaultdict(list)
        for unit in now:
            by_program[unit.command[0] if unit.is_case else unit.name].append(unit)
        for some in by_program.values():
            yield some, some[0] if len(some) == 1 else joined(some)


# ---- The copy ----

def sources_of_tree():
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True).stdout
    return [name.decode() for name in names.split(b"\0") if name and (ROOT / name.decode()).is_file()]


def make_copy(data):
    by_file = collections.defaultdict(list)
    for fault in data:
        by_file[fault.file].append(fault)
    names = sources_of_tree()
    for name in names:
        content = (ROOT / name).read_bytes()
        if name in by_file:
            content = faults.schemata(content.decode(), by_file[name]).encode()
        place = COPY / name
        if not place.is_file() or place.read_bytes() != content:
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)
            shutil.copymode(ROOT / name, place)
    kept = COPY / "copied.json"
    for name in set(json.loads(kept.read_text()) if kept.is_file() else []) - set(names):
        (COPY / name).unlink(missing_ok=True)
    kept.write_text(json.dumps(names))


def build(jobs):
    run = lambda *command: subprocess.run(command, cwd=COPY, check=True, stdout=log, stderr=subprocess.STDOUT)  # noqa: E731
    with (COPY / "build.log").open("w") as log:
        run("cmake", "--preset", "ci", "-Wno-dev")
        programs = {str(pathlib.Path(p).relative_to(BUILD)) for test in tests_of_ctest() for p in test["command"] if p.startswith(f"{BUILD}/")}
        folders = [f"tests/{name}/all" for name in FOLDERS] + ["python/all"]  # ctest tells no command whose program is not there yet
        run("nice", "-n", "5", "ninja", "-k", "0", "-C", str(BUILD), "-j", str(jobs), *folders, *sorted(programs))


# ---- The tests ----

def tests_of_ctest():
    shown = subprocess.run(["ctest", "--show-only=json-v1"], cwd=BUILD, check=True, capture_output=True, text=True).stdout
    found = []
    for test in json.loads(shown)["tests"]:
        properties = {p["name"]: p["value"] for p in test["properties"]}
        labels = properties.get("LABELS", [])
        if "command" in test and "long" not in labels and set(labels) & set(FOLDERS):
            found.append({"name": test["name"], "command": test["command"], "labels": labels, "folder": properties.get("WORKING_DIRECTORY", str(BUILD)),
                          "environment": dict(e.split("=", 1) for e in properties.get("ENVIRONMENT", []))})
    return found


def cases_of(program, environment):
    listed = subprocess.run([program, "--list-test-cases", "--reporters=xml"], check=True, capture_output=True, env={**os.environ, **environment}).stdout
    return [(case.get("name"), case.get("filename")) for case in xml.etree.ElementTree.fromstring(listed).iter("TestCase")]


def methods_of(command):
    """The methods of a script of unittest, 'Class.method', if that is what a test runs, and the command without a class."""
    scripts = [part for part in command[1:2] if part.endswith("_test.py")]
    if not scripts:
        return [], command
    classes = [node for node in ast.parse(pathlib.Path(scripts[0]).read_text()).body if isinstance(node, ast.ClassDef)]
    classes = [c for c in classes if c.name in command] or classes
    methods = [f"{c.name}.{m.name}" for c in classes for m in c.body if isinstance(m, ast.FunctionDef) and m.name.startswith("test")]
    return methods, [part for part in command if part not in {c.name for c in classes}]


def units():
    found = {}
    for test in tests_of_ctest():
        command = test["command"]
        if not os.access(command[0], os.X_OK):
            continue
        if len(command) <= 2 and command[0].endswith("_test") | command[0].endswith("_tests") and "polygon_sets" not in command[0]:
            files = command[1].split("=", 1)[1].split(",") if len(command) == 2 else ["*"]
            for case, file in cases_of(command[0], test["environment"]):
                if not any(file.endswith(f.lstrip("*")) for f in files):
                    continue
                name = f"{pathlib.Path(file).stem}: {case}"
                filters = [f"--test-case={case.replace(',', '?')}", f"--source-file=*{pathlib.Path(file).name}", "--abort-after=1"]
                found[name] = Unit(name, [command[0], *filters], test["environment"], test["folder"], True, is_case=True)
        elif (methods := methods_of(command))[0]:
            for method in methods[0]:
                name = f"{test['name']}: {method}"
                found[name] = Unit(name, [*methods[1], method], test["environment"], test["folder"], False)
        else:
            found[test["name"]] = Unit(test["name"], command, test["environment"], test["folder"], "--source-file" in " ".join(command))
    return found


def fingerprint(unit):
    programs = [p for p in unit.command if p.startswith("/") and os.path.isfile(p)]
    return [[os.path.getsize(p), os.path.getmtime(p)] for p in programs]


def learn_places(all_units, jobs, longest):
    """Runs each without faults, unless its programs are those of the last time: how long it takes, and what it passes."""
    store = COPY / "passed.json"
    known = json.loads(store.read_text()) if store.is_file() else {}
    fresh = {}

    def learn(unit):
        seen = known.get(unit.name)
        if seen is None or seen["programs"] != fingerprint(unit) or seen["longest"] != longest:
            with tempfile.NamedTemporaryFile() as shared:
                shared.write(bytes(PLACES))
                shared.flush()
                begin = time.monotonic()
                outcome, _ = unit.run(longest, DRIFTMESH_FAULTS_PASSED=shared.name)
                shared.seek(0)
                passed = [place for place, byte in enumerate(shared.read()) if byte]
                seen = {"programs": fingerprint(unit), "longest": longest, "seconds": time.monotonic() - begin, "outcome": outcome, "places": passed}
        fresh[unit.name] = seen
        unit.seconds, unit.places, unit.fails = seen["seconds"], frozenset(seen["places"]), seen["outcome"] == "failed"
        return seen["outcome"] == "passed"

    usable = []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for unit, good in zip(all_units.values(), pool.map(learn, all_units.values())):
            usable += [unit] if good else []
            if len(fresh) % 100 == 0:  # so that a run that is stopped has not learned for nothing
                store.write_text(json.dumps(known | fresh))
    store.write_text(json.dumps(known | fresh))
    return usable


# ---- The verdicts ----

class Verdict:
    def __init__(self, fault, how, by="", tried=0, seconds=0.0):
        self.fault, self.how, self.by, self.tried, self.seconds = fault, how, by, tried, seconds

    @property
    def noticed(self):
        return self.how in ("failed", "timeout")


class Verdicts:
    """Those of all runs on the copy, by the numbers of faults: a run may be stopped, and boxes may be tried one by one."""

    def __init__(self, data):
        self.store = COPY / "verdicts.json"
        self.known = json.loads(self.store.read_text()) if self.store.is_file() else {}
        self.noticed = json.loads(NOTICED.read_text()) if NOTICED.is_file() else {}
        self.killers = collections.defaultdict(collections.Counter)  # of faults in a file
        for fault in data:
            self.count(fault, self.noticed_by(fault))

    def noticed_by(self, fault):
        """The test that noticed it the last time, here or elsewhere, or None."""
        v = self.of(fault)
        return v.by if v and v.noticed else self.noticed.get(str(fault.number))

    def count(self, fault, test):
        if test:
            self.killers[fault.file][test] += 1

    def keep(self, v):
        self.known[str(v.fault.number)] = [v.how, v.by, v.tried, v.seconds]
        self.store.write_text(json.dumps(self.known))
        self.count(v.fault, v.by if v.noticed else None)

    def record(self, data):
        """Keeps in the tree what noticed faults, for those who try them next."""
        by = {str(f.number): test for f in data if (test := self.noticed_by(f))}
        NOTICED.write_text(json.dumps(by, indent=0, sort_keys=True) + "\n")

    def of(self, fault):
        known = self.known.get(str(fault.number))
        return known and Verdict(fault, *known)

    def likely_killers(self, fault):
        """The names of tests: what noticed it the last time, and what noticed most others in that file."""
        known = self.noticed_by(fault)
        return list(dict.fromkeys(([known] if known else []) + [name for name, _ in self.killers[fault.file].most_common(8)]))


def try_fault(fault, usable, kept, options):
    passing = sorted((u for u in usable if fault.number % PLACES in u.places), key=lambda u: u.seconds)
    begin, tried = time.monotonic(), 0
    by_name = {u.name: u for u in passing}
    first = [by_name[name] for name in kept.likely_killers(fault) if name in by_name]
    if options.first:
        first = [u for u in passing if re.search(options.first, u.name) and u not in first] + first
    left = [u for u in passing if u not in first]
    close = sorted(left, key=lambda u: len(u.places))[:MOST_CLOSE]
    for some, unit in itertools.chain((([u], u) for u in first), batches(close), batches([u for u in left if u not in close])):
        if time.monotonic() - begin > options.budget:
            return Verdict(fault, "survived", f"{len(passing) - tried} tests not tried", tried, time.monotonic() - begin)
        outcome, said = unit.run(10 + (10 if len(some) == 1 else 4) * unit.seconds, DRIFTMESH_FAULT=str(fault.number))
        tried += len(some)
        if outcome != "passed":
            by = next((u.name for u in some if f"TEST CASE:  {u.name.split(': ', 1)[-1]}".encode() in said), unit.name)
            return Verdict(fault, outcome, by, tried, time.monotonic() - begin)
    return Verdict(fault, "survived" if passing else "unreached", "", tried, time.monotonic() - begin)


def in_order(kept, some):
    return sorted((kept.of(f) for f in some), key=lambda v: (v.fault.box, v.fault.file, v.fault.line))


def harmless_words(verdicts):
    """What changes nothing, and why."""
    words = [f"- `{v.fault.file}`: {v.fault.meaning}: {v.fault.harmless}" for v in verdicts if v.fault.harmless]
    return "\n".join(["Faults that change nothing that a test could see:", "", *words]) if words else ""


def missed_words(verdicts):
    words = [f"- `{v.fault.file}`: {v.fault.meaning}" for v in verdicts if not v.noticed and not v.fault.harmless]
    return "\n".join(["Missed:", "", *words]) if words else ""


def table(verdicts):
    counts, seconds = collections.defaultdict(collections.Counter), collections.Counter()
    for v in verdicts:
        for row in (v.fault.box, "all"):
            counts[row]["harmless" if v.fault.harmless and not v.noticed else v.how] += 1
            seconds[row] += v.seconds
    made = Table("mutation", "Faults that the tests notice",
                 ["faults in", "faults", "noticed", "of these by time", "missed", "not reached", "change nothing", "share noticed", "minutes of tests"],
                 "\n\n".join(filter(None, [missed_words(verdicts), harmless_words(verdicts)])))
    for row in [*sorted(set(counts) - {"all"}), "all"]:
        c = counts[row]
        noticed, all_of_them = c["failed"] + c["timeout"], sum(c.values())
        made.add(row, all_of_them, noticed, c["timeout"], c["survived"], c["unreached"], c["harmless"], percent(noticed / max(1, all_of_them - c["harmless"])),
                 round(seconds[row] / 60))
    return made


def chosen(data, options):
    if options.changed:
        names = subprocess.run(["git", "diff", "--name-only", options.changed], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()
        data = [f for f in data if f.file in names]
    if options.box:
        data = [f for f in data if f.box in options.box]
    if options.line:
        data = [f for f in data if any(f.line == line or f.line.startswith(line + ":") for line in options.line)]
    return data


def main():
    global COPY, BUILD
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--box", action="append", help="only the faults of this file of faults/ (migration, protocol, ...); no others are built")
    parser.add_argument("--changed", metavar="BASE", help="only faults in files that differ from this commit")
    parser.add_argument("--line", action="append", metavar="FILE:LINE", help="only the fault that begins at this line of faults/, as messages name it")
    parser.add_argument("--left", action="store_true", help="only faults that were missed on this copy, or not tried yet")
    parser.add_argument("--tests", metavar="REGEX", default="", help="run only tests with such names, as in 'runtime_|subdomain_state' (default: all)")
    parser.add_argument("--first", metavar="REGEX", default="", help="try tests with such names before others: new ones, as in 'recorded_'")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count(), help="faults at a time (default: all cores)")
    parser.add_argument("--longest", type=float, default=20, metavar="SECONDS", help="leave out tests that take longer (default: 20)")
    parser.add_argument("--budget", type=float, default=120, metavar="SECONDS", help="give up on a fault after this time (default: 120)")
    parser.add_argument("--no-build", action="store_true", help="use the copy as it was built, with these faults at least")
    parser.add_argument("--copy", metavar="FOLDER", type=pathlib.Path, default=COPY,
                        help="where the copy of the sources and its build lie; as deep as another build, they share its compiler cache (default: build/mutation)")
    results.add_option(parser)
    options = parser.parse_args()
    COPY = options.copy.resolve()
    BUILD = COPY / "build/ci"
    try:
        some = chosen(faults.read(), options)
        if not some:
            say("no faults to try")
            return 0
        if not options.no_build:
            make_copy(some)
            say(f"building {COPY} with {len(some)} faults (build.log)")
            build(options.jobs)
    except faults.BadFault as problem:
        say(f"mutation.py: {problem}")
        return 2
    except subprocess.CalledProcessError as problem:
        say(f"mutation.py: {problem}; see {COPY / 'build.log'}")
        return 2
    all_units = {name: unit for name, unit in units().items() if re.search(options.tests, name)}
    say(f"running {len(all_units)} tests without a fault, where they are not known yet")
    usable = learn_places(all_units, options.jobs, options.longest)
    broken = [u.name for u in all_units.values() if u.fails]
    if broken:
        say("these fail without a fault, and are left out: " + ", ".join(broken[:20]))
    kept = Verdicts(faults.read())
    todo = [f for f in some if not options.left or not (known := kept.of(f)) or not known.noticed]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        jobs = [pool.submit(try_fault, f, usable, kept, options) for f in todo]
        for job in concurrent.futures.as_completed(jobs):
            v = job.result()
            kept.keep(v)
            if v.noticed and v.fault.harmless:
                say(f"{v.fault.line} is called harmless, but {v.by} notices it: {v.fault.meaning}")
            elif not v.noticed and not v.fault.harmless:
                say(f"{v.how}: {v.fault.line} ({v.fault.file}), {v.tried} tests, {v.seconds:.0f} s: {v.fault.meaning} {v.by}")
    verdicts = in_order(kept, some)
    counted = [v for v in verdicts if not v.fault.harmless]
    share = sum(v.noticed for v in counted) / max(1, len(counted))
    made = table(verdicts)
    say("\n" + made.markdown())
    if options.update:
        everything = faults.read()
        kept.record(everything)
        if untried := [f for f in everything if not kept.of(f)]:
            say(f"{len(untried)} faults have not been tried on this copy, the first of them {untried[0].line}; the page of results stays as it is")
            return 2
        made = table(in_order(kept, everything))
        page = ROOT / results.FOLDER / "mutation.md"
        if not page.exists():
            page.write_text(PAGE)
        results.update("tests/mutation/mutation.py", [made], results.origin(BUILD / "driftmesh"))
    return 0 if share >= (1 if options.changed or options.line else 0.98) else 1


if __name__ == "__main__":
    sys.exit(main())
