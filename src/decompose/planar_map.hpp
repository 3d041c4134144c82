#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "driftmesh/id_vector.hpp"
#include "driftmesh/point.hpp"
#include "mesh/handles.hpp"

namespace driftmesh {

/// A point of a planar map: the start of some of its walls.
enum class MapVertexId : std::int32_t {};
/// One side of a wall: the half-edge h and its twin h ^ 1 run along the same wall in opposite directions.
enum class SideId : std::int32_t {};
enum class WallId : std::int32_t {};

/// The walls of a domain (its segments, and the separators made so far) as half-edges. Each side in the domain belongs
/// to a loop with a piece of the domain on its left; a piece whose border is connected has one loop. A wall can have
/// the same piece on both sides.
class PlanarMap {
 public:
  enum class Kind : std::uint8_t { kInput, kBridge, kSeparator };
  struct Wall {
    std::int32_t marker = 0;
    std::int32_t shell = kNone;
    Kind kind = Kind::kInput;
  };
  struct Side {
    MapVertexId origin = kNone;
    SideId next = kNone;  ///< along the loop; kNone outside the domain
    SideId previous = kNone;
    std::uint16_t region = 0;
    [[nodiscard]] bool in_domain() const { return next != kNone; }
  };

  IdVector<MapVertexId, Point> points;
  IdVector<MapVertexId, VertexOrigin> origin;  ///< for each point, the index of an input point, shell end, or kNone
  IdVector<WallId, Wall> walls;
  IdVector<SideId, Side> sides;  ///< two for each wall
  bool whole_segments = false;   ///< no separator may end inside an input segment

  static constexpr SideId twin(SideId h) { return SideId{to_int(h) ^ 1}; }
  /// Whether `h` has the direction of its wall.
  static constexpr bool is_first(SideId h) { return (to_int(h) & 1) == 0; }
  static constexpr SideId first_side(WallId w) { return SideId{2 * to_int(w)}; }
  static constexpr WallId wall_of(SideId h) { return WallId{to_int(h) / 2}; }
  [[nodiscard]] Side& side(SideId h) { return sides[h]; }
  [[nodiscard]] const Side& side(SideId h) const { return sides[h]; }
  [[nodiscard]] Wall& wall(SideId h) { return walls[wall_of(h)]; }
  [[nodiscard]] const Wall& wall(SideId h) const { return walls[wall_of(h)]; }
  [[nodiscard]] MapVertexId start(SideId h) const { return side(h).origin; }
  [[nodiscard]] MapVertexId end(SideId h) const { return side(twin(h)).origin; }
  [[nodiscard]] const Point& at(MapVertexId v) const { return points[v]; }

  MapVertexId add_point(const Point& p, VertexOrigin what);
  /// Adds a wall with sides a -> b and b -> a, not linked to anything. Returns the first side.
  SideId add_wall(MapVertexId a, MapVertexId b, const Wall& wall);
  void link(SideId first, SideId second);
  /// Cuts the wall of `h` at point `m`. `h` keeps the part before m; returns the part after it.
  SideId split(SideId h, MapVertexId m);
  /// Connects the corners where `u` and `v` start by a wall. If they are on the same loop, it becomes two loops, each
  /// with one side of the new wall; two loops become one. Returns the side from u's corner to v's, which now precedes
  /// v.
  SideId connect(SideId u, SideId v, Kind kind);
  /// Shrinks the wall of `h`, with the domain on both sides, to the point where `h` starts. Nothing is at
  /// its other end from then on but the wall itself, which is in no loop.
  void contract(SideId h);
};

}  // namespace driftmesh
