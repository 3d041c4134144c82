"""The tables of balancing, each made of the runs of some experiments."""

from typing import Callable, NamedTuple

from aims import AIMED_AT, aims
from experiments import EXPERIMENTS
from groups import groups_of, half_range
from replay import beside_published, replayed
from runs import read_runs
from table import Table, percent


def seconds(value):
    return f"{value:#.4g}".rstrip(".")


def percent_if_any(value):
    return "" if value is None else percent(value)


def spread(group):
    """Half of the range, as a fraction of the median."""
    return half_range(group.runs) / group.median(lambda run: run.seconds)


def plans_kept(group):
    plans = sum(run.plans for run in group.runs)
    return f"{sum(run.plans_kept for run in group.runs)} of {plans}" if plans else ""


FIGURES = {
    "seconds": lambda group: seconds(group.median(lambda run: run.seconds)),
    "spread": lambda group: percent(spread(group)),
    "ideal": lambda group: seconds(group.median(lambda run: run.ideal)),
    "over ideal": lambda group: percent(group.median(lambda run: run.seconds / run.ideal - 1)),
    "over none": lambda group: percent_if_any(group.over_none(lambda run, none: run.seconds / none.seconds - 1)),
    "recovered": lambda group: percent_if_any(group.recovered()),
    "regret": lambda group: percent(group.median(lambda run: float(run.row["regret"]))),
    "moved": lambda group: round(group.median(lambda run: run.moved)),
    "points sent": lambda group: round(group.median(lambda run: run.points_sent)),
    "plans kept": plans_kept,
}


def swept(key):
    """What tells rows apart: a key of the sweep."""
    def text(run):
        value = run.swept[key]
        return f"{float(value):,.0f}" if value.replace(".", "").isdigit() and float(value) >= 1000 else value
    return text


def policy(run):
    return run.policy


def latency(run):
    return f"{1e3 * float(run.swept['cluster.latency']):g} ms"


def bounds(run):
    triangles = run.value("bounds.triangles")
    return f"{run.value('bounds.angle'):g} degrees, {'no bound' if not triangles else 'about 50,000'}"


class Comparison(NamedTuple):
    """A row for each point of a sweep."""
    title: str
    experiments: list
    by: dict          # {column: what tells rows apart, from a run}
    figures: list     # of FIGURES
    notes: str = ""
    without: str = ""

    @property
    def keys(self):
        return len(self.by)

    def make(self, name, folder):
        files = sorted({f"configs/{EXPERIMENTS[name].file}.yaml" for name in self.experiments})
        table = Table(name, self.title, [*self.by, *self.figures], f"{self.notes}From {', '.join(files)}.")
        for group in groups_of(folder, self.experiments, self.without):
            table.add(*(text(group.first) for text in self.by.values()), *(FIGURES[figure](group) for figure in self.figures))
        return table


class Special(NamedTuple):
    """A table that something else makes."""
    experiments: list
    keys: int          # columns that tell rows apart
    maker: Callable    # from the folder of results

    def make(self, _, folder):
        return self.maker(folder)


def costs(folder):
    """What each experiment took. This one is measured; it depends on the machine."""
    table = Table("costs", "What the tables take", ["experiment", "runs", "triangles, at most", "processor time, s"],
                  "User and system time of one core, all runs together.")
    whole = 0
    for name in EXPERIMENTS:
        if not (folder / name / "table.csv").exists():
            continue
        runs, took = read_runs(folder / name), sum(map(float, (folder / f"{name}.seconds").read_text().split()[-2:]))
        table.add(name, len(runs), max(int(run.row["triangles"]) for run in runs), f"{took:.1f}")
        whole += took
    table.add("all", sum(row_count(row) for row in table.rows), "", f"{whole:.1f}")
    return table


def row_count(row):
    return int(row[1].replace(",", ""))


ONE = ["seconds", "ideal", "recovered", "regret", "moved"]
PLANS = [*ONE, "points sent", "plans kept"]
DRAWS = ["seconds", "spread", "ideal", "recovered", "regret", "moved"]
BY_POLICY = {"policy": policy}
SCICLONE = "144 ranks of three speeds on 100 Mb/s Ethernet"
START = {"start": swept("mapping.method")}
HARM = ["seconds", "ideal", "over ideal", "over none", "moved"]

