"""The published runs on 144 ranks, rank by rank (configs/published-*.yaml): without balancing, and with it."""

import statistics

import published
from runs import read_runs
from table import Table, percent


def unbalanced(folder, name):
    """The published run of 144 ranks, each with its speed and share of the work, without balancing."""
    return next(run for run in read_runs(folder / f"published-{name}") if run.policy == "none")


def replayed(folder):
    table = Table("replay", "The published runs on 144 ranks with a balancer",
                  ["run", "policy", "seconds", "recovered of what balance could save", "of the whole published time", "possible",
                   "subdomains moved"],
                  "Each rank has its published speed and share of the work; policies find out speeds during the run, "
                  "and planning is charged.")
    for model, name in published.MODELS.items():
        runs = read_runs(folder / f"published-{name}")
        none = unbalanced(folder, name)
        whole = published.FIGURE_10[model][144]
        actual, _ = published.REFINEMENT_144[model]
        for run in runs:
            saved = (none.seconds - run.seconds) / none.seconds * actual / whole
            table.add(name, run.policy, f"{run.seconds:.1f}", percent(float(run.row["recovered"] or 0)), percent(saved),
                      percent(published.COULD_SAVE[model]), run.moved)
    return table


def beside_published(folder):
    table = Table("published", "Simulated ranks beside the published ones, without balancing",
                  ["run", "published, s", "simulated, s", "last over mean: published", "simulated"],
                  "Seconds of refinement, and those that the last rank computed over the mean of all.")
    for model, name in published.MODELS.items():
        run = unbalanced(folder, name)
        computing = run.spent(["computing"])
        table.add(name, f"{published.REFINEMENT_144[model][0]:.1f}", f"{run.seconds:.1f}", f"{published.LAST_OVER_MEAN[model]:.2f}",
                  f"{max(computing) / statistics.mean(computing):.2f}")
    return table
