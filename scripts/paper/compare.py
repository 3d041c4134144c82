#!/usr/bin/env python3
"""Sets what the experiments of configs/paper and measure.py have found beside what the paper says.

usage: compare.py FOLDER [--small] [--update ORIGIN]

Reads FOLDER/table-1, FOLDER/fig-7, ... and FOLDER/measured.json. Writes each table as .md and .csv, fig-7.svg, fig-10.svg,
fig-10-modern.svg, and paper.md and paper.html with all tables; with --update also docs/results/paper.md, where ORIGIN is the line that
says where the figures come from.
"""

import argparse
import json
import pathlib
import statistics

import chart
import page
import published
import results
from replay import replayed, unbalanced
from runs import read_runs
from table import Table, percent

COMMUNICATING = ["sending", "polling"]


def scale(run):
    """What seconds of PCDM's ranks must be multiplied with to stand for 10 million triangles a rank."""
    stands_for = published.PCDM_SPEED / run.record["cluster"]["speeds"][0]
    return 10e6 / (run.value("bounds.triangles-per-rank") * stands_for)


def scaled_speedup(ranks, serial, before, parallel):
    """The paper's formula; `before` is what comes before the ranks can begin."""
    return ranks * serial / (before + parallel)


def spread(values, digits=2):
    return [f"{value:.{digits}f}" for value in (min(values), statistics.mean(values), max(values))]


class Costs:
    """What measure.py has found, as seconds for 10 million triangles a rank."""

    def __init__(self, measured):
        self.models, self.factor = measured["models"], 10e6 / measured["triangles"]
        self.mesher = "triangle" if "triangle" in self.models["pipe"] else "driftmesh"

    def serial(self, model, clock="seconds"):
        runs = self.models[model]
        return self.factor * runs["triangle" if self.mesher == "triangle" else "own"][clock]

    def serial_over_own(self, model):
        """How much longer the sequential mesher takes than driftmesh on one core, by processor time."""
        return self.serial(model, "processor") / (self.factor * self.models[model]["own"]["processor"])

    def in_words(self):
        if self.mesher == "driftmesh":
            return "."
        return f", times {self.serial_over_own('pipe'):.2f}: so much longer does {self.mesher} take than driftmesh here."

    def before_ranks(self, model):
        """Decomposition and first triangulation on the paper's cluster."""
        cutting = self.models[model]["cutting"]
        return [published.SLOWNESS * cutting[name] for name in ("decomposition", "triangulation")]

    def real(self, model):
        """{ranks: (decomposition, triangulation, rest)}; only the rest grows with the triangles."""
        found = {int(name.split()[1]): run for name, run in self.models[model].items() if name.startswith("ranks ")}
        return {count: (run["decomposition"], run["triangulation"], self.factor * run["rest"])
                for count, run in found.items()}

    def methods(self, model):
        """{method: what two ranks did}"""
        return {name.removeprefix("method "): run for name, run in self.models[model].items() if name.startswith("method ")}


def table_1(folder, costs):
    table = Table("table-1", "Table I: sequential and parallel time, seconds",
                  ["model", "", "T_s", "T_decomposition", "T_CDT", "T_64", "T_80", "T_144", "efficiency at 64", "at 80",
                   "at 144"],
                  "Simulated on the paper's cluster, with its T_s: what rank 0 does before was measured here, and multiplied by "
                  f"{published.SLOWNESS:.1f}, as a rank there is slower. T_P is refinement to the end; the paper's contains "
                  "reading and broadcasting, too. The last row of a model is the run of 144 ranks with the published speed of "
                  "each and its share of the work, the other two have means of three kinds of ranks.")
    runs = {(run.model, run.ranks): run for run in read_runs(folder / "table-1")}
    for model, paper in published.TABLE_1.items():
        def row(name, decomposition, triangulation, times):
            before = decomposition + triangulation
            efficiency = {n: scaled_speedup(n, paper["serial"], before, t) / n for n, t in times.items()}
            table.add(model, name, paper["serial"], f"{decomposition:.2f}", f"{triangulation:.2f}",
                      *(f"{found[n]:.{digits}f}" if n in found else "" for found, digits in ((times, 1), (efficiency, 2))
                        for n in paper["ranks"]))
        row("published", paper["decomposition"], paper["triangulation"], paper["ranks"])
        ours = {n: runs[model, n] for n in paper["ranks"] if (model, n) in runs}
        row("driftmesh", *costs.before_ranks(model), {n: run.seconds * scale(run) for n, run in ours.items()})
        row("rank by rank", *costs.before_ranks(model), {144: unbalanced(folder, published.MODELS[model]).seconds})
    return table


def table_1_real(costs):
    table = Table("table-1-real", "Table I on real ranks, seconds for 10 million triangles a rank",
                  ["model", "ranks", "T_s", "T_decomposition", "T_CDT", "T_P", "scaled speedup"],
                  f"T_s is the time of {costs.mesher} with the same bounds. Fewer triangles were made (see measured.json), and "
                  "T_s and T_P multiplied accordingly.")
    for model in published.MODELS:
        for count, (decomposition, triangulation, rest) in costs.real(model).items():
            speedup = scaled_speedup(count, costs.serial(model), decomposition + triangulation, rest)
            table.add(model, count, f"{costs.serial(model):.2f}", f"{decomposition:.4f}", f"{triangulation:.4f}",
                      f"{rest:.2f}", f"{speedup:.2f}")
    return table


