#!/usr/bin/env python3
"""A Poisson problem by dolfinx (FEniCSx) on a mesh of driftmesh: -div grad u = 2 pi^2 sin(pi x) sin(pi y) on the unit square, on two meshes.

The solution is known: the program succeeds if the error falls to a quarter when edges get half as long.
"""

import sys

import driftmesh
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.mesh import create_mesh, exterior_facet_indices
from mpi4py import MPI
from petsc4py.PETSc import ScalarType

SQUARE = driftmesh.Pslg([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])


def to_dolfinx(mesh):
    element = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.triangle, 1))
    return create_mesh(MPI.COMM_SELF, mesh.triangles.astype(np.int64), mesh.points, element)


def error_on(mesh):
    domain = to_dolfinx(mesh)
    space = fem.FunctionSpace(domain, ("Lagrange", 1))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    x = ufl.SpatialCoordinate(domain)
    exact = ufl.sin(ufl.pi * x[0]) * ufl.sin(ufl.pi * x[1])
    domain.topology.create_connectivity(1, 2)
    boundary = fem.locate_dofs_topological(space, 1, exterior_facet_indices(domain.topology))
    problem = fem.petsc.LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx, 2 * ufl.pi**2 * exact * v * ufl.dx,
                                      bcs=[fem.dirichletbc(ScalarType(0), boundary, space)])
    difference = problem.solve() - exact
    return np.sqrt(fem.assemble_scalar(fem.form(difference**2 * ufl.dx)))


def main():
    errors = [error_on(driftmesh.mesh(SQUARE, min_angle=28, max_area=area)) for area in (1e-3, 2.5e-4)]
    print(f"errors {errors[0]:.2e} and {errors[1]:.2e}: a factor of {errors[0] / errors[1]:.2f}")
    return 0 if errors[0] / errors[1] > 3 else 1


if __name__ == "__main__":
    sys.exit(main())
