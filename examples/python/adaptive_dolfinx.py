#!/usr/bin/env python3
"""Adaptive refinement with dolfinx (FEniCSx): a Poisson problem on an L-shaped domain, -div grad u = 1, whose solution has infinite
derivatives at the inner corner.

    adaptive_dolfinx.py [picture]

In each step dolfinx solves, and tells for each triangle how much slopes jump at its edges; sizes that even out the error make the next
mesh. The energy of the exact solution is known to ten digits, so the program can tell the error, and succeeds if it is inversely
proportional to the number of points, as it is for smooth solutions; a uniform mesh does not reach that here.
"""

import sys

import driftmesh
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.mesh import create_mesh, exterior_facet_indices
from mpi4py import MPI
from petsc4py.PETSc import ScalarType

CORNERS = [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)]
DOMAIN = driftmesh.Pslg(CORNERS, [(k, (k + 1) % 6) for k in range(6)])
ENERGY = 0.2140758027  # the integral of u
STEPS = 4


def solve(mesh):
    """The solution, and for each triangle of `mesh` the squared jumps of the slope over its edges, times their squared lengths."""
    element = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.triangle, 1))
    domain = create_mesh(MPI.COMM_SELF, mesh.triangles.astype(np.int64), mesh.points, element)
    space = fem.FunctionSpace(domain, ("Lagrange", 1))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    domain.topology.create_connectivity(1, 2)
    boundary = fem.locate_dofs_topological(space, 1, exterior_facet_indices(domain.topology))
    problem = fem.petsc.LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx, fem.Constant(domain, ScalarType(1)) * v * ufl.dx,
                                      bcs=[fem.dirichletbc(ScalarType(0), boundary, space)],
                                      petsc_options={"ksp_type": "preonly", "pc_type": "lu"})
    solution = problem.solve()
    weight = ufl.TestFunction(fem.FunctionSpace(domain, ("DG", 0)))
    normal, length = ufl.FacetNormal(domain), ufl.FacetArea(domain)
    jumps = fem.petsc.assemble_vector(fem.form(ufl.avg(length) * ufl.jump(ufl.grad(solution), normal)**2 * ufl.avg(weight) * ufl.dS))
    found = np.empty(len(mesh.triangles))
    found[domain.topology.original_cell_index] = jumps.array  # dolfinx puts triangles into an order of its own
    return fem.assemble_scalar(fem.form(solution * ufl.dx)), found


def sizes(mesh, jumps, wanted):
    """Lengths at the points, for about as many triangles as wanted, all with the same share of the error."""
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    density = (jumps / areas**2 + 1e-12) ** (1 / 2)
    area = np.sum(areas * density) / wanted / density
    lengths = np.full(len(mesh.points), np.inf)
    np.minimum.at(lengths, mesh.triangles, np.sqrt(4 / np.sqrt(3) * area)[:, None])
    return driftmesh.size_on_mesh(mesh, lengths, gradation=0.3)


def main():
    mesh = driftmesh.mesh(DOMAIN, max_area=0.01)
    found = []
    for step in range(STEPS):
        energy, jumps = solve(mesh)
        found.append((len(mesh.points), ENERGY - energy))  # the squared error of the slopes
        print(f"{found[-1][0]:8,} points: error {found[-1][1]:.2e}")
        if step + 1 < STEPS:
            mesh = driftmesh.mesh(DOMAIN, min_angle=25, size=sizes(mesh, jumps, 2 * len(mesh.triangles)))
    if len(sys.argv) > 1:
        driftmesh.plot(mesh, sys.argv[1], color="area")
    points, errors = np.log(np.array(found)[1:]).T
    rate = -np.polyfit(points, errors, 1)[0]
    print(f"the error falls with the number of points to the power of -{rate:.2f}")
    return 0 if rate > 0.9 else 1


if __name__ == "__main__":
    sys.exit(main())
