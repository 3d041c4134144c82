#include "decompose/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {

void list_roots(Decomposition& d) {
  const auto each_side = [&](auto&& visit) {
    for (const GlobalRootId r : ids_of(d.roots)) {
      const Decomposition::Root& root = d.roots[r];
      if (root.left != kNoSubdomain) visit(root.left, r);
      if (root.right != kNoSubdomain && root.right != root.left) visit(root.right, r);
    }
  };
  d.root_begin.assign(d.size() + 1, 0);
  each_side([&](SubdomainId s, GlobalRootId) { ++d.root_begin[to_index(s) + 1]; });
  for (std::size_t i = 0; i < d.size(); ++i) d.root_begin[i + 1] += d.root_begin[i];
  d.root_list.resize(to_index(d.root_begin.back()));
  IdVector<SubdomainId, std::int32_t> end(d.root_begin.begin(), d.root_begin.end() - 1);
  each_side([&](SubdomainId s, GlobalRootId r) { d.root_list[to_index(end[s]++)] = r; });
}

std::vector<Interface> interfaces(const Decomposition& d) {
  std::vector<Interface> all;
  for (const Decomposition::Root& root : d.roots) {
    if (!root.is_interface()) continue;
    const Point &a = d.points[root.a], &b = d.points[root.b];
    all.push_back(
        {std::min(root.left, root.right), std::max(root.left, root.right), std::sqrt(squared_distance(a, b))});
  }
  const auto pair = [](const Interface& i) { return std::pair(i.first, i.second); };
  std::stable_sort(all.begin(), all.end(), [&](const auto& i, const auto& j) { return pair(i) < pair(j); });
  std::vector<Interface> merged;
  for (const Interface& i : all)
    if (!merged.empty() && pair(merged.back()) == pair(i))
      merged.back().length += i.length;
    else
      merged.push_back(i);
  return merged;
}

}  // namespace driftmesh
