#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <utility>

#include "io/mesh_file.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"
#include "temporary_folder.hpp"

namespace driftmesh::test {

/// The mesh with the additional arrays of one made in subdomains, as far as the format stores them.
inline Mesh in_subdomains(Mesh mesh, const std::string& extension) {
  if (extension == ".vtu")
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      mesh.numbers.push_back((std::int64_t{1} << 40) - 3 * static_cast<std::int64_t>(v));
  if (extension == ".vtu" || extension == ".msh" || extension == ".h5")
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      mesh.subdomains.push_back(static_cast<std::int32_t>(t * t % 7));
      mesh.ranks.push_back(mesh.subdomains.back() % 3);
    }
  return mesh;
}

/// The mesh with names of its markers and regions, as far as the format stores them, for some of these.
inline Mesh with_names(Mesh mesh, const std::string& extension) {
  if (extension != ".vtu" && extension != ".msh" && extension != ".h5") return mesh;
  constexpr const char* kNames[] = {"inlet",
                                    "a, b (c) = d%",
                                    "<\xC3\x9C"
                                    "berlauf & 'tide'>",
                                    "7",
                                    "x/y",
                                    "marker",
                                    "&lt;"};
  std::size_t next = 0;
  for (const Mesh::Edge& edge : mesh.edges)
    if (next < 5 && edge.marker != 2 && mesh.names.markers.try_emplace(edge.marker, kNames[next]).second) ++next;
  for (const double region : mesh.regions)
    if (next < 7 && mesh.names.regions.try_emplace(region, kNames[next]).second) ++next;
  if (extension != ".msh") mesh.names.markers[-77] = "occurs nowhere";
  return mesh;
}

/// Writes random meshes with and without each of their parts to a file with this extension (".vtu"), and checks that
/// they read back unchanged.
inline void check_random_meshes_read_back(const std::string& extension, const WriteOptions& options = {}) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / ("mesh" + extension);
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    const RandomMeshParts parts{seed % 2 == 0, seed % 3 == 0, seed % 5 != 0, static_cast<std::int32_t>(seed % 4)};
    const RandomMesh random(seed, 1 + static_cast<std::int32_t>(seed % 9), 1 + static_cast<std::int32_t>(seed % 7),
                            parts, seed % 2 == 0 ? 1e-3 : 1e6);
    Mesh mesh = seed % 4 == 1 ? in_subdomains(random.mesh(), extension) : random.mesh();
    if (seed % 4 != 0) mesh = with_names(std::move(mesh), extension);
    write_mesh(mesh, path, options);
    check_same_mesh(read_mesh(path), mesh);
  }
}

/// The same for an empty mesh, and for points without triangles.
inline void check_meshes_without_triangles_read_back(const std::string& extension) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / ("mesh" + extension);
  Mesh mesh;
  write_mesh(mesh, path);
  check_same_mesh(read_mesh(path), mesh);
  mesh.points = {{1, 2}, {3, 4}};
  write_mesh(mesh, path);
  check_same_mesh(read_mesh(path), mesh);
}

}  // namespace driftmesh::test
