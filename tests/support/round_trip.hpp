#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <utility>

#include "io/mesh_file.hpp"
#include "support/mesh_equality.hpp"
#include "support/random_mesh.hpp"

namespace driftmesh::test {

/// The mesh with the additional arrays of one made in subdomains, as far as they are in `keeps`.
inline Mesh in_subdomains(Mesh mesh, MeshParts keeps) {
  if ((keeps & kSubdomains) != 0)
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      mesh.subdomains.push_back(static_cast<std::int32_t>(t * t % 7));
      mesh.ranks.push_back(mesh.subdomains.back() % 3);
    }
  return mesh;
}

/// The mesh with names of its attributes and of some of its markers and regions, and a projection, as far as names are
/// in `keeps`.
inline Mesh with_names(Mesh mesh, MeshParts keeps) {
  if ((keeps & kNamedParts) != kNamedParts) return mesh;
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
  for (std::int32_t k = 0; k < mesh.attributes_per_point; ++k)
    mesh.attribute_names.push_back(k == 0 ? "depth" : "<b> & " + std::to_string(k));
  mesh.coordinates = "UTM zone 33S from lonlat";
  return mesh;
}

/// Writes random meshes with and without each of their parts that are in `keeps`, and checks that they read back
/// unchanged.
inline void check_random_meshes_read_back(const std::string& path, MeshParts keeps, const WriteOptions& options = {}) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    const RandomMeshParts parts{seed % 2 == 0, seed % 3 == 0, seed % 5 != 0, static_cast<std::int32_t>(seed % 4)};
    const RandomMesh random(seed, 1 + static_cast<std::int32_t>(seed % 9), 1 + static_cast<std::int32_t>(seed % 7),
                            parts, seed % 2 == 0 ? 1e-3 : 1e6);
    Mesh mesh = seed % 4 == 1 ? in_subdomains(random.mesh(), keeps) : random.mesh();
    if (seed % 4 != 0) mesh = with_names(std::move(mesh), keeps);
    write_mesh(mesh, path, options);
    check_same_mesh(read_mesh(path), mesh);
  }
}

/// The same for an empty mesh, and for points without triangles.
inline void check_meshes_without_triangles_read_back(const std::string& path) {
  Mesh mesh;
  write_mesh(mesh, path);
  check_same_mesh(read_mesh(path), mesh);
  mesh.points = {{1, 2}, {3, 4}};
  write_mesh(mesh, path);
  check_same_mesh(read_mesh(path), mesh);
}

}  // namespace driftmesh::test
