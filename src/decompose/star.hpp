#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "decompose/pieces.hpp"
#include "decompose/planar_map.hpp"
#include "decompose/separator_room.hpp"

namespace driftmesh {

/// The walls that meet at a point of the map, its center, or at both ends of a wall that is to become one point: what
/// another place for the center means for angles, for the areas around it, and for the distance to other walls.
/// Coordinates are relative to origin(), the center's present place.
class Star {
 public:
  enum class Freedom : std::uint8_t { kStays, kSlides, kRoams };  ///< without leaving an input segment
  static constexpr std::size_t kMostSpokes = 12;

  /// A wall from the center to its end.
  struct Spoke {
    SideId side = kNone;
    bool separates = false;  ///< not an input segment
    Point end, start;        ///< at present
    /// In the loop left of the wall, the corner after its end; in the right one, the corner before it. The limits are
    /// squared cosines of the angles that are required there.
    Point left, right;
    double left_limit = 0, right_limit = 0;
  };
  /// What lies between spoke k and the next one counterclockwise.
  struct Sector {
    PieceId piece = kNone;  ///< kNone outside the domain
    double swept = 0;       ///< twice the area between the origin and the piece's border at the center, at present
    double limit = 0;       ///< squared cosine of the angle that is required at the center
  };
  /// Lengths.
  struct Room {
    double clearance;  ///< distance wanted between a wall at the center and others (see SeparatorRoom)
    double length;     ///< least length wanted of walls at the center
  };

  /// `angle`: radians, required at separators; what is less already must only not become smaller.
  Star(const PlanarMap& map, const IdVector<SideId, PieceId>& piece_of, double angle);

  /// Reads the star of the point where `side` starts. False if there are too many walls.
  [[nodiscard]] bool read(SideId side);
  /// Reads the star that is left when the wall of `side` shrinks to the point where it starts.
  [[nodiscard]] bool read_without(SideId side);

  [[nodiscard]] Freedom freedom() const { return freedom_; }
  [[nodiscard]] Point origin() const { return origin_; }
  /// If the center slides: the direction of the segment, a unit vector.
  [[nodiscard]] Point along() const { return along_; }
  [[nodiscard]] std::span<const Spoke> spokes() const { return {spokes_.data(), count_}; }
  [[nodiscard]] std::span<const Sector> sectors() const { return {sectors_.data(), count_}; }
  [[nodiscard]] const Spoke& after(std::size_t k) const { return spokes_[k + 1 < count_ ? k + 1 : 0]; }

  /// By how much the area of sector k's piece grows if the center moves to `p`.
  [[nodiscard]] double growth(std::size_t k, const Point& p) const {
    const Point &a = spokes_[k].end, &b = after(k).end;
    return 0.5 * (p.x * (a.y - b.y) - p.y * (a.x - b.x) - sectors_[k].swept);
  }
  /// Whether the center may be at `p`: no angle becomes too small, and no wall comes near another one.
  [[nodiscard]] bool allows(const Point& p, const Room& room);

 private:
  bool read_around(SideId side, SideId merged);
  bool add(SideId side);
  void set_freedom(SideId side);
  void read_spoke(Spoke& spoke);
  void read_sector(std::size_t k);
  void set_limits(Spoke& spoke);
  void set_limit(std::size_t k);
  [[nodiscard]] bool keeps_lengths(const Point& p, double least) const;
  [[nodiscard]] bool keeps_angles(const Point& p) const;
  double set_rooms(const Point& p, double keep);
  [[nodiscard]] bool leaves_room(std::size_t k, const Point& p, const Point& u, const Point& w) const;
  [[nodiscard]] bool stays_clear(std::size_t k, const Point& p, double keep, double reach) const;
  [[nodiscard]] bool is_input(SideId side) const { return map_.wall(side).kind == PlanarMap::Kind::kInput; }
  [[nodiscard]] Point relative(MapVertexId v) const {
    const Point& p = map_.at(v);
    return {p.x - origin_.x, p.y - origin_.y};
  }

  const PlanarMap& map_;
  const IdVector<SideId, PieceId>& piece_of_;
  double limit_;
  Freedom freedom_ = Freedom::kStays;
  Point origin_, along_;
  std::size_t count_ = 0;
  bool has_limits_ = false;  ///< they are set when they are first needed
  std::array<Spoke, kMostSpokes> spokes_;
  std::array<SeparatorRoom, kMostSpokes> rooms_;  // for the spokes that separate, at the place that is being judged
  std::array<Sector, kMostSpokes> sectors_;
};

}  // namespace driftmesh
