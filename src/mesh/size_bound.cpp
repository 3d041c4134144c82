#include "mesh/size_bound.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

/// The same area everywhere.
class AreaEverywhere final : public SizeBound {
 public:
  explicit AreaEverywhere(double area) : area_(area) {}
  [[nodiscard]] double twice_area(std::uint16_t /*region*/) const override { return 2 * area_; }

 private:
  double area_;
};

/// An area for each region label, <= 0 for none.
class AreaByRegion final : public SizeBound {
 public:
  explicit AreaByRegion(std::vector<double> areas) : areas_(std::move(areas)) {}
  [[nodiscard]] std::size_t regions() const override { return areas_.size(); }
  [[nodiscard]] double twice_area(std::uint16_t region) const override {
    return region < areas_.size() && areas_[region] > 0 ? 2 * areas_[region] : kNoBound;
  }

 private:
  std::vector<double> areas_;
};

/// The area of the equilateral triangle with the edges that a size field asks for.
class LengthByPlace final : public SizeBound {
 public:
  explicit LengthByPlace(const SizeField& field) : field_(field) {}
  [[nodiscard]] const SizeField* lengths() const override { return &field_; }

 private:
  const SizeField& field_;
};

/// One row for each kind: null if it is not asked for.
using Make = std::shared_ptr<const SizeBound> (*)(const QualityBounds&);
constexpr Make kKinds[] = {
    [](const QualityBounds& b) -> std::shared_ptr<const SizeBound> {
      if (std::isnan(b.plain.area)) throw Error("the area bound is not a number");
      return b.plain.area > 0 ? std::make_shared<AreaEverywhere>(b.plain.area) : nullptr;
    },
    [](const QualityBounds& b) -> std::shared_ptr<const SizeBound> {
      return b.region_max_area.empty() ? nullptr : std::make_shared<AreaByRegion>(b.region_max_area);
    },
    [](const QualityBounds& b) -> std::shared_ptr<const SizeBound> {
      return b.size == nullptr ? nullptr : std::make_shared<LengthByPlace>(*b.size);
    },
};

SizeKinds kinds_of(const QualityBounds& bounds) {
  SizeKinds kinds;
  for (const Make make : kKinds)
    if (auto kind = make(bounds)) kinds.push_back(std::move(kind));
  return kinds;
}

}  // namespace

SizeBounds::SizeBounds(const QualityBounds& bounds) : SizeBounds(kinds_of(bounds)) {
  step_ = floor_ = bounds.step;
}

SizeBounds::SizeBounds(SizeKinds kinds) : kinds_(std::move(kinds)) {
  std::size_t regions = 1;
  for (const auto& kind : kinds_) {
    regions = std::max(regions, kind->regions());
    if (const SizeField* field = kind->lengths()) fields_.push_back(field);
  }
  for (std::size_t label = 0; label <= regions; ++label) {
    double bound = kNoBound;
    for (const auto& kind : kinds_) bound = std::min(bound, kind->twice_area(static_cast<std::uint16_t>(label)));
    by_region_.push_back(bound);
  }
}

SizeBounds SizeBounds::coarser(double factor) const {
  SizeBounds coarse = *this;
  for (double& bound : coarse.by_region_) bound *= factor;
  coarse.stretch_ *= std::sqrt(factor);
  coarse.step_ = nullptr;
  return coarse;
}

double SizeBounds::least_twice_area() const {
  return *std::ranges::min_element(by_region_);
}

}  // namespace driftmesh
