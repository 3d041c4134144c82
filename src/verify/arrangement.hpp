#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "driftmesh/point.hpp"

namespace driftmesh {

/// The faces that a set of straight links and points cuts the plane into, found exactly by a sweep. No
/// triangulation is involved, so what a mesh must cover is known independently of how it was made.
class Arrangement {
 public:
  struct Link {
    std::int32_t a = 0;  ///< index into points
    std::int32_t b = 0;  ///< index into points
  };
  static constexpr std::int32_t kUnbounded = 0;    ///< the face that reaches infinity
  static constexpr std::int32_t kOnBoundary = -1;  ///< a query point lies on a link or an end of one

  /// Links name points that exist; what else may be wrong with points and links is a conflict. `queries` are located in
  /// the arrangement but are not part of it; those outside the range of coordinates are in the unbounded face.
  /// O(n log n).
  Arrangement(std::vector<Point> points, std::vector<Link> links, std::vector<Point> queries = {});

  /// In words, two features that meet where they must not (points in the same place, crossing or overlapping links, a
  /// link through a point), a link without length, or a point outside the range of coordinates, if there are any. If
  /// so, nothing below may be called.
  [[nodiscard]] const std::optional<std::string>& conflict() const { return conflict_; }

  [[nodiscard]] std::int32_t face_count() const { return static_cast<std::int32_t>(loops_of_face_.size()); }
  /// The face on the left of a link as seen from a to b.
  [[nodiscard]] std::int32_t left_face(std::int32_t link) const { return face_of_side_[side(link, false)]; }
  [[nodiscard]] std::int32_t right_face(std::int32_t link) const { return face_of_side_[side(link, true)]; }
  /// The face around a point with no link, kOnBoundary for other points.
  [[nodiscard]] std::int32_t face_of_point(std::int32_t point) const { return face_of_point_[point]; }
  [[nodiscard]] std::int32_t face_of_query(std::size_t query) const { return face_of_query_[query]; }
  /// The number of connected parts of a face's boundary; a point with no link counts as one.
  [[nodiscard]] std::int32_t boundary_parts(std::int32_t face) const { return loops_of_face_[face]; }

  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] const std::vector<Link>& links() const { return links_; }

 private:
  friend class ArrangementSweep;
  // A side of a link is a half-edge: 2 * link for the way a -> b, 2 * link + 1 for b -> a, with the face on its left.
  static std::int32_t side(std::int32_t link, bool reversed) { return 2 * link + (reversed ? 1 : 0); }

  [[nodiscard]] std::int32_t tail(std::int32_t half) const;
  [[nodiscard]] std::span<const std::int32_t> outgoing(std::int32_t point) const;
  void sort_outgoing();
  [[nodiscard]] std::vector<std::int32_t> trace_loops();
  void join_faces(const std::vector<std::int32_t>& below_point, const std::vector<std::int32_t>& below_query);

  std::vector<Point> points_;
  std::vector<Link> links_;
  std::vector<Point> queries_;
  std::optional<std::string> conflict_;
  std::vector<std::int32_t> first_outgoing_;  // per point, into outgoing_
  std::vector<std::int32_t> outgoing_;        // half-edges by their tail, counterclockwise from straight down
  std::vector<std::int32_t> face_of_side_;
  std::vector<std::int32_t> face_of_point_;
  std::vector<std::int32_t> face_of_query_;
  std::vector<std::int32_t> loops_of_face_;
};

}  // namespace driftmesh
