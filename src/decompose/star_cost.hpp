#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "decompose/pieces.hpp"
#include "decompose/star.hpp"

namespace driftmesh {

/// The pieces by subdomain: each one's work relative to the mean, and its size, the square root of its area.
struct Loads {
  Loads(const IdVector<PieceId, Piece>& pieces, const IdVector<PieceId, SubdomainId>& group_of,
        std::int32_t subdomains);

  const IdVector<PieceId, SubdomainId>& group_of;
  IdVector<SubdomainId, double> load, size;
  double mean = 0;  ///< work
};

/// What places for a star's center cost: the length of its separators, and what uneven loads are worth in length.
class StarCost {
 public:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  /// Loads that only a subdomain that has more already may have: when a point moves, and when two become one.
  static constexpr double kMostMoved = 1.18, kMostMerged = 1.25;

  /// The star may be read anew before each call of set().
  StarCost(const Star& star, const IdVector<PieceId, Piece>& pieces, const IdVector<SideId, PieceId>& piece_of)
      : star_(star), pieces_(pieces), piece_of_(piece_of) {}

  void set(const Loads& loads, double most_load);
  /// The size of the smallest subdomain around.
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] double at_present() const;
  /// kNever where a load would be too large or too small.
  [[nodiscard]] double at(const Point& p);
  /// By Newton's method from `p`, for which at() was called last, to where the cost is least nearby.
  [[nodiscard]] Point step(const Point& p) const;

  /// Moves the center: changes the areas and the work of the pieces and loads around.
  void move(const Point& p, IdVector<PieceId, Piece>& pieces, Loads& loads) const;

 private:
  /// A subdomain around the center.
  struct Neighbor {
    SubdomainId subdomain = kNoSubdomain;
    double size = 0, before = 0;
    double load = 0;  ///< load at the place that at() was called for
    Point slope;      ///< gradient of the load
  };
  /// First and second derivatives.
  struct Slopes {
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    void add(const Point& u, double first, double second);
  };
  [[nodiscard]] std::size_t neighbor(const Loads& loads, SubdomainId subdomain);
  [[nodiscard]] Slopes slopes(const Point& p) const;

  const Star& star_;
  const IdVector<PieceId, Piece>& pieces_;
  const IdVector<SideId, PieceId>& piece_of_;
  double size_ = 0, most_load_ = 0;
  std::size_t count_ = 0;
  std::array<Neighbor, Star::kMostSpokes> neighbors_;
  std::array<std::size_t, Star::kMostSpokes> neighbor_of_{};  // one for each sector
  std::array<double, Star::kMostSpokes> density_{};           // load by area, for each sector
  std::array<double, Star::kMostSpokes> weight_{};            // one for each spoke
};

}  // namespace driftmesh
