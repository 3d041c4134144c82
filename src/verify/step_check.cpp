#include "verify/step_check.hpp"

#include <algorithm>
#include <cmath>

#include "base/formatted.hpp"
#include "base/in_parts.hpp"
#include "geometry/box.hpp"
#include "raster/greatest_in_triangle.hpp"
#include "verify/extended.hpp"

namespace driftmesh {
namespace {

constexpr double kSlackOfCourant = 1e-9;  // relative, for rounding
constexpr double kGravityOfEarth = 9.81;  // m/s^2
constexpr double kShallowest = 1;         // m
// The edge of a triangle that may be larger than asked for, over the length needed: what the mesher promises.
constexpr double kSpareEdges = 2.61;
constexpr double kSpareAltitudes = 3.4;

double edge_of(const Point& a, const Point& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

double twice_area_of(const StepCheck::Triangle& t) {
  return std::fabs(static_cast<double>(cross_extended(t[0], t[1], t[2])));
}

}  // namespace

void StepMeasures::add(const StepMeasures& later, std::size_t max_listed) {
  greatest = std::max(greatest, later.greatest);
  above += later.above;
  worst.insert(worst.end(), later.worst.begin(), later.worst.end());
  std::ranges::stable_sort(worst, std::greater{}, &Item::courant);
  if (worst.size() > max_listed) worst.resize(max_listed);
}

double StepCheck::courant(const Triangle& t) const {
  const std::array<double, 3> edges{edge_of(t[0], t[1]), edge_of(t[1], t[2]), edge_of(t[2], t[0])};
  const double length = rule_.length == CourantLength::kEdge ? *std::ranges::min_element(edges)
                                                             : twice_area_of(t) / *std::ranges::max_element(edges);
  return rule_.bound * needed(greatest_in(depth_, t)) / length;
}

double StepCheck::needed(double depth) const {
  return rule_.step * (std::sqrt(kGravityOfEarth * std::max(depth, kShallowest)) + rule_.speed) / rule_.bound;
}

StepMeasures StepCheck::measure(const NamedMesh& mesh, std::size_t max_listed, std::size_t threads) const {
  const Mesh& arrays = mesh.mesh();
  std::vector<StepMeasures> parts(threads);
  in_parts(arrays.triangles.size(), threads, [&](std::size_t part, std::size_t begin, std::size_t end) {
    StepMeasures& found = parts[part];
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = arrays.triangles[t];
      const Triangle corners{arrays.points[a], arrays.points[b], arrays.points[c]};
      const double number = courant(corners);
      found.greatest = std::max(found.greatest, number);
      if (number <= rule_.bound * (1 + kSlackOfCourant)) continue;
      StepMeasures one{number, 1, {}};
      if (found.worst.size() < max_listed || (max_listed > 0 && number > found.worst.back().courant))
        one.worst.push_back({number, triangle_words(mesh.place(t), mesh.numbers(t)) +
                                         formatted(" has Courant number {:.4g} at {}, at most {:g} is asked for",
                                                   number, place_words(corners[0]), rule_.bound)});
      found.add(one, max_listed);
    }
  });
  for (std::size_t part = 1; part < threads; ++part) parts[0].add(parts[part], max_listed);
  return std::move(parts[0]);
}

bool StepCheck::spares(const Triangle& t) const {
  const Box box = Box::of(t);
  const double margin = std::max(box.high.x - box.low.x, box.high.y - box.low.y) / 2;
  const double depth = depth_.over(Box::around(box.low, box.high, margin)).high;
  const double edge = (rule_.length == CourantLength::kEdge ? kSpareEdges : kSpareAltitudes) * needed(depth);
  return twice_area_of(t) <= std::sqrt(3.0) / 2 * edge * edge;
}

}  // namespace driftmesh
