#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"
#include "driftmesh/mesh.hpp"
#include "driftmesh/point.hpp"

namespace driftmesh::testing {

using Place = std::pair<double, double>;

inline std::set<Place> places_of(const Mesh& mesh) {
  std::set<Place> places;
  for (const Point& p : mesh.points) places.emplace(p.x, p.y);
  return places;
}

/// Numbers are 0 .. V - 1 over all pieces, one for each position; ascending in each piece, and with an owner.
inline void check_numbers(const std::vector<DistributedPiece>& pieces) {
  std::map<std::int64_t, Place> place_of_number;
  std::map<Place, std::int64_t> number_of_place;
  std::map<std::int64_t, Rank> owner_of_number;
  std::int64_t triangles = 0;
  for (const DistributedPiece& piece : pieces) {
    const Mesh& mesh = piece.mesh;
    triangles += static_cast<std::int64_t>(mesh.triangles.size());
    REQUIRE(mesh.numbers.size() == mesh.points.size());
    REQUIRE(piece.owners.size() == mesh.points.size());
    CHECK(std::is_sorted(mesh.numbers.begin(), mesh.numbers.end()));
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const Place place{mesh.points[v].x, mesh.points[v].y};
      CHECK(place_of_number.emplace(mesh.numbers[v], place).first->second == place);
      CHECK(number_of_place.emplace(place, mesh.numbers[v]).first->second == mesh.numbers[v]);
      CHECK(owner_of_number.emplace(mesh.numbers[v], piece.owners[v]).first->second == piece.owners[v]);
    }
  }
  const auto count = static_cast<std::int64_t>(place_of_number.size());
  CHECK(place_of_number.begin()->first == 0);
  CHECK(place_of_number.rbegin()->first == count - 1);
  for (const DistributedPiece& piece : pieces) {
    CHECK(piece.total_points == count);
    CHECK(piece.total_triangles == triangles);
  }
}

/// The interface lists match a search by coordinates, and the owner of a shared vertex has it.
inline void check_interfaces(const IdVector<Rank, DistributedPiece>& pieces) {
  IdVector<Rank, std::set<Place>> places;
  for (const DistributedPiece& piece : pieces) places.push_back(places_of(piece.mesh));
  for (const DistributedPiece& piece : pieces) {
    for (std::size_t v = 0; v < piece.mesh.points.size(); ++v)
      CHECK(places[piece.owners[v]].contains({piece.mesh.points[v].x, piece.mesh.points[v].y}));
    std::map<Rank, std::vector<std::int32_t>> expected;
    for (const Rank other : ids_of(pieces)) {
      if (pieces[other].rank == piece.rank) continue;
      for (std::size_t v = 0; v < piece.mesh.points.size(); ++v)
        if (places[other].contains({piece.mesh.points[v].x, piece.mesh.points[v].y}))
          expected[other].push_back(static_cast<std::int32_t>(v));
    }
    std::map<Rank, std::vector<std::int32_t>> actual;
    for (const auto& neighbor : piece.neighbors) actual[neighbor.rank] = neighbor.shared;
    CHECK(actual == expected);
    CHECK(actual.size() == piece.neighbors.size());
  }
}

}  // namespace driftmesh::testing
