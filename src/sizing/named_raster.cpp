#include "sizing/named_raster.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "raster/raster.hpp"
#include "sizing/expression_parser.hpp"

namespace driftmesh {
namespace {

class RasterFunction final : public PlaneFunction {
 public:
  explicit RasterFunction(std::shared_ptr<const Raster> raster) : raster_(std::move(raster)) {}
  [[nodiscard]] double at(const Point& p) const override { return raster_->at(p); }
  [[nodiscard]] Variation over(const Box& box) const override {
    const auto interval = [](const Extent& extent) { return Interval{extent.low, extent.high}; };
    const Extent values = raster_->over(box);
    const Raster::Slopes slopes = raster_->slopes_over(box);
    const auto most = [](const Extent& e) { return std::max(std::abs(e.low), std::abs(e.high)); };
    const double steepest = std::hypot(most(slopes.in_x), most(slopes.in_y));
    return {interval(values), interval(slopes.in_x), interval(slopes.in_y), {-steepest, steepest}};
  }

 private:
  std::shared_ptr<const Raster> raster_;
};

}  // namespace

std::shared_ptr<const PlaneFunction> values_of(std::shared_ptr<const Raster> raster) {
  return std::make_shared<const RasterFunction>(std::move(raster));
}

std::shared_ptr<const PlaneFunction> slope_of(const std::shared_ptr<const Raster>& raster) {
  return values_of(raster->slope());
}

bool can_name_raster(std::string_view name) {
  const auto may_begin = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; };
  if (name.empty() || !may_begin(static_cast<unsigned char>(name.front()))) return false;
  if (!std::ranges::all_of(name, [&](unsigned char c) { return may_begin(c) || std::isdigit(c) != 0; })) return false;
  return !is_known_to_expressions(name);
}

}  // namespace driftmesh
