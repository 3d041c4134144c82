#include "pslg/open_boundary.hpp"

#include <algorithm>
#include <numeric>

#include "pslg/describe.hpp"

namespace driftmesh {
namespace {

constexpr std::size_t kMaxNamed = 4;

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

std::string describe_open_boundary(const Pslg& pslg, const RepairReport& report) {
  const OpenBoundary boundary = find_open_boundary(pslg);
  if (pslg.segments.empty()) return "there are no segments that bound an area";
  if (boundary.open_ends.empty())
    return "every chain of segments is closed, but the holes remove everything they enclose";
  std::string text =
      boundary.has_loop ? "the boundary is open at " : "no segments form a closed boundary; it is open at ";
  const std::size_t named = std::min(boundary.open_ends.size(), kMaxNamed);
  for (std::size_t i = 0; i < named; ++i) {
    const std::int32_t v = boundary.open_ends[i];
    if (i > 0) text += i + 1 == boundary.open_ends.size() ? " and " : ", ";
    text += vertex_name(pslg, report.original_point[v], pslg.points[v]);
  }
  if (named < boundary.open_ends.size())
    text += " and at " + std::to_string(boundary.open_ends.size() - named) + " more";
  return text;
}

}  // namespace driftmesh
