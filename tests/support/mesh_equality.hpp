#pragma once

#include <doctest/doctest.h>

#include "driftmesh/mesh.hpp"

namespace driftmesh::test {

/// Checks that two meshes are the same in every array and order.
inline void check_same_mesh(const Mesh& actual, const Mesh& expected) {
  CHECK(actual.points == expected.points);
  CHECK(actual.triangles == expected.triangles);
  CHECK(actual.edges == expected.edges);
  CHECK(actual.point_markers == expected.point_markers);
  CHECK(actual.attributes_per_point == expected.attributes_per_point);
  CHECK(actual.attributes == expected.attributes);
  CHECK(actual.regions == expected.regions);
  CHECK(actual.numbers == expected.numbers);
  CHECK(actual.subdomains == expected.subdomains);
  CHECK(actual.ranks == expected.ranks);
  CHECK(actual.names == expected.names);
  CHECK(actual.attribute_names == expected.attribute_names);
  CHECK(actual.coordinates == expected.coordinates);
  CHECK(actual.weirs == expected.weirs);
}

}  // namespace driftmesh::test
