#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <unordered_map>
#include <vector>

#include "driftmesh/size_field.hpp"
#include "geometry/box.hpp"
#include "sizing/expression_field.hpp"
#include "sizing/least_search.hpp"

namespace driftmesh {

/// An expression whose growth is limited: the length at p is the minimum over all points q of a box of its length at q
/// plus `gradation` times the distance from p to q, the largest function below the expression that grows no faster. Up
/// to five percent; found by branch and bound, so that no feature is too narrow.
///
/// Distances are along straight lines, through holes of the domain, too. Points of the box where the expression is not
/// positive count for nothing.
///
/// Where to look is much the same for points that are close together. So the box is divided into zones, as narrow as
/// lengths are alike in them, and each keeps the sources that matter somewhere in it, found among those of the
/// zone around it. Zones are made when they are needed and depend on nothing else; so do lengths.
class GradedField final : public SizeField {
 public:
  /// The expression has bounds. gradation > 0.
  GradedField(std::unique_ptr<const ExpressionField> field, double gradation, const Box& box);

  [[nodiscard]] double edge_length(const Point& p) const override;
  [[nodiscard]] double least() const override { return field_->least(); }
  /// By the limit itself, as falls_below: what is near a corner cannot be much less than there.
  [[nodiscard]] double least_between(const std::array<Point, 3>& triangle, double at_corners) const override;
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;

 private:
  using Cell = LeastSearch::Cell;
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  static constexpr double kNotAsked = 0;

  /// Lengths start from anywhere in it.
  struct Source {
    Cell cell;
    Box box{};                  // the cell's
    double least = kUnlimited;  // least value of the expression in it
    double middle = kNotAsked;  // its value at the center, where it is positive
  };
  struct Zone {
    Cell cell;
    Box box{};                 // the cell's
    double most = kUnlimited;  // no length in it is greater
    Point best{};              // place with the best bound for the zone
    double at_best = kUnlimited;
    std::vector<Source> sources{};
  };
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };
  struct Query;
  struct Answer {
    Point at{};
    double length = kNotAsked;
  };

  [[nodiscard]] double found_length(const Point& p) const;
  void descend(Query& query, const Source& source) const;
  void take_center(Query& query, const Source& source) const;
  [[nodiscard]] double bound_from(const Point& p, const Source& source) const;
  [[nodiscard]] Source source_at(const Cell& cell) const;
  [[nodiscard]] double middle_of(const Source& source) const;
  [[nodiscard]] bool has_part(const Box& box) const;
  [[nodiscard]] bool is_deepest(const Cell& cell) const;

  [[nodiscard]] const Zone& zone_of(const Point& p) const;
  [[nodiscard]] const Zone& zone_at(const Cell& cell, const Zone& around) const;
  [[nodiscard]] bool is_wide(const Zone& zone) const;
  void begin(Zone& zone, const Zone& around) const;
  void add(Zone& zone, const Source& source) const;
  void start_from(Zone& zone, const Point& at, double length) const;
  [[nodiscard]] double bound_from(const Zone& zone, const Source& source) const;

  std::unique_ptr<const ExpressionField> field_;
  double gradation_;
  Box box_;
  Cell root_;        // with its neighbors above and to the right it covers the box
  Zone everywhere_;  // covers the box and the plane beyond
  mutable std::unordered_map<Cell, Zone, CellHash> zones_;
  mutable const Zone* latest_ = nullptr;
  // Tables of fixed size: of cells that were looked at, and of points that were asked for.
  mutable std::vector<Source> known_;
  mutable std::vector<Answer> answers_;
};

}  // namespace driftmesh
