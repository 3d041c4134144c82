#include "adapt/granularity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/disjoint_sets.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {
namespace {

double mean_of(const IdVector<SubdomainId, double>& asked, std::int32_t shares) {
  double all = 0;
  for (const double triangles : asked) all += triangles;
  return std::max(all / shares, kSmall / kHeavy);
}

/// For each subdomain those across separators, the longest border first.
IdVector<SubdomainId, std::vector<SubdomainId>> neighbors_across_separators(const Decomposition& d) {
  std::map<std::pair<SubdomainId, SubdomainId>, double> lengths;
  for (const Decomposition::Root& root : d.roots)
    if (root.separator)
      lengths[std::minmax(root.left, root.right)] += std::sqrt(squared_distance(d.points[root.a], d.points[root.b]));
  std::vector<std::tuple<double, SubdomainId, SubdomainId>> borders;
  for (const auto& [pair, length] : lengths) borders.emplace_back(-length, pair.first, pair.second);
  std::ranges::sort(borders);
  IdVector<SubdomainId, std::vector<SubdomainId>> neighbors(d.size());
  for (const auto& [length, first, second] : borders) {
    neighbors[first].push_back(second);
    neighbors[second].push_back(first);
  }
  return neighbors;
}

}  // namespace

std::vector<std::pair<SubdomainId, std::int32_t>> heavy_ones(const IdVector<SubdomainId, double>& asked,
                                                             std::int32_t shares) {
  constexpr double kMost = 64;
  const double mean = mean_of(asked, shares);
  std::vector<std::pair<SubdomainId, std::int32_t>> heavy;
  for (const SubdomainId s : ids_of(asked))
    if (asked[s] > kHeavy * mean)
      heavy.emplace_back(s, static_cast<std::int32_t>(std::lround(std::min(asked[s] / mean, kMost))));
  return heavy;
}

IdVector<SubdomainId, SubdomainId> light_groups(const Decomposition& decomposition,
                                                const IdVector<SubdomainId, double>& asked, std::int32_t shares) {
  constexpr std::size_t kWorthIt = 16;  // one of so many
  const double mean = mean_of(asked, shares);
  std::vector<std::pair<double, SubdomainId>> light;
  for (const SubdomainId s : ids_of(asked))
    if (asked[s] < kLight * mean) light.emplace_back(asked[s], s);
  if (light.size() <= decomposition.size() / kWorthIt) return {};
  std::ranges::sort(light);
  const auto neighbors = neighbors_across_separators(decomposition);
  DisjointSets<SubdomainId> groups(decomposition.size());
  IdVector<SubdomainId, double> together = asked;  // what is asked of each group, at its lowest number
  std::size_t gone = 0;
  for (const auto& [own, s] : light) {
    const SubdomainId group = groups.find(s);
    if (together[group] >= kLight * mean) continue;
    for (const SubdomainId t : neighbors[s]) {
      const SubdomainId other = groups.find(t);
      const double sum = together[group] + together[other];
      if (other == group || sum > mean) continue;
      groups.join(group, other);
      together[groups.find(s)] = sum;
      ++gone;
      break;
    }
  }
  if (gone == 0 || gone < decomposition.size() / kWorthIt) return {};
  IdVector<SubdomainId, SubdomainId> group;
  for (const SubdomainId s : ids_of(asked)) group.push_back(groups.find(s));
  return group;
}

}  // namespace driftmesh::adapt
