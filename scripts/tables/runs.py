"""The runs of an experiment, as driftmesh run has written them."""

import csv
import json


class Run:
    """A row of table.csv, with its record."""

    def __init__(self, folder, row):
        self.row = row
        self.record = json.loads((folder / f"{row['run']}.json").read_text())
        columns = list(row)
        self.swept = {key: row[key] for key in columns[1:columns.index("repetition")]}
        self.model = self.value("input.generate")
        self.policy = self.value("balance.policy")
        self.ranks = int(row["ranks"])
        self.seconds, self.ideal = float(row["seconds"]), float(row["ideal_seconds"])
        self.moved, self.points_sent = int(row["hand_offs"]), int(row["splits"])
        self.plans, self.plans_kept = int(row["whole_plans"]), int(row["whole_plans_kept"])

    def value(self, key):
        return self.record["request"][key]

    def total(self, key):
        return sum(rank[key] for rank in self.record["parts"]["ranks"])

    def spent(self, kinds, ranks=None):
        """Seconds of each rank on any of these kinds of work."""
        of_all = self.record["parts"]["ranks"]
        chosen = of_all if ranks is None else [of_all[i] for i in ranks if i < len(of_all)]
        return [sum(rank["seconds"][kind] for kind in kinds) for rank in chosen]


def read_runs(folder):
    with open(folder / "table.csv", newline="") as file:
        return [Run(folder, row) for row in csv.DictReader(file)]
