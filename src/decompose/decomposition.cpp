#include "decompose/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
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

void list_inner_points(Decomposition& d, std::vector<std::pair<SubdomainId, GlobalPointId>> inner) {
  std::ranges::sort(inner);
  d.point_begin.assign(d.size() + 1, 0);
  d.point_list.clear();
  for (const auto& [s, point] : inner) {
    ++d.point_begin[to_index(s) + 1];
    d.point_list.push_back(point);
  }
  for (std::size_t i = 0; i < d.size(); ++i) d.point_begin[i + 1] += d.point_begin[i];
}

std::vector<Interface> interfaces(const Decomposition& d) {
  std::vector<std::int32_t> begin(d.size() + 1, 0);  // where each subdomain's interfaces begin; later, where they end
  const auto each = [&](auto&& visit) {
    for (const Decomposition::Root& root : d.roots)
      if (root.is_interface()) visit(root, std::min(root.left, root.right), std::max(root.left, root.right));
  };
  each([&](const auto&, SubdomainId first, SubdomainId) { ++begin[to_index(first) + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Interface> all(to_index(begin.back()));
  each([&](const Decomposition::Root& root, SubdomainId first, SubdomainId second) {
    const double length = std::sqrt(squared_distance(d.points[root.a], d.points[root.b]));
    all[to_index(begin[to_index(first)]++)] = {first, second, length};
  });
  std::size_t merged = 0;
  for (std::size_t i = 0, of = 0; of < d.size(); ++of) {
    const std::size_t end = to_index(begin[of]);
    std::stable_sort(all.begin() + i, all.begin() + end,
                     [](const Interface& a, const Interface& b) { return a.second < b.second; });
    for (const std::size_t none = merged; i < end; ++i)
      if (merged > none && all[merged - 1].second == all[i].second)
        all[merged - 1].length += all[i].length;
      else
        all[merged++] = all[i];
  }
  all.resize(merged);
  return all;
}

}  // namespace driftmesh
