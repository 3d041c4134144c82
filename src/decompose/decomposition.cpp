#include "decompose/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/triangle_geometry.hpp"

namespace driftmesh {

void list_roots(Decomposition& d) {
  const auto each_side = [&](auto&& visit) {
    for (std::size_t r = 0; r < d.roots.size(); ++r) {
      const Decomposition::Root& root = d.roots[r];
      if (root.left != kNone) visit(root.left, static_cast<RootId>(r));
      if (root.right != kNone && root.right != root.left) visit(root.right, static_cast<RootId>(r));
    }
  };
  d.root_begin.assign(d.size() + 1, 0);
  each_side([&](SubdomainId s, RootId) { ++d.root_begin[static_cast<std::size_t>(s) + 1]; });
  for (std::size_t i = 0; i < d.size(); ++i) d.root_begin[i + 1] += d.root_begin[i];
  d.root_list.assign(static_cast<std::size_t>(d.root_begin.back()), kNone);
  std::vector<std::int32_t> end(d.root_begin.begin(), d.root_begin.end() - 1);
  each_side(
      [&](SubdomainId s, RootId r) { d.root_list[static_cast<std::size_t>(end[static_cast<std::size_t>(s)]++)] = r; });
}

std::vector<Interface> interfaces(const Decomposition& d) {
  std::vector<Interface> all;
  for (const Decomposition::Root& root : d.roots) {
    if (root.left == kNone || root.right == kNone || root.left == root.right) continue;
    const Point &a = d.points[static_cast<std::size_t>(root.a)], &b = d.points[static_cast<std::size_t>(root.b)];
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
