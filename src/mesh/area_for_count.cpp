#include "mesh/area_for_count.hpp"

#include <cmath>

#include "mesh/bound_forecast.hpp"
#include "mesh/forecast.hpp"

namespace driftmesh {
double area_for_count(const Triangulation& mesh, const QualityBounds& bounds, double count) {
  constexpr double kAgrees = 0.02, kClose = 0.005;
  constexpr int kMostLooks = 12;
  const double domain = area_of(mesh);
  // How many times too many the forecast has, as a logarithm: it falls as the area grows.
  const auto excess = [&](double area) {
    QualityBounds asked = bounds;
    asked.plain.area = area;
    return std::log(forecast_triangles(mesh, asked) / count);
  };
  const double share = kTrianglesPerBound * domain / count;
  double low = share, above = excess(low);  // more than count
  if (!(std::fabs(above) > kAgrees)) return share;
  double high = low, below = above;  // less than count
  if (above > 0) {
    high = domain;
    below = high > low ? excess(high) : above;
    if (!(below < 0)) return domain;
  } else {
    for (int looks = 0; above < 0 && looks < kMostLooks; ++looks) above = excess(low /= 2);
  }
  // Regula falsi in logarithms; every other step halves, since the excess falls ever slower.
  for (int looks = 0; looks < kMostLooks; ++looks) {
    const double part = looks % 2 == 0 ? above / (above - below) : 0.5;
    const double area = low * std::pow(high / low, part), here = excess(area);
    if (std::fabs(here) < kClose) return area;
    (here > 0 ? low : high) = area;
    (here > 0 ? above : below) = here;
  }
  return low;
}

}  // namespace driftmesh
