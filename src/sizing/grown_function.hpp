#pragma once

#include <memory>
#include <vector>

#include "sizing/nearest_in_square.hpp"
#include "sizing/plane_function.hpp"
#include "sizing/size_tree.hpp"

namespace driftmesh {

/// A function whose growth is limited: the value at p is the minimum over all points q of a box of the function at q
/// plus `gradation` times the distance from p to q, the largest function below that grows no faster. Distances are
/// along straight lines. Points where the function is not positive count for nothing.
///
/// Where the function is no steeper than the limit, only its own value at p matters, or that at q where it is steeper:
/// in squares so narrow, compared with the least value in them, that this one holds for all of the square. Squares are
/// found by branch and bound, so that none is missed.
class GrownFunction final : public PlaneFunction {
 public:
  struct Accuracy {
    double narrow;      ///< width of the squares, relative to the least in them
    double search = 1;  ///< values at points may be greater by this divisor, which makes the search for them short
  };
  /// `function`: gives the lengths of `field`. `finest`: see SizeTree.
  GrownFunction(std::shared_ptr<const SizeField> field, std::shared_ptr<const PlaneFunction> function, double gradation,
                const Box& domain, const Accuracy& accuracy, double finest);

  [[nodiscard]] double at(const Point& p) const override;
  [[nodiscard]] Variation over(const Box& box) const override;
  [[nodiscard]] std::shared_ptr<const PlaneFunction> within(const Box& box) const override;

 private:
  using Square = SizeTree::Square;
  using Spot = SizeTree::Spot;
  /// A point of a square and the least in that: from it the value at p is at most that, and the limit times the
  /// distance.
  struct Start {
    Point at{};
    double length = 0;  // 0: none
  };
  struct Least {
    double length;
    Start from;
  };

  /// The same with another own function, and no squares.
  GrownFunction(const GrownFunction& other, std::shared_ptr<const PlaneFunction> own);
  [[nodiscard]] Box part_in_domain(const Square& square) const;
  [[nodiscard]] bool matters(const Square& square) const;
  void keep(const Square& square, const NearestInSquare& near, double fine, std::vector<Spot>& kept) const;
  void descend(const Point& p, const Square& square, Least& least) const;
  [[nodiscard]] double most_from(const Start& start, const Point& p) const;

  std::shared_ptr<const PlaneFunction> own_;
  std::shared_ptr<const SizeTree> steep_;
  double gradation_;
  double search_;
  Box domain_;
  std::vector<Spot> squares_;  // those that matter somewhere
  Start start_{};              // a good one for a center
};

}  // namespace driftmesh
