#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/polygon.hpp"
#include "gis/raster_rows.hpp"

namespace driftmesh {

/// A connected part of where a raster is beyond a level.
struct LevelPart {
  std::vector<PolygonRing> rings;  ///< the outer one counterclockwise, then holes clockwise
  double area = 0;                 ///< in the square of the coordinates' unit
};

/// Where the values of a raster are beyond a level, by marching squares (Lorensen and Cline, SIGGRAPH 1987) on the
/// squares between four of its points. Memory is needed for the outline alone.
/// - A point is inside if its value is beyond the level, not equal to it. One without a value (NaN) is outside.
/// - Between an inner and an outer neighbor the outline passes where the linear interpolant has the level, or halfway
///   if the outer one has no value. Within 1/16 of a spacing from a point it passes through the point, so that no edge
///   is shorter than that.
/// - Inner points that face each other across a square are connected if the bilinear interpolant is beyond the level
///   at its saddle.
/// - The rectangle of the outermost points closes it. Along a side, at least every 64th point of the raster is kept.
/// Rings are simple: no two edges have more than an end in common, and none occurs twice. They may touch in points.
class LevelOutline {
 public:
  static constexpr double kSnap = 1.0 / 16;

  /// `below`: it is the values below the level that are inside, not those above.
  LevelOutline(const RasterFrame& frame, double level, bool below);

  /// To be called for each row of the raster, from the uppermost to row 0.
  void add_row(std::span<const float> values);
  /// After the last row: all parts in the order of their areas, the largest first.
  [[nodiscard]] std::vector<LevelPart> parts();

 private:
  using PointId = std::uint64_t;  ///< names a point of the raster, or one between two of them
  struct Vertex {
    PointId id;
    Point at;
    bool is_shared = false;  ///< whether rings touch here
  };
  /// The inside is on the left.
  struct Edge {
    Vertex from;
    PointId to;
    std::int32_t part;
  };
  struct Loop;
  struct Square;

  [[nodiscard]] PointId id_of(std::int64_t i, std::int64_t j) const;
  [[nodiscard]] Vertex point(std::int64_t i, std::int64_t j) const;
  [[nodiscard]] Vertex crossing(std::int64_t i, std::int64_t j, bool upward, double here, double next) const;
  void add_square(std::int64_t i, std::int64_t j);
  void connect(const Square& square, std::int64_t i, std::int64_t j);
  void add_edges(const Square& square, std::int64_t i, std::int64_t j);
  [[nodiscard]] std::vector<Edge> edges_of_parts();
  [[nodiscard]] std::vector<Loop> loops_of(const std::vector<Edge>& edges) const;
  [[nodiscard]] PolygonRing without_points_on_sides(const std::vector<Vertex>& vertices) const;

  RasterFrame frame_;
  double level_;
  double sign_;
  std::int64_t row_;                   // the next one that is read
  std::vector<double> upper_, lower_;  // how far values are beyond the level; none: minus infinity
  // Parts of the squares above and of those at hand, two each: of a square with two separate parts the one with the
  // lower corner, then the one with the upper corner. -1: none.
  std::vector<std::int32_t> above_, here_;
  std::int32_t count_ = 0;  // parts, some of which turn out to be one
  std::vector<std::pair<std::int32_t, std::int32_t>> same_;
  std::vector<Edge> edges_;
};

}  // namespace driftmesh
