#pragma once

#include <array>
#include <memory>

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
class GradedField final : public SizeField {
 public:
  /// The expression has bounds. gradation > 0.
  GradedField(std::unique_ptr<const ExpressionField> field, double gradation, const Box& box);

  [[nodiscard]] double edge_length(const Point& p) const override;
  [[nodiscard]] double least() const override { return field_->least(); }
  /// By the limit itself: what is near a corner cannot be much less than there.
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override;

 private:
  struct Query;
  void descend(Query& query, const LeastSearch::Cell& cell) const;
  [[nodiscard]] double bound_from(const Point& p, const LeastSearch::Cell& cell) const;

  std::unique_ptr<const ExpressionField> field_;
  double gradation_;
  Box box_;
  mutable LeastSearch search_;
  LeastSearch::Cell root_;  // with its neighbors above and to the right it covers the box
};

}  // namespace driftmesh
