#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "adapt/locator.hpp"
#include "adapt/slopes.hpp"
#include "base/growing_array.hpp"
#include "driftmesh/size_field.hpp"

namespace driftmesh::adapt {

/// One length for each vertex of a triangulation.
using Lengths = GrowingArray<double, VertexId>;

/// A triangle may be this much longer than the least length between its corners and its centroid.
inline constexpr double kBetween = 1.11;

/// Lengths at the vertices of a subdomain's mesh, linear on its triangles: what the next mesh of the subdomain is to
/// have. Between the corners and the centroid of a triangle, 1.11 times the least length counts, as for other fields.
class LinearLengths final : public SizeField {
 public:
  /// Both must outlive it. For one thread at a time.
  LinearLengths(const Triangulation& mesh, const Lengths& lengths);

  [[nodiscard]] double edge_length(const Point& p) const override;
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;
  [[nodiscard]] double least() const override;
  [[nodiscard]] double least_between(const std::array<Point, 3>& triangle, double at_corners) const override;

 private:
  [[nodiscard]] double at(const Locator::Place& place) const;
  [[nodiscard]] bool falls_below_in(TriangleId t, const std::array<Point, 3>& triangle, double limit) const;
  [[nodiscard]] double steepness(TriangleId t) const;
  void look_over() const;

  const Triangulation& mesh_;
  const Lengths& lengths_;
  Locator locator_;

  // Once somebody asks: most subdomains of a generation stay as they are.
  mutable bool looked_over_ = false;
  mutable double least_ = 0;
  mutable Slopes slopes_;

  // Triangles that a search has seen have its number.
  mutable std::vector<std::uint32_t> seen_;
  mutable std::uint32_t search_ = 0;
  mutable std::vector<TriangleId> open_;
};

}  // namespace driftmesh::adapt
