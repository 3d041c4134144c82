// A solver of PETSc that makes its own distributed mesh: Poisson's equation on the unit square, linear elements,
// conjugate gradients. Every rank works on its piece of the mesh; PETSc does the rest by the DMPlex's star forest.
//
//   mpiexec -n 4 poisson_petsc [options of PETSc, such as -ksp_monitor]
//
// The solution is sin(pi x) sin(pi y). The program meshes twice, the second time with a quarter of the area, and
// succeeds if the error decreases as theory predicts: with the square of the edge length, so to about a quarter.

#include <petscksp.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <driftmesh/driftmesh.hpp>
#include <numbers>

#include "to_dmplex.hpp"

namespace {

using driftmesh::DistributedPiece;
using driftmesh::Mesh;
using driftmesh::Point;

double exact(const Point& p) {
  return std::sin(std::numbers::pi * p.x) * std::sin(std::numbers::pi * p.y);
}

driftmesh::Pslg unit_square() {
  driftmesh::Pslg square;
  square.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  square.names.markers[1] = "wall";
  return square;
}

/// One value at each point, which is known on the edges that are called "wall".
PetscErrorCode set_section(DM plex) {
  PetscInt first = 0, end = 0, chart_first = 0, chart_end = 0;
  PetscCall(DMPlexGetDepthStratum(plex, 0, &first, &end));
  PetscCall(DMPlexGetChart(plex, &chart_first, &chart_end));
  DMLabel wall = nullptr;
  PetscCall(DMGetLabel(plex, "wall", &wall));
  PetscCall(DMPlexLabelComplete(plex, wall));  // also the ends of edges, on all ranks that have them
  PetscSection section = nullptr;
  PetscCall(PetscSectionCreate(PetscObjectComm(reinterpret_cast<PetscObject>(plex)), &section));
  PetscCall(PetscSectionSetChart(section, chart_first, chart_end));
  for (PetscInt v = first; v < end; ++v) {
    PetscInt marker = -1;
    PetscCall(DMLabelGetValue(wall, v, &marker));
    PetscCall(PetscSectionSetDof(section, v, 1));
    if (marker == 1) PetscCall(PetscSectionSetConstraintDof(section, v, 1));
  }
  PetscCall(PetscSectionSetUp(section));
  const PetscInt zero = 0;
  for (PetscInt v = first; v < end; ++v) {
    PetscInt known = 0;
    PetscCall(PetscSectionGetConstraintDof(section, v, &known));
    if (known > 0) PetscCall(PetscSectionSetConstraintIndices(section, v, &zero));
  }
  PetscCall(DMSetLocalSection(plex, section));
  PetscCall(PetscSectionDestroy(&section));
  return 0;
}

/// The gradients of the three shape functions of a triangle, times twice its area, which comes last.
std::array<double, 7> gradients(const Point& a, const Point& b, const Point& c) {
  return {b.y - c.y,
          c.x - b.x,
          c.y - a.y,
          a.x - c.x,
          a.y - b.y,
          b.x - a.x,
          (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)};
}

PetscErrorCode assemble(DM plex, const Mesh& mesh, Mat matrix, Vec right) {
  Vec local = nullptr;
  PetscCall(DMGetLocalVector(plex, &local));
  PetscCall(VecZeroEntries(local));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Point, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.points[static_cast<std::size_t>(mesh.triangles[t][i])];
    const auto g = gradients(p[0], p[1], p[2]);
    std::array<PetscScalar, 9> stiffness;
    std::array<PetscScalar, 3> load;
    for (std::size_t i = 0; i < 3; ++i) {
      load[i] = 2 * std::numbers::pi * std::numbers::pi * exact(p[i]) * g[6] / 6;
      for (std::size_t j = 0; j < 3; ++j)
        stiffness[3 * i + j] = (g[2 * i] * g[2 * j] + g[2 * i + 1] * g[2 * j + 1]) / (2 * g[6]);
    }
    const auto cell = static_cast<PetscInt>(t);
    PetscCall(DMPlexMatSetClosure(plex, nullptr, nullptr, matrix, cell, stiffness.data(), ADD_VALUES));
    PetscCall(DMPlexVecSetClosure(plex, nullptr, local, cell, load.data(), ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(VecZeroEntries(right));
  PetscCall(DMLocalToGlobal(plex, local, ADD_VALUES, right));
  PetscCall(DMRestoreLocalVector(plex, &local));
  return 0;
}

/// The error in the norm of L2, by the values at corners.
PetscErrorCode measure(DM plex, const Mesh& mesh, Vec solution, double* error) {
  Vec local = nullptr;
  PetscCall(DMGetLocalVector(plex, &local));
  PetscCall(VecZeroEntries(local));  // known values are 0
  PetscCall(DMGlobalToLocal(plex, solution, INSERT_VALUES, local));
  const PetscScalar* values = nullptr;
  PetscCall(VecGetArrayRead(local, &values));
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    std::array<Point, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.points[static_cast<std::size_t>(t[i])];
    for (std::size_t i = 0; i < 3; ++i)
      sum += std::pow(PetscRealPart(values[t[i]]) - exact(p[i]), 2) * gradients(p[0], p[1], p[2])[6] / 6;
  }
  PetscCall(VecRestoreArrayRead(local, &values));
  PetscCall(DMRestoreLocalVector(plex, &local));
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  *error = std::sqrt(sum);
  return 0;
}

PetscErrorCode solve(double area, double* error) {
  const DistributedPiece piece = driftmesh::mesh_distributed(
      PETSC_COMM_WORLD, unit_square(), {.min_angle = 28, .max_area = area, .subdomains = {.count = 12}});
  DM plex = nullptr;
  PetscCall(driftmesh::petsc::to_dmplex(PETSC_COMM_WORLD, piece, &plex));
  PetscCall(set_section(plex));
  Mat matrix = nullptr;
  Vec right = nullptr, solution = nullptr;
  PetscCall(DMCreateMatrix(plex, &matrix));
  PetscCall(DMCreateGlobalVector(plex, &right));
  PetscCall(VecDuplicate(right, &solution));
  PetscCall(assemble(plex, piece.mesh, matrix, right));
  KSP solver = nullptr;
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &solver));
  PetscCall(KSPSetOperators(solver, matrix, matrix));
  PetscCall(KSPSetType(solver, KSPCG));
  PetscCall(KSPSetTolerances(solver, 1e-10, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(KSPSetFromOptions(solver));
  PetscCall(KSPSolve(solver, right, solution));
  PetscCall(measure(plex, piece.mesh, solution, error));
  PetscCall(KSPDestroy(&solver));
  PetscCall(VecDestroy(&solution));
  PetscCall(VecDestroy(&right));
  PetscCall(MatDestroy(&matrix));
  PetscCall(DMDestroy(&plex));
  return 0;
}

PetscErrorCode compare(bool* as_predicted) {
  double coarse = 0, fine = 0;
  PetscCall(solve(4e-3, &coarse));
  PetscCall(solve(1e-3, &fine));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "errors %.3e and %.3e, ratio %.2f\n", coarse, fine, coarse / fine));
  *as_predicted = fine < 2e-3 && coarse > 3 * fine;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  PetscCall(PetscInitialize(&argc, &argv, nullptr, nullptr));
  bool as_predicted = false;
  PetscCall(compare(&as_predicted));
  PetscCall(PetscFinalize());
  return as_predicted ? 0 : 1;
}
