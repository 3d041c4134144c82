#pragma once

#include <vector>

#include "decompose/planar_map.hpp"
#include "decompose/work_samples.hpp"

namespace driftmesh {

/// The sides around a piece, counterclockwise, each with the point where it starts.
struct LoopSide {
  Point at;
  SideId side;
};
using Loop = std::vector<LoopSide>;

/// The border of a piece as a closed sequence of stations, counterclockwise: the corners of its loop, and places
/// between them where a separator may end. Places are only candidates; realize() turns one into a vertex.
struct Outline {
  struct Station {
    Point at;
    SideId side;  ///< starts here, or contains the place
    bool corner;
    bool opposite;  ///< whether this is the end of a separator on the other side of a straight wall
    /// A separator may leave between these two directions (counterclockwise from first to last), so that it makes at
    /// least the requested angle with the border on both sides.
    Point first, last;
    bool usable;  ///< whether there is such a direction
    bool reflex;  ///< whether the sector from first to last is 180 degrees or more
    /// Cumulative from station 0 to this one: length of the border, and twice the area swept around station 0's point.
    double length, twice_area;
    double crossed_work = 0;  ///< likewise, crossing_work of the border; only if there are samples
  };

  Loop loop;
  std::vector<Station> stations;
  WorkSamples samples;  ///< the work inside; empty where work is in proportion to area
  double length = 0;
  double area = 0;
  double spacing = 0;
  double work = 0;  ///< sum of the samples

  /// Twice the area to the right of the separator from one station to a later one: along the border and back.
  [[nodiscard]] double twice_area_between(const Station& a, const Station& b) const {
    const Point& o = stations.front().at;
    const double closing = (b.at.x - o.x) * (a.at.y - o.y) - (b.at.y - o.y) * (a.at.x - o.x);
    return b.twice_area - a.twice_area + closing;
  }
  /// The fraction of the work there, by the samples.
  [[nodiscard]] double sampled_share(const Station& a, const Station& b) const;
  /// Whether a separator may leave station i in direction `d`, a vector of any length.
  [[nodiscard]] static bool allows(const Station& s, double dx, double dy) {
    if (s.reflex) return !(s.last.x * dy - s.last.y * dx > 0 && dx * s.first.y - dy * s.first.x > 0);
    return s.first.x * dy - s.first.y * dx >= 0 && dx * s.last.y - dy * s.last.x >= 0;
  }
};

struct PieceSize {
  double area;
  double length;  ///< length of the border
};

/// Reads the loop of `side`.
void read_loop(const PlanarMap& map, SideId side, Loop& loop);

/// The corners of the loop of `side`.
[[nodiscard]] std::vector<Point> border_of(const PlanarMap& map, SideId side);

[[nodiscard]] double area_inside(const Loop& loop);
[[nodiscard]] PieceSize measure(const Loop& loop);

/// Sets the stations on outline.loop, with places at most `spacing` apart (lengths) on straight walls. Shell pieces
/// offer only their midpoint. `angle`: radians.
void place_stations(const PlanarMap& map, double spacing, double angle, Outline& outline);

/// Sets the samples of the work inside (none: work is in proportion to area).
void set_samples(Outline& outline, WorkSamples samples);

/// The side that starts at a station. Splits the wall if the station is a place (or all walls of its shell, so that the
/// midpoints of a cluster stay on common circles).
SideId realize(PlanarMap& map, const Outline::Station& station);

}  // namespace driftmesh