DETAILS = "Four equal ranks with 50 subdomains each; details of the outline, not a bound on area, say how many triangles there are. "

TABLES = {
    "sciclone": Comparison(SCICLONE, ["sciclone"], {"domain": swept("input.generate"), **BY_POLICY}, PLANS,
                           "The cluster of the paper; each rank starts with the same work, in 28 subdomains. "),
    "sciclone-zoltan": Comparison(f"{SCICLONE}: ways to call Zoltan", ["sciclone-zoltan"],
                                  {"domain": swept("input.generate"), "method": swept("balance.parameters.zoltan.method")}, PLANS,
                                  "The policy is zoltan in all rows. ", without="sciclone"),
    "modern-1024": Comparison("1,024 ranks of four speeds", ["modern-1024"], BY_POLICY, ONE,
                              "20,480 subdomains; zoltan by the method rcb. "),
    "grand-4096": Comparison("4,096 ranks of four speeds", ["grand-4096"], BY_POLICY, ONE,
                             "81,920 subdomains; zoltan by the method rcb. Takes 3.5 minutes and 4.3 GB, half of it for the mesh. "),
    "policies": Comparison("16 ranks of three speeds", ["policies"],
                           {"skew": swept("decomposition.skew"), **START, **BY_POLICY}, DRAWS,
                           "With even and with deliberately uneven subdomains (skew), and with short borders between ranks (graph) and the "
                           "longest (round-robin). "),
    "two-speeds": Comparison("8 ranks of two speeds", ["two-speeds"], BY_POLICY, DRAWS, "Half of the ranks are twice as fast. "),
    "ten-to-one": Comparison("16 ranks, half of them ten times as fast", ["ten-to-one"], BY_POLICY, DRAWS,
                             "20 subdomains a rank, of which a slow one should make three or four. "),
    "changing-speeds": Comparison("8 ranks whose speeds change", ["changing-speeds"], BY_POLICY, DRAWS,
                                  "Two lose three quarters of their speed, and two join after a sixth of the time. "),
    "late-hosts": Comparison("16 ranks, 4 of which come late", ["late-hosts"], BY_POLICY, DRAWS,
                             "No work is mapped to the four, which share a host. "),
    "short-memory": Comparison("8 ranks with little memory", ["short-memory"],
                               {"memory, triangles": swept("cluster.memory"), **BY_POLICY}, DRAWS,
                               "Two ranks are four times as fast, but have memory for less than their share (0: no limit). With 500,000 and "
                               "390,000 triangles, 3.6 and 4.3 s are the best that is possible. "),
    "wrong-forecasts": Comparison("16 ranks with wrong forecasts", ["wrong-forecasts"],
                                  {"off by up to": swept("decomposition.forecast-error"), **BY_POLICY}, DRAWS,
                                  "Forecasts are off by random factors until work on a subdomain begins, and the mapping follows them. "),
    "slow-network": Comparison("32 ranks on a slow network", ["slow-network"], {"latency": latency, **BY_POLICY},
                               ["seconds", "spread", "ideal", "over ideal", "regret", "moved"], "All ranks are equal. "),
    "nothing-to-balance": Comparison("16 equal ranks with equal work", ["nothing-to-balance"], {**START, **BY_POLICY}, HARM,
                                     "20 subdomains a rank. "),
    "details": Comparison("Details decide: the generated bay", ["details-30", "details-20"],
                          {"bounds": bounds, **START, **BY_POLICY}, HARM, DETAILS),
    "chesapeake": Comparison("Details decide: chesapeake.poly", ["chesapeake-30", "chesapeake-20"],
                             {"bounds": bounds, **START, **BY_POLICY}, HARM,
                             f"{DETAILS}The domain was published with TOMS Algorithm 872; --inputs says where it is. "),
    "published": Special(["published-pipe", "published-flow", "published-chesapeake"], 1, beside_published),
    "aims": Special(AIMED_AT, 1, aims),
    "replay": Special(["published-pipe", "published-flow", "published-chesapeake"], 2, replayed),
    "costs": Special(list(EXPERIMENTS), 1, costs),
}
