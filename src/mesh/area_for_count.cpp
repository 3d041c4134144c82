#include "mesh/area_for_count.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/bound_forecast.hpp"
#include "mesh/forecast.hpp"
#include "mesh/refiner.hpp"

namespace driftmesh {
namespace {

struct Look {
  double area = 0;
  double excess = 0;  // how many times too many triangles there are, as a logarithm: it falls as the area grows
};

/// The nearest to no excess of some looks, beginning with `first`; the last one if it is `close`. Areas are at most
/// `domain`.
template <class Excess>
Look settle(const Excess& excess, const Look& first, double domain, double close, int looks) {
  constexpr double kBeyond = 1.2;              // steps this much too far bracket what is sought
  Look here = first, best = first, many, few;  // an area of 0: not seen
  for (int look = 0;; ++look) {
    if (std::fabs(here.excess) < std::fabs(best.excess)) best = here;
    (here.excess > 0 ? many : few) = here;
    if (std::fabs(best.excess) <= close || many.area >= domain || look + 1 == looks) return best;
    double area = std::min(here.area * std::exp(kBeyond * here.excess), domain);
    if (many.area > 0 && few.area > 0) {
      // Regula falsi in logarithms; every other step halves, since the excess falls ever slower.
      const double part = look % 2 == 0 ? many.excess / (many.excess - few.excess) : 0.5;
      area = many.area * std::pow(few.area / many.area, part);
    }
    here = {area, excess(area)};
  }
}

double triangles_made(Triangulation mesh, const QualityBounds& bounds, double count) {
  constexpr double kAbandon = 4;  // times as many as are wanted
  Refiner refiner(mesh, bounds);
  refiner.limit_triangles(std::llround(kAbandon * count) + 1);
  static_cast<void>(refiner.refine());
  return static_cast<double>(mesh.live_triangles());
}

}  // namespace

double area_for_count(const Triangulation& mesh, const QualityBounds& bounds, double count) {
  constexpr double kAgrees = 0.02, kClose = 0.005;
  constexpr int kMostLooks = 24;
  const double domain = area_of(mesh), share = kTrianglesPerBound * domain / count;
  const auto excess = [&](double area) {
    QualityBounds asked = bounds;
    asked.plain.area = area;
    return std::log(forecast_triangles(mesh, asked) / count);
  };
  const Look first{std::min(share, domain), excess(share)};
  return std::fabs(first.excess) <= kAgrees ? share : settle(excess, first, domain, kClose, kMostLooks).area;
}

TriedArea try_area_for_count(const Triangulation& mesh, const QualityBounds& bounds, double count, double forecast) {
  constexpr double kMost = 100'000, kTooMany = 2, kClose = 0.05;
  constexpr int kTrials = 8;
  if (count > kMost || forecast > kTooMany * count) return {bounds.plain.area, forecast};
  const auto excess = [&](double area) {
    QualityBounds tried = bounds;
    tried.plain.area = area;
    return std::log(triangles_made(mesh, tried, count) / count);
  };
  const Look first{bounds.plain.area, excess(bounds.plain.area)};
  const Look found = settle(excess, first, area_of(mesh), kClose, kTrials);
  return {found.area, std::round(count * std::exp(found.excess))};
}

}  // namespace driftmesh
