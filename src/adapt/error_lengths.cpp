#include "adapt/error_lengths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "adapt/of_all_parts.hpp"
#include "adapt/sums_at_points.hpp"
#include "base/formatted.hpp"
#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh::adapt {
namespace {

void require_sound(const Mesh& mesh, std::span<const double> indicators, double target, double order) {
  if (indicators.size() != mesh.triangles.size())
    throw Error(
        formatted("lengths_from_error: there are {} indicators for {} triangles; give one for each triangle of the "
                  "present mesh",
                  indicators.size(), mesh.triangles.size()));
  const auto wrong = std::ranges::find_if(indicators, [](double e) { return !(e >= 0 && std::isfinite(e)); });
  if (wrong != indicators.end())
    throw Error(
        formatted("lengths_from_error: the indicator of triangle {} (counted from 0) is {}; it must be at least 0, and "
                  "finite",
                  wrong - indicators.begin(), *wrong));
  for (const auto& [name, value] : {std::pair("target", target), {"order", order}})
    if (!(value > 0 && std::isfinite(value)))
      throw Error(formatted("lengths_from_error: {} is {}; it must be positive, and finite", name, value));
}

/// What is known at points and of subdomains, from the errors of their triangles.
class Densities {
 public:
  Densities(const Generation& present, std::span<const double> indicators, double order)
      : piece_(present.piece),
        at_points_(piece_.mesh.points.size()),
        sums_(present, 2),
        of_parts_(present.parts.size()) {
    const std::vector<std::int32_t>& subdomains = piece_.mesh.subdomains;
    for (std::size_t t = 0; t < indicators.size(); ++t) {
      const auto& [a, b, c] = piece_.mesh.triangles[t];
      const double area = signed_area(piece_.mesh.points[a], piece_.mesh.points[b], piece_.mesh.points[c]);
      const double own = indicators[t] / (std::pow(edge_of_twice_area(2 * area), order) * std::sqrt(area));
      const auto s = static_cast<SubdomainId>(subdomains[t]);
      of_parts_[s] += std::pow(own, 2 / (order + 1)) * area;
      for (const std::int32_t v : piece_.mesh.triangles[t]) note(v, own, area);
      if (t + 1 == indicators.size() || subdomains[t + 1] != subdomains[t]) end_of(s);
    }
  }

  [[nodiscard]] double of_part(SubdomainId s) const { return of_parts_[s]; }
  /// For each point the sums of densities, times areas, and of areas.
  [[nodiscard]] std::vector<double> at_points(Ranks& ranks) { return sums_.take(ranks); }

 private:
  void note(std::int32_t point, double density, double area) {
    std::array<double, 2>& sums = at_points_[to_index(point)];
    if (sums[1] == 0) noted_.push_back(point);
    sums[0] += density * area;
    sums[1] += area;
  }
  void end_of(SubdomainId s) {
    for (const std::int32_t point : noted_) sums_.add(s, point, std::exchange(at_points_[to_index(point)], {}));
    noted_.clear();
  }

  const DistributedPiece& piece_;
  std::vector<std::array<double, 2>> at_points_;  // of the present subdomain
  std::vector<std::int32_t> noted_;               // its points
  SumsAtPoints sums_;
  IdVector<SubdomainId, double> of_parts_;
};

}  // namespace

/// With c(x) the error of a triangle with edges of length 1 per square root of its area, one with edges h has c h^p on
/// its area. Of all lengths h(x) for which the integral of c^2 h^(2p) is the square of the target, h = m / c^(1/(p+1))
/// gives the fewest triangles (Lagrange), and all of them the same error; m follows from the target.
std::vector<double> lengths_from_error(const Generation& present, std::span<const double> indicators, double target,
                                       double order, Ranks& ranks) {
  ranks.agree([&] { require_sound(present.piece.mesh, indicators, target, order); });
  Densities densities(present, indicators, order);
  double sum = 0;
  for (const double of_one : of_all_parts(ranks, present, [&](SubdomainId s) { return densities.of_part(s); }))
    sum += of_one;
  const double factor = std::pow(target * target / sum, 1 / (2 * order));
  const std::vector<double> at_points = densities.at_points(ranks);
  std::vector<double> lengths(present.piece.mesh.points.size(), kNoBound);
  for (std::size_t v = 0; v < lengths.size(); ++v)
    if (at_points[2 * v] > 0) lengths[v] = factor / std::pow(at_points[2 * v] / at_points[2 * v + 1], 1 / (order + 1));
  return lengths;
}

}  // namespace driftmesh::adapt
