"""The runs of experiments by point of the sweep, beside those without balancing."""

import statistics

from runs import read_runs


class Group:
    """The repetitions of a run, each beside the one without balancing, if there is one."""

    def __init__(self, experiment, runs, without):
        self.experiment, self.runs, self.without = experiment, runs, without
        self.first = runs[0]

    def median(self, figure):
        return statistics.median(figure(run) for run in self.runs)

    def over_none(self, figure):
        """The median of figure(run, run without balancing); nothing for the latter itself."""
        if self.first.policy == "none" or not self.without:
            return None
        return statistics.median(figure(run, none) for run, none in zip(self.runs, self.without))

    def recovered(self):
        """Nothing where nothing moved, or where draws alone explain the difference."""
        difference = self.over_none(lambda run, none: abs(none.seconds - run.seconds))
        if not difference or self.median(lambda run: run.moved) == 0:
            return None
        if difference <= half_range(self.runs) + half_range(self.without):
            return None
        return self.over_none(lambda run, none: (none.seconds - run.seconds) / (none.seconds - none.ideal))


def half_range(runs):
    times = [run.seconds for run in runs]
    return (max(times) - min(times)) / 2


def groups_of(folder, names, without=""):
    """The runs of experiments by point of the sweep; `without`: the experiment without balancing, if it is another."""
    for name in names:
        runs = read_runs(folder / name)
        nones = [run for run in (read_runs(folder / without) if without else runs) if run.policy == "none"]
        points = {}
        for run in runs:
            points.setdefault(tuple(run.swept.items()), []).append(run)
        for point, repetitions in points.items():
            yield Group(name, repetitions, [none for none in nones if is_same_but_policy(none.swept, dict(point))])


def is_same_but_policy(none, point):
    return all(point.get(key, value) == value for key, value in none.items() if key != "balance.policy")
