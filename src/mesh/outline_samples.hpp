#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/pslg.hpp"
#include "mesh/triangulation.hpp"

namespace driftmesh {

/// A segment of the outline of a domain, which lies to the left. Its ends are indices of points.
struct Bank {
  std::int32_t a, b;
  std::int32_t marker;
};

/// Those of a triangulated PSLG.
[[nodiscard]] std::vector<Bank> banks_of(const Triangulation& mesh);

/// The outline of a domain, with more points on it where banks are less than a width apart: those that do not follow
/// each other, or do so at a corner of less than a right angle.
class OutlineSamples {
 public:
  /// `banks`: of the domain, with indices into `points`. Points there are at most `spacing` apart.
  OutlineSamples(std::span<const Point> points, std::vector<Bank> banks, double width, double spacing);

  [[nodiscard]] const std::vector<Bank>& banks() const { return banks_; }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  /// The index of the point before; kNone for one on a bank.
  [[nodiscard]] std::int32_t original(std::int32_t point) const { return point < corners() ? original_[point] : kNone; }
  /// The banks that a point is on.
  [[nodiscard]] std::span<const std::int32_t> banks_at(std::int32_t point) const {
    return point < corners() ? std::span<const std::int32_t>(at_corner_[point])
                             : std::span(of_sample_).subspan(to_index(point - corners()), 1);
  }

  /// Part of a bank between two of the points. Those of a bank follow each other.
  struct Piece {
    std::int32_t from, to;
    std::int32_t bank;
  };
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  /// The domain. Roots have the indices of pieces as markers.
  [[nodiscard]] Triangulation triangulated() const;

 private:
  [[nodiscard]] std::int32_t corners() const { return static_cast<std::int32_t>(original_.size()); }
  template <class Near>
  void add_pieces(std::int32_t bank, std::int32_t from, std::int32_t to, double spacing, const Near& near);

  std::vector<Bank> banks_;
  std::vector<Point> points_;           // corners first
  std::vector<std::int32_t> original_;  // of corners
  std::vector<std::vector<std::int32_t>> at_corner_;
  std::vector<std::int32_t> of_sample_;
  std::vector<Piece> pieces_;
};

}  // namespace driftmesh
