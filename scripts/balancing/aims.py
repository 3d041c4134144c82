"""What balancing aims at, and the worst of what the experiments show."""

from experiments import EXPERIMENTS
from groups import groups_of
from table import Table, percent

PLANNERS = ("zoltan", "stealing", "greedy")
BALANCERS = (*PLANNERS, "diffusion")
DETAILS = ["details-30", "details-20", "chesapeake-30", "chesapeake-20"]
# chesapeake.poly is not shipped: with it, if it is there.
AIMED_AT = [name for name in EXPERIMENTS if name != "sciclone-zoltan" and not name.startswith(("published", "chesapeake"))]


def recovered(group):
    value = group.recovered()
    return 0.0 if value is None else value


def over_none(group):
    return group.over_none(lambda run, none: run.seconds / none.seconds - 1)


def over_ideal(group):
    return group.median(lambda run: run.seconds / run.ideal - 1)


def place(group):
    """The experiment, the policy, and what else tells runs apart."""
    others = [value for key, value in group.first.swept.items() if key != "balance.policy"]
    return f"{group.experiment}: {', '.join([group.first.policy, *others])}"


def chosen(folder, names, policies=BALANCERS):
    there = [name for name in names if (folder / name / "table.csv").exists()]
    return [group for group in groups_of(folder, there) if group.first.policy in policies]


def ratios(folder, policies, other, figure):
    """figure(run) of policies on the paper's cluster over that of another one: (ratio, group)"""
    groups = chosen(folder, ["sciclone"])
    base = {group.first.model: group.median(figure) for group in groups if group.first.policy == other}
    return [(group.median(figure) / base[group.first.model], group) for group in groups if group.first.policy in policies]


def aims(folder):
    table = Table("aims", "Aims", ["aim", "limit", "reached", "by"], "The worst case of each aim, by policy and point of the sweep.")

    def least(aim, limit, names, policies):
        value, group = min(((recovered(g), g) for g in chosen(folder, names, policies)), key=lambda pair: pair[0])
        table.add(aim, f"at least {percent(limit)}", percent(value), place(group))

    def most(aim, limit, groups, figure):
        value, group = max(((figure(g), g) for g in groups), key=lambda pair: pair[0])
        table.add(aim, f"at most {percent(limit)}", percent(value), place(group))

    def ratio(aim, limit, found):
        value, group = max(found, key=lambda pair: pair[0])
        table.add(aim, f"at most {limit:g} times", f"{value:.2f} times", place(group))

    least("recovered on 144 ranks by zoltan, stealing, greedy", 0.94, ["sciclone"], PLANNERS)
    least("recovered on 144 ranks by diffusion", 0.75, ["sciclone"], ["diffusion"])
    least("recovered on 1,024 ranks by zoltan, stealing, greedy", 0.90, ["modern-1024"], PLANNERS)
    most("later than without balancing on 4,096 ranks", 0.0, chosen(folder, ["grand-4096"]), over_none)
    slow = [group for group in chosen(folder, ["slow-network"]) if float(group.first.swept["cluster.latency"]) > 0]
    most("beyond the ideal with 10 ms on 32 ranks", 0.10, slow, over_ideal)
    most("later where nothing needs balancing", 0.003, chosen(folder, ["nothing-to-balance"]), over_none)
    most("later where details of the input decide", 0.02, chosen(folder, DETAILS), over_none)
    most("later by diffusion anywhere", 0.0, chosen(folder, [*AIMED_AT, *DETAILS[2:]], ["diffusion"]), over_none)
    ratio("moves of zoltan over those of greedy", 2, ratios(folder, ["zoltan"], "greedy", lambda run: run.moved))
    ratio("points sent by zoltan over those by stealing", 1.1, ratios(folder, ["zoltan"], "stealing", lambda run: run.points_sent))
    runs = [run for group in chosen(folder, AIMED_AT, ["zoltan"]) for run in group.runs]
    plans, kept = (sum(getattr(run, name) for run in runs) for name in ("plans", "plans_kept"))
    table.add("whole plans of zoltan that are kept", "at least 80 %", f"{kept} of {plans}", "all experiments and repetitions")
    return table
