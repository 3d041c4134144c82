#pragma once

#include <vector>

#include "decompose/planar_map.hpp"
#include "decompose/work_samples.hpp"

namespace driftmesh {

/// The border of a piece as a closed sequence of stations, counterclockwise: the corners of its loop, and places
/// between them where a separator may end. Places are only candidates; realize() turns one into a vertex.
struct Outline {
  struct Station {
    Point at;
    SideId side;  ///< starts here, or contains the place
    bool corner;
    /// Unit vectors along the border, forward and backward.
    Point forward, backward;
    /// A separator may leave between these two directions (counterclockwise from first to last), so that it makes at
    /// least the requested angle with the border on both sides.
    Point first, last;
    bool usable;  ///< whether there is such a direction
    bool reflex;  ///< whether the sector from first to last is 180 degrees or more
    /// Cumulative from station 0 to this one: length of the border, and twice the area swept around station 0's point.
    double length, twice_area;
    double crossed_work = 0;  ///< likewise, crossing_work of the border; only if there are samples
  };

  std::vector<Station> stations;
  WorkSamples samples;  ///< of the work inside; empty where work is in proportion to area
  double length = 0;
  double area = 0;
  double spacing = 0;
  double work = 0;  ///< of the samples

  /// Twice the area to the right of the separator from station i to j (i < j): along the border from i to j and back.
  [[nodiscard]] double twice_area_between(std::size_t i, std::size_t j) const;
  /// The fraction of the work there.
  [[nodiscard]] double share_between(std::size_t i, std::size_t j) const;
  /// Whether a separator may leave station i in direction `d`, a vector of any length.
  [[nodiscard]] static bool allows(const Station& s, double dx, double dy) {
    if (s.reflex) return !(s.last.x * dy - s.last.y * dx > 0 && dx * s.first.y - dy * s.first.x > 0);
    return s.first.x * dy - s.first.y * dx >= 0 && dx * s.last.y - dy * s.last.x >= 0;
  }
};

struct PieceSize {
  double area;
  double length;  ///< of the border
};

/// Area and border of the piece left of `side`.
[[nodiscard]] PieceSize measure_piece(const PlanarMap& map, SideId side);

/// Reads the loop of `side`, with places at most `spacing` apart (lengths) on straight walls. Shell pieces offer only
/// their midpoint. `angle`: radians.
void read_outline(const PlanarMap& map, SideId side, double spacing, double angle, Outline& outline);

/// Sets the samples of the work inside (none: work is in proportion to area).
void set_samples(Outline& outline, WorkSamples samples);

/// The side that starts at a station. Splits the wall if the station is a place (or all walls of its shell, so that the
/// midpoints of a cluster stay on common circles).
SideId realize(PlanarMap& map, const Outline::Station& station);

}  // namespace driftmesh
