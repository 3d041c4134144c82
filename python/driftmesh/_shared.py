"""What the adapters for solvers have in common: who has which point, and tags as whole numbers. All calls are collective."""

import numpy as np


def exchange(communicator, messages):
    """Sends each neighbor an array and returns, by rank, those of the neighbors, which have the same shape."""
    received = {rank: np.empty_like(values) for rank, values in messages.items()}
    requests = [communicator.Irecv(received[rank], source=rank) for rank in messages]
    requests += [communicator.Isend(values, dest=rank) for rank, values in messages.items()]
    for request in requests:
        request.Wait()
    return received


def told_by_owners(communicator, piece, values):
    """The values that the owners of points have for them, by point. Each rank knows those of its own points."""
    known = values.copy()
    for rank, theirs in exchange(communicator, {r: values[shared] for r, shared in piece.neighbors.items()}).items():
        shared = piece.neighbors[rank]
        owned = piece.owners[shared] == rank
        known[shared[owned]] = theirs[owned]
    return known


def region_tags(communicator, piece):
    """The region of each triangle as a tag; empty if the mesh has no regions. Solvers want whole numbers."""
    tags = piece.mesh.regions.astype(np.int32)
    if communicator.allreduce(int((tags != piece.mesh.regions).sum())):
        raise ValueError("the attributes of regions are not all whole numbers, which tags must be: "
                         "number the regions in the input")
    return tags
