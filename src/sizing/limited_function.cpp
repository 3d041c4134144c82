#include "sizing/limited_function.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace driftmesh {
namespace {

using FunctionHandle = std::shared_ptr<const PlaneFunction>;

class Clamped final : public PlaneFunction {
 public:
  Clamped(std::shared_ptr<const PlaneFunction> function, double least, double most)
      : function_(std::move(function)), least_(least), most_(most) {}
  [[nodiscard]] double at(const Point& p) const override { return std::min(std::max(function_->at(p), least_), most_); }
  [[nodiscard]] Variation over(const Box& box) const override {
    Variation found = function_->over(box);
    const Interval before = found.value;
    found.value = intervals::smaller(intervals::larger(before, {least_, least_}), {most_, most_});
    const bool is_constant = !before.undefined && found.value.is_point();
    const bool changes = before.low < least_ || before.high > most_;
    for (Interval* slope : {&found.in_x, &found.in_y, &found.in_directions})
      if (is_constant)
        *slope = {0, 0};
      else if (changes)
        *slope = intervals::hull(*slope, {0, 0});
    return found;
  }
  [[nodiscard]] std::shared_ptr<const PlaneFunction> within(const Box& box) const override {
    auto narrowed = function_->within(box);
    return narrowed == nullptr ? nullptr : std::make_shared<const Clamped>(std::move(narrowed), least_, most_);
  }

 private:
  std::shared_ptr<const PlaneFunction> function_;
  double least_, most_;
};

class Least final : public PlaneFunction {
 public:
  explicit Least(std::vector<FunctionHandle> functions) : functions_(std::move(functions)) {}
  [[nodiscard]] double at(const Point& p) const override {
    double least = std::numeric_limits<double>::infinity();
    for (const FunctionHandle& function : functions_) {
      const double value = function->at(p);
      if (!(value >= least)) least = value;
      if (std::isnan(least)) break;
    }
    return least;
  }
  /// Slopes are those of the functions that may be least somewhere in the box.
  [[nodiscard]] Variation over(const Box& box) const override {
    Variation found = functions_.front()->over(box);
    for (std::size_t k = 1; k < functions_.size(); ++k) {
      const Variation other = functions_[k]->over(box);
      const bool undefined = found.value.undefined || other.value.undefined;
      const Interval value{std::min(found.value.low, other.value.low), std::min(found.value.high, other.value.high),
                           undefined};
      if (other.value.high < found.value.low) {
        found = other;
      } else if (!(other.value.low > found.value.high)) {
        found.in_x = intervals::hull(found.in_x, other.in_x);
        found.in_y = intervals::hull(found.in_y, other.in_y);
        found.in_directions = intervals::hull(found.in_directions, other.in_directions);
      }
      found.value = value;
    }
    return found;
  }
  [[nodiscard]] FunctionHandle within(const Box& box) const override {
    std::vector<FunctionHandle> narrowed = functions_;
    bool is_better = false;
    for (FunctionHandle& function : narrowed) {
      FunctionHandle better = function->within(box);
      is_better = is_better || better != nullptr;
      if (better != nullptr) function = std::move(better);
    }
    return is_better ? std::make_shared<const Least>(std::move(narrowed)) : nullptr;
  }

 private:
  std::vector<FunctionHandle> functions_;
};

}  // namespace

FunctionHandle limited(FunctionHandle function, double least, double most) {
  return std::make_shared<const Clamped>(std::move(function), least, most);
}

FunctionHandle least_of(std::vector<FunctionHandle> functions) {
  if (functions.size() == 1) return std::move(functions.front());
  return std::make_shared<const Least>(std::move(functions));
}

}  // namespace driftmesh