def table_2(folder):
    table = Table("table-2", "Table II: what 64 ranks spend on computation and communication, seconds",
                  ["model", "", *(f"{kind}: {what}" for kind in ("computation", "communication")
                                  for what in ("min", "mean", "max")), "idle: mean"],
                  "The paper's communication contains the distribution of subdomains.")
    for run in read_runs(folder / "table-2"):
        paper = published.TABLE_2[run.model]
        table.add(run.model, "published", *map(str, paper["computation"]), *map(str, paper["communication"]), "")
        seconds = {name: [scale(run) * s for s in run.spent(kinds)]
                   for name, kinds in (("computing", ["computing"]), ("told", COMMUNICATING), ("idle", ["idle"]))}
        table.add(run.model, "driftmesh", *spread(seconds["computing"]), *spread(seconds["told"], 4),
                  f"{statistics.mean(seconds['idle']):.2f}")
    return table


def table_3(folder):
    spent = [f"{kind}: {what}" for kind in ("computation", "communication") for what in ("min", "mean", "max")]
    table = Table("table-3", "Table III: other methods on 64 ranks, seconds per million triangles of the mesh",
                  ["model", "method", *spent, "idle: mean", "triangles", "points sent", "messages", "time"],
                  "PCDM is the run of Table II, presplit is the same protocol on interfaces that were split beforehand, decoupled "
                  "has no protocol. Messages contain those that detect the end; time is that of all ranks, in seconds. PDR's "
                  "computation contains the start that each rank makes, and what it repeats of others' work.")
    for name, paper in published.TABLE_3.items():
        table.add("pipe", f"published: {name}", *map(str, paper["computation"]), *map(str, paper["communication"]), "", "",
                  "", "", "")
    runs = [("PCDM", run) for run in read_runs(folder / "table-2")]
    runs += [("PDR", run) for run in read_runs(folder / "table-3-pdr")]
    runs += [("presplit" if run.value("run.method") == "coupled" else "decoupled", run)
             for run in read_runs(folder / "table-3")]
    for model in published.MODELS:
        for method, run in runs:
            if run.model != model:
                continue
            factor = scale(run) / (10 * run.ranks)
            computing, telling, idle = ([factor * s for s in run.spent(kinds)]
                                        for kinds in (["computing"], COMMUNICATING, ["idle"]))
            table.add(model, method, *spread(computing, 3), *spread(telling, 7), f"{statistics.mean(idle):.3f}", run.record["mesh"]["triangles"],
                      run.total("splits_sent"), run.record["cluster"]["messages"], f"{run.seconds * scale(run):.2f}")
    return table


def table_3_real(costs):
    table = Table("table-3-real", "Table III on two real ranks",
                  ["model", "method", "time", "computation: max", "idle: mean", "triangles", "points sent", "messages"],
                  "Refinement in seconds, without decomposition and assembly; PDR's time contains its start. A row without "
                  "figures: the decoupled method needed points that no neighbor had.")
    for model in published.MODELS:
        for method, found in costs.methods(model).items():
            if not found:
                table.add(model, method, *[""] * 6)
                continue
            table.add(model, method, *(f"{found[key]:.3f}" for key in ("seconds", "computing", "idle")),
                      *(round(found[key]) for key in ("triangles", "points", "messages")))
    return table


def published_splits(aggregation):
    _, messages, size = published.FIGURE_7[aggregation]
    return (size - published.FIGURE_7_MESSAGE_BYTES * messages) / published.FIGURE_7_POINT_BYTES


def figure_7(folder):
    table = Table("fig-7", "Figure 7: aggregation on 16 ranks, pipe",
                  ["aggregation", *(f"{who}: {what}" for who in ("published", "round-robin", "graph")
                                    for what in ("time", "points sent", "messages"))],
                  "Times relative to aggregation 1. With the mapping round-robin, nearly all neighbors are on other ranks. "
                  "Published numbers of points are derived from those of messages and bytes.")
    runs = {}
    for run in read_runs(folder / "fig-7"):
        runs.setdefault(run.value("mapping.method"), {})[run.value("run.aggregation")] = run
    for aggregation in sorted(runs["graph"]):
        seconds, messages, _ = published.FIGURE_7[aggregation]
        cells = [aggregation, percent(seconds / published.FIGURE_7[1][0] - 1), round(published_splits(aggregation)), messages]
        for mapping in ("round-robin", "graph"):
            run, first = runs[mapping][aggregation], runs[mapping][1]
            cells += [percent(run.seconds / first.seconds - 1), run.total("splits_sent"), run.total("split_messages_sent")]
        table.add(*cells)
    chosen = sorted(runs["graph"])
    lines = {"published": {a: published.FIGURE_7[a][0] / published.FIGURE_7[1][0] for a in chosen}}
    for mapping, found in runs.items():
        lines[mapping] = {a: found[a].seconds / found[1].seconds for a in chosen}
    chart.draw(folder / "fig-7.svg", "Figure 7: time over that at aggregation 1", "aggregation", "relative time", lines)
    return table


