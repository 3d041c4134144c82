#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <string>

#include "output/mesh_file.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

namespace driftmesh::test {

/// Writes random meshes with and without each of their parts to a file with this extension (".vtu"), and checks that
/// they read back as they were.
inline void check_random_meshes_read_back(const std::string& extension) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / ("mesh" + extension);
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    const RandomMeshParts parts{seed % 2 == 0, seed % 3 == 0, seed % 5 != 0, static_cast<std::int32_t>(seed % 4)};
    const RandomMesh random(seed, 1 + static_cast<std::int32_t>(seed % 9), 1 + static_cast<std::int32_t>(seed % 7),
                            parts, seed % 2 == 0 ? 1e-3 : 1e6);
    write_mesh(random.mesh(), path);
    check_same_mesh(read_mesh(path), random.mesh());
  }
}

/// The same for a mesh of nothing, and for points without triangles.
inline void check_meshes_without_triangles_read_back(const std::string& extension) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / ("mesh" + extension);
  MeshPiece mesh;
  write_mesh(mesh, path);
  check_same_mesh(read_mesh(path), mesh);
  mesh.points = {{1, 2}, {3, 4}};
  write_mesh(mesh, path);
  check_same_mesh(read_mesh(path), mesh);
}

}  // namespace driftmesh::test
