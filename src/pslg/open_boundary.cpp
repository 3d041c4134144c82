#include "pslg/open_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "pslg/describe.hpp"

namespace driftmesh {
namespace {

std::int32_t root(std::vector<std::int32_t>& parent, std::int32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

OpenBoundary find_open_boundary(const Pslg& pslg) {
  OpenBoundary result;
  std::vector<std::int32_t> degree(pslg.points.size(), 0);
  std::vector<std::int32_t> parent(pslg.points.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const Pslg::Segment& s : pslg.segments) {
    ++degree[s.a];
    ++degree[s.b];
    const std::int32_t a = root(parent, s.a), b = root(parent, s.b);
    result.has_loop = result.has_loop || a == b;  // its ends were connected already
    parent[a] = b;
  }
  for (std::size_t i = 0; i < degree.size(); ++i)
    if (degree[i] == 1) result.open_ends.push_back(static_cast<std::int32_t>(i));
  return result;
}

std::optional<Gap> find_gap(const Pslg& pslg, const std::vector<std::int32_t>& open_ends) {
  std::set<std::pair<std::int32_t, std::int32_t>> joined;
  for (const Pslg::Segment& s : pslg.segments) joined.insert(std::minmax(s.a, s.b));
  std::vector<std::int32_t> by_x = open_ends;
  const auto at = [&](std::int32_t v) -> const Point& { return pslg.points[v]; };
  std::sort(by_x.begin(), by_x.end(),
            [&](std::int32_t a, std::int32_t b) { return std::pair(at(a).x, a) < std::pair(at(b).x, b); });
  std::optional<Gap> narrowest;
  double least = std::numeric_limits<double>::infinity();
  for (auto a = by_x.begin(); a != by_x.end(); ++a)
    for (auto b = a + 1; b != by_x.end() && at(*b).x - at(*a).x < least; ++b) {
      const double width = std::hypot(at(*b).x - at(*a).x, at(*b).y - at(*a).y);
      if (!(width < least) || joined.contains(std::minmax(*a, *b))) continue;
      least = width;
      narrowest = {std::min(*a, *b), std::max(*a, *b), width};
    }
  return narrowest;
}

std::string describe_gap(const Pslg& pslg, const std::vector<std::int32_t>& open_ends) {
  const std::optional<Gap> gap = find_gap(pslg, open_ends);
  if (!gap) return "";
  const std::string which =
      open_ends.size() == 2 ? "its ends " : "the nearest of its " + std::to_string(open_ends.size()) + " free ends, ";
  return which + coordinates(pslg.points[gap->a]) + " and " + coordinates(pslg.points[gap->b]) +
         (open_ends.size() == 2 ? " are " : ", are ") + length_text(gap->width) +
         " apart; close the gap, or have the input snapped by more than that";
}

std::string describe_open_boundary(const Pslg& pslg) {
  const std::string what = "the segments enclose no area: the outer boundary is open";
  const std::string gap = describe_gap(pslg, find_open_boundary(pslg).open_ends);
  if (!gap.empty()) return what + ", and " + gap;
  return what + " or missing (" + std::to_string(pslg.segments.size()) + " segments); close the boundary";
}

}  // namespace driftmesh