def figure_10(folder, costs):
    columns = [f"{model}, {who}" for model in published.MODELS for who in ("published", "driftmesh")]
    table = Table("fig-10", "Figure 10: scaled speedup on the paper's cluster", ["ranks", *columns],
                  "P T_s(W) / (T_decomposition + T_CDT + T_P(W P)), as in Table I.")
    lines = {}
    for model, paper in published.TABLE_1.items():
        before = paper["decomposition"] + paper["triangulation"]
        lines[f"published {model}"] = {n: scaled_speedup(n, paper["serial"], before, seconds)
                                       for n, seconds in published.FIGURE_10[model].items()}
    for run in read_runs(folder / "fig-10"):
        serial, before = published.TABLE_1[run.model]["serial"], sum(costs.before_ranks(run.model))
        before *= float(run.row["cutting_seconds"]) / cutting_of_4000()
        lines.setdefault(run.model, {})[run.ranks] = scaled_speedup(run.ranks, serial, before, run.seconds * scale(run))
    ranks = sorted(lines["pipe"])
    for count in ranks:
        names = [name for model in published.MODELS for name in (f"published {model}", model)]
        table.add(count, *(f"{lines[name][count]:.1f}" for name in names))
    shown = {name: {n: line[n] / n for n in ranks} for name, line in lines.items()}
    chart.draw(folder / "fig-10.svg", "Figure 10: scaled speedup over ranks", "ranks", "efficiency", shown)
    return table


def cutting_of_4000():
    """Seconds that a simulated cluster charges for 4,000 subdomains (docs/experiments.md)."""
    return 0.4e-6 * 4000 * 11.9658


def figure_10_modern(folder, costs):
    table = Table("fig-10-modern", "Figure 10 on a modern cluster: pipe, 7.9 million triangles a second and rank",
                  ["ranks", "T_decomposition", "T_P", "efficiency"],
                  "T_s is the refinement of 10 million triangles by one core of it" + costs.in_words())
    line = {}
    for run in read_runs(folder / "fig-10-modern"):
        per_rank = run.value("bounds.triangles-per-rank")
        factor = 10e6 / per_rank * run.record["cluster"]["speeds"][0] / published.REFERENCE_SPEED
        cutting, seconds = float(run.row["cutting_seconds"]), run.seconds * factor
        serial = 10e6 / published.REFERENCE_SPEED * costs.serial_over_own("pipe")
        line[run.ranks] = scaled_speedup(run.ranks, serial, cutting, seconds) / run.ranks
        table.add(run.ranks, f"{cutting:.3f}", f"{seconds:.3f}", f"{line[run.ranks]:.2f}")
    chart.draw(folder / "fig-10-modern.svg", "Scaled speedup over ranks, modern cluster", "ranks", "efficiency", {"pipe": line})
    return table


def figure_11(folder):
    table = Table("fig-11", "Figure 11: time of 144 ranks by kind, means, seconds",
                  ["model", "ranks", *(f"{kind}: {who}" for kind in ("computing", "sending", "probing")
                                       for who in ("published", "driftmesh"))],
                  "Sending: MPI_Send and MPI_Recv. A rank of the paper that waits probes: its probing is our polling and idle "
                  "time.")
    kinds = {"computing": ["computing"], "sending": ["sending"], "probing": ["polling", "idle"]}
    for run in read_runs(folder / "fig-11"):
        for number, ranks in enumerate(published.FIGURE_11_KINDS):
            cells = []
            for name, parts in kinds.items():
                ours = run.spent(parts, ranks)
                cells += [published.FIGURE_11[run.model][name][number], f"{scale(run) * statistics.mean(ours):.3g}"]
            table.add(run.model, f"{ranks.start} to {ranks.stop - 1}", *cells)
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--update", metavar="ORIGIN")
    options = parser.parse_args()
    folder = options.folder
    costs = Costs(json.loads((folder / "measured.json").read_text()))
    tables = [table_1(folder, costs), table_1_real(costs), table_2(folder), table_3(folder), table_3_real(costs),
              figure_7(folder),
              figure_10(folder, costs), figure_10_modern(folder, costs), figure_11(folder), replayed(folder)]
    for table in tables:
        table.write(folder)
    caution = "Made with --small, where fixed costs prevail: the figures say nothing.\n\n" if options.small else ""
    page.write(folder, caution, tables)
    text = "\n".join(table.markdown() for table in tables)
    (folder / "paper.md").write_text(f"# The paper and driftmesh\n\n{caution}{text}")
    if options.update:
        results.update("scripts/paper.sh", tables[:-1], options.update)  # scripts/balancing.sh has the replay, too


if __name__ == "__main__":
    main()
