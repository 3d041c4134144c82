#include "raster/raster_stack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace driftmesh {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

Extent hull(const Extent& a, const Extent& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// What s upper + (1 - s) lower can be: linear in s, it is extreme at one of its ends.
Extent blended(const Extent& share, const Extent& upper, const Extent& lower) {
  const auto at = [&](double s) {
    if (s <= 0) return lower;
    if (s >= 1) return upper;
    return Extent{s * upper.low + (1 - s) * lower.low, s * upper.high + (1 - s) * lower.high};
  };
  return hull(at(share.low), at(share.high));
}

Extent product(const Extent& a, const Extent& b) {
  const std::array<double, 4> ends{a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  return {*std::ranges::min_element(ends), *std::ranges::max_element(ends)};
}

bool is_finite(const Extent& e) {
  return std::isfinite(e.low) && std::isfinite(e.high);
}

double magnitude(const Extent& e) {
  return std::max(std::abs(e.low), std::abs(e.high));
}

}  // namespace

RasterStack::RasterStack(std::vector<Layer> layers) : layers_(std::move(layers)) {
  layers_.back().share = nullptr;
  for (Layer& layer : layers_)
    if (!layer.share) layer.reach = {{-kUnbounded, -kUnbounded}, {kUnbounded, kUnbounded}};
  for (const Layer& layer : layers_)
    for (const auto& raster : {layer.values, layer.share})
      if (raster) frames_.insert(frames_.end(), raster->frames().begin(), raster->frames().end());
}

double RasterStack::at(const Point& p) const {
  double sum = 0, left = 1;
  for (const Layer& layer : layers_) {
    if (!layer.reach.contains(p)) continue;
    const double share = layer.share ? layer.share->at(p) : 1;
    if (share <= 0) continue;
    const double value = layer.values->at(p);
    if (share >= 1) return left == 1 ? value : sum + left * value;
    sum += left * share * value;
    left *= 1 - share;
  }
  return sum;
}

/// Of the layers from some one to the last, blended.
struct RasterStack::Mixed {
  Extent values;
  Slopes slopes;
};

RasterStack::Mixed RasterStack::mixed_over(const Box& box, bool with_slopes) const {
  struct Seen {
    const Layer* layer;
    Extent share;
  };
  std::vector<Seen> seen;
  for (const Layer& layer : layers_) {
    if (!layer.reach.overlaps(box)) continue;
    const Extent share = layer.share ? layer.share->over(box) : Extent{1, 1};
    if (share.high <= 0) continue;
    seen.push_back({&layer, share});
    if (share.low >= 1) break;
  }
  const auto slopes_of = [&](const Raster& raster) { return with_slopes ? raster.slopes_over(box) : Slopes{}; };
  Mixed mixed{seen.back().layer->values->over(box), slopes_of(*seen.back().layer->values)};
  double largest = magnitude(mixed.values);
  for (std::size_t k = seen.size() - 1; k-- > 0;) {
    const auto& layer = seen[k].layer;
    const Extent share = seen[k].share;
    const Extent upper = layer->values->over(box), lower = mixed.values;
    largest = std::max(largest, magnitude(upper));
    mixed.values = blended(share, upper, lower);
    if (!with_slopes) continue;
    const Slopes above = layer->values->slopes_over(box), of_share = layer->share->slopes_over(box);
    const Extent step{upper.low - lower.high, upper.high - lower.low};
    const auto slope = [&](const Extent& of_upper, const Extent& of_lower, const Extent& rise) {
      if (!is_finite(of_upper) || !is_finite(of_lower) || !is_finite(rise)) return Extent{-kUnbounded, kUnbounded};
      const Extent straight = blended(share, of_upper, of_lower), seam = product(rise, step);
      return Extent{straight.low + seam.low, straight.high + seam.high};
    };
    mixed.slopes = {slope(above.in_x, mixed.slopes.in_x, of_share.in_x),
                    slope(above.in_y, mixed.slopes.in_y, of_share.in_y)};
  }
  if (seen.size() > 1) {  // rounding, here and in at()
    const double rounding = 0x1p-48 * static_cast<double>(seen.size()) * largest;
    mixed.values = {mixed.values.low - rounding, mixed.values.high + rounding};
  }
  return mixed;
}

Extent RasterStack::over(const Box& box) const {
  return mixed_over(box, false).values;
}

Raster::Slopes RasterStack::slopes_over(const Box& box) const {
  return mixed_over(box, true).slopes;
}

std::shared_ptr<const Raster> RasterStack::slope() const {
  std::call_once(has_slope_, [this] {
    std::vector<Layer> slopes;
    for (const Layer& layer : layers_) slopes.push_back({layer.values->slope(), layer.share, layer.reach});
    slope_ = std::make_shared<const RasterStack>(std::move(slopes));
  });
  return slope_;
}

}  // namespace driftmesh
