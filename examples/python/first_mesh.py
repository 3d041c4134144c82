#!/usr/bin/env python3
"""A mesh and its picture."""

import driftmesh

bay = driftmesh.generate("bay", seed=7, resolution=300)
mesh = driftmesh.mesh(bay, min_angle=25, max_area=50_000)
print(mesh)
print(driftmesh.check(mesh, bay, min_angle=25, max_area=50_000).verdict)
mesh.write("bay.vtu")
driftmesh.plot(mesh, "bay.png", color="area")
