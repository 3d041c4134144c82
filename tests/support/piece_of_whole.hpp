#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "driftmesh/adaptive.hpp"
#include "driftmesh/distributed_piece.hpp"
#include "driftmesh/mesh.hpp"

namespace driftmesh::testing {

/// Where a rank's piece is in the whole mesh, as one process makes it: its points are in the order of their numbers,
/// its triangles in that of their subdomains.
class PieceOfWhole {
 public:
  PieceOfWhole(const DistributedPiece& piece, const Mesh& whole) : piece_(piece), whole_(whole) {
    std::map<std::int32_t, std::int64_t> first_here, first_of_whole;
    for (std::size_t t = piece.mesh.triangles.size(); t-- > 0;)
      first_here[piece.mesh.subdomains[t]] = static_cast<std::int64_t>(t);
    for (std::size_t t = whole.triangles.size(); t-- > 0;)
      first_of_whole[whole.subdomains[t]] = static_cast<std::int64_t>(t);
    for (std::size_t t = 0; t < piece.mesh.triangles.size(); ++t) {
      const std::int32_t s = piece.mesh.subdomains[t];
      triangles_.push_back(first_of_whole.at(s) + static_cast<std::int64_t>(t) - first_here.at(s));
    }
  }

  [[nodiscard]] std::int64_t point(std::size_t i) const { return piece_.mesh.numbers[i]; }
  [[nodiscard]] std::int64_t triangle(std::size_t t) const { return triangles_[t]; }

  /// The number of points and triangles that are not as in the whole mesh.
  [[nodiscard]] std::size_t differences() const {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < piece_.mesh.points.size(); ++i)
      wrong += !(piece_.mesh.points[i] == whole_.points.at(static_cast<std::size_t>(point(i))));
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        wrong += point(static_cast<std::size_t>(piece_.mesh.triangles[t][i])) !=
                 whole_.triangles.at(static_cast<std::size_t>(triangles_[t]))[i];
    return wrong;
  }

  /// What a field of the whole mesh has on the piece.
  [[nodiscard]] std::vector<double> part_of(std::span<const double> values, FieldPlace place) const {
    const bool at_points = place == FieldPlace::kPoints;
    const std::size_t all = at_points ? whole_.points.size() : whole_.triangles.size();
    const std::size_t each = values.size() / all;
    std::vector<double> part;
    const std::size_t here = at_points ? piece_.mesh.points.size() : triangles_.size();
    for (std::size_t i = 0; i < here; ++i) {
      const auto from = static_cast<std::size_t>(at_points ? point(i) : triangle(i));
      part.insert(part.end(), values.begin() + static_cast<std::ptrdiff_t>(from * each),
                  values.begin() + static_cast<std::ptrdiff_t>((from + 1) * each));
    }
    return part;
  }

 private:
  const DistributedPiece& piece_;
  const Mesh& whole_;
  std::vector<std::int64_t> triangles_;
};

}  // namespace driftmesh::testing
