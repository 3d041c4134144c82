#include "adapt/error_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh::adapt {
namespace {

void require_sound(const Mesh& mesh, std::span<const double> indicators, double target, double order) {
  const std::string what = "lengths_from_error: ";
  if (indicators.size() != mesh.triangles.size())
    throw Error(what + "there are " + std::to_string(indicators.size()) + " indicators for " +
                std::to_string(mesh.triangles.size()) + " triangles; give one for each triangle of the present mesh");
  const auto wrong = std::ranges::find_if(indicators, [](double e) { return !(e >= 0 && std::isfinite(e)); });
  if (wrong != indicators.end())
    throw Error(what + "the indicator of triangle " + std::to_string(wrong - indicators.begin()) +
                " (counted from 0) is " + std::to_string(*wrong) + "; it must be at least 0, and finite");
  for (const double value : {target, order})
    if (!(value > 0 && std::isfinite(value)))
      throw Error(what + (value == target ? "target" : "order") + " is " + std::to_string(value) +
                  "; it must be positive");
}

}  // namespace

/// With c(x) the error of a triangle with edges of length 1 per square root of its area, one with edges h has c h^p on
/// its area. Of all lengths h(x) for which the integral of c^2 h^(2p) is the square of the target, h = m / c^(1/(p+1))
/// gives the fewest triangles (Lagrange), and all of them the same error; m follows from the target.
std::vector<double> lengths_from_error(const Mesh& mesh, std::span<const double> indicators, double target,
                                       double order) {
  require_sound(mesh, indicators, target, order);
  std::vector<double> density(mesh.points.size()), area_around(mesh.points.size());
  double sum = 0;
  for (std::size_t t = 0; t < indicators.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const double area = signed_area(mesh.points[a], mesh.points[b], mesh.points[c]);
    const double own = indicators[t] / (std::pow(edge_of_twice_area(2 * area), order) * std::sqrt(area));
    sum += std::pow(own, 2 / (order + 1)) * area;
    for (const std::int32_t v : mesh.triangles[t]) {
      density[v] += own * area;
      area_around[v] += area;
    }
  }
  const double factor = std::pow(target * target / sum, 1 / (2 * order));
  std::vector<double> lengths(mesh.points.size(), kNoBound);
  for (std::size_t v = 0; v < lengths.size(); ++v)
    if (density[v] > 0) lengths[v] = factor / std::pow(density[v] / area_around[v], 1 / (order + 1));
  return lengths;
}

}  // namespace driftmesh::adapt
