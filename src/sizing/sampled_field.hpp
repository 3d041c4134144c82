#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "driftmesh/size_field.hpp"

namespace driftmesh {

/// A length asked for somewhere in a triangle counts if it is less than this times the triangle's.
inline constexpr double kCounts = 0.9;

/// A size field of which only values at points are known, such as a function of the caller: between the corners and
/// the centroid of a triangle it is looked up on a grid, and more closely around the lowest point of the grid if it is
/// steep there.
///
/// Lengths below kCounts times the triangle's are found wherever they take up a square of the grid's
/// spacing. A narrower feature may be missed. The field is asked once for each point of the grid in a triangle (its
/// value is kept, in 4 bytes), so never at points outside the domain. Several threads may ask at once if the field
/// allows that, and then may ask it twice.
class SampledField final : public SizeField {
 public:
  /// Whether the field itself tells all about a triangle by its falls_below.
  using Knows = std::function<bool(const std::array<Point, 3>&)>;

  /// A grid with a point at `origin` and a `spacing` > 0.
  struct Grid {
    Point origin{};
    double spacing = 0;
  };
  /// The field must outlive this one.
  SampledField(const SizeField& field, const Grid& grid) : field_(field), grid_(grid) {}
  /// Owns the field.
  SampledField(std::unique_ptr<const SizeField> field, const Grid& grid, Knows knows = nullptr)
      : owned_(std::move(field)), field_(*owned_), grid_(grid), knows_(std::move(knows)) {}

  [[nodiscard]] double edge_length(const Point& p) const override { return field_.edge_length(p); }
  [[nodiscard]] double least() const override { return field_.least(); }
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;
  void visit_marks(const std::function<void(const Point&)>& visit) const override { field_.visit_marks(visit); }

 private:
  static constexpr std::int64_t kTile = 32;
  using Tile = std::array<std::atomic<float>, kTile * kTile>;
  struct TileHash {
    std::size_t operator()(const std::array<std::int64_t, 2>& place) const;
  };
  struct Lowest;

  [[nodiscard]] Lowest lowest_on_grid(const std::array<Point, 3>& triangle, double enough) const;
  [[nodiscard]] bool is_steep(const std::array<Point, 3>& triangle, const Lowest& lowest, double limit) const;
  [[nodiscard]] bool descends_below(const std::array<Point, 3>& triangle, Point from, double length,
                                    double limit) const;
  [[nodiscard]] Point at(std::int64_t i, std::int64_t j) const;
  [[nodiscard]] double length_at(std::int64_t i, std::int64_t j) const;
  [[nodiscard]] Tile* tile_at(const std::array<std::int64_t, 2>& place) const;
  [[nodiscard]] float rounded_down(double length) const;

  std::unique_ptr<const SizeField> owned_;
  const SizeField& field_;
  Grid grid_;
  Knows knows_;
  mutable std::mutex lock_;  // guards the map
  mutable std::unordered_map<std::array<std::int64_t, 2>, std::unique_ptr<Tile>, TileHash> tiles_;
};

}  // namespace driftmesh
