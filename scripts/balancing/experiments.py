"""The experiments behind the tables of balancing: a file of configs/, and settings."""

from typing import NamedTuple


class Experiment(NamedTuple):
    file: str              # below configs, without .yaml
    small: list            # settings that make it tiny: the same points of the sweep, of fewer ranks and triangles
    settings: list = []
    input: str = ""        # a file that is not shipped, from the folder --inputs

    def all_settings(self, small, inputs):
        """None if a file is missing."""
        settings = ["report=false", *self.settings]
        if small:
            return [*settings, *self.small]
        if not self.input:
            return settings
        if inputs is None or not (inputs / self.input).is_file():
            return None
        return [*settings, 'input.generate=""', f"input.file={inputs / self.input}"]


def groups(*speeds):
    """Two ranks of each speed."""
    return "cluster.groups=[" + ", ".join(f"{{name: g{i}, ranks: 2, speed: {speed}}}" for i, speed in enumerate(speeds)) + "]"


FEW = ["bounds.triangles-per-rank=500", "decomposition.subdomains=200"]
SHORT = ["bounds.triangles=2e4", "decomposition.subdomains-per-rank=8", "repetitions=2"]
COARSE_BAY = "input.parameters.resolution=1000"
DETAILS = ["decomposition.subdomains-per-rank=10", COARSE_BAY]
COARSE = ["bounds.angle=20", "bounds.triangles=50e3"]

# The longest first: two run at a time.
EXPERIMENTS = {
    "grand-4096": Experiment("grand-4096", [groups("9.5e3", "7e3", "4.5e3", "5.5e3"), "bounds.triangles-per-rank=1e3", COARSE_BAY]),
    "modern-1024": Experiment("modern-1024", [groups("38e3", "28e3", "18e3", "22e3"), "bounds.triangles-per-rank=1e3", COARSE_BAY]),
    "sciclone": Experiment("sciclone-144", FEW),
    "sciclone-zoltan": Experiment("sciclone-144", FEW, ["balance.policy=zoltan", "balance.parameters.zoltan.method=[graph, rcb]"]),
    "published-pipe": Experiment("published-pipe", FEW),
    "published-flow": Experiment("published-flow", FEW),
    "published-chesapeake": Experiment("published-chesapeake", FEW),
    "policies": Experiment("policies", [groups("8e6", "4e6", "2e6"), "bounds.triangles-per-rank=2e3", "repetitions=2"]),
    "wrong-forecasts": Experiment("wrong-forecasts", [*SHORT, "cluster.ranks=4"]),
    "short-memory": Experiment("short-memory", SHORT),
    "two-speeds": Experiment("two-speeds", [groups("8e6", "4e6"), "bounds.triangles-per-rank=5e3", "repetitions=2"]),
    "changing-speeds": Experiment("changing-speeds", SHORT),
    "late-hosts": Experiment("late-hosts", SHORT),
    "ten-to-one": Experiment("balancing/ten-to-one", [groups("8e6", "8e5"), "bounds.triangles-per-rank=2e3", "repetitions=2"]),
    "slow-network": Experiment("balancing/slow-network", ["cluster.ranks=4", "bounds.triangles=2e4", "repetitions=2"]),
    "nothing-to-balance": Experiment("balancing/nothing-to-balance", ["cluster.ranks=4", "bounds.triangles-per-rank=2e3"]),
    "details-30": Experiment("balancing/details", DETAILS),
    "details-20": Experiment("balancing/details", [*DETAILS, "bounds.triangles=5e3"], COARSE),
    "chesapeake-30": Experiment("balancing/details", DETAILS, input="chesapeake.poly"),
    "chesapeake-20": Experiment("balancing/details", [*DETAILS, "bounds.triangles=5e3"], COARSE, input="chesapeake.poly"),
}
