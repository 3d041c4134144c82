#include "picture/plot_decomposition.hpp"

#include <cstdint>
#include <vector>

#include "base/words.hpp"
#include "decompose/subdomain_mesh.hpp"
#include "picture/plot.hpp"

namespace driftmesh {
namespace {

/// Greedy coloring of the subdomain graph: the least used color that no neighbor has.
IdVector<SubdomainId, int> color_subdomains(const Decomposition& d) {
  IdVector<SubdomainId, std::vector<SubdomainId>> neighbors(d.size());
  for (const Interface& i : interfaces(d)) {
    neighbors[i.first].push_back(i.second);
    neighbors[i.second].push_back(i.first);
  }
  IdVector<SubdomainId, int> color(d.size(), -1);
  std::vector<std::size_t> uses(6, 0);
  for (const SubdomainId i : ids_of(d.subdomains)) {
    std::vector<bool> taken(uses.size(), false);
    for (const SubdomainId n : neighbors[i])
      if (const int c = color[n]; c >= 0) taken[to_index(c)] = true;
    std::size_t best = uses.size();
    for (std::size_t c = 0; c < uses.size(); ++c)
      if (!taken[c] && (best == uses.size() || uses[c] < uses[best])) best = c;
    if (best == uses.size()) uses.push_back(0);
    color[i] = static_cast<int>(best);
    ++uses[best];
  }
  return color;
}

/// The subdomains as a mesh whose regions are their colors.
Mesh colored_subdomains(const Decomposition& d) {
  const IdVector<SubdomainId, int> color = color_subdomains(d);
  Mesh piece;
  piece.points = d.points;
  for (const SubdomainId i : ids_of(d.subdomains)) {
    const SubdomainMesh part = subdomain_triangulation(d, i);
    for (const Triangle& t : part.mesh.triangles) {
      if (!t.alive()) continue;
      const auto global = [&](VertexId v) { return to_int(part.points[v]); };
      piece.triangles.push_back({global(t.vertex[0]), global(t.vertex[1]), global(t.vertex[2])});
      piece.regions.push_back(color[i] + 1);
    }
  }
  for (const Decomposition::Root& r : d.roots) piece.edges.push_back({to_int(r.a), to_int(r.b), r.marker});
  return piece;
}

}  // namespace

void plot_decomposition(const Decomposition& d, const std::string& path, const std::string& title) {
  PlotOptions options;
  options.color = PlotColor::kRegion;
  options.edges = PlotEdges::kOff;
  options.title = title;
  options.subtitle = grouped(static_cast<std::int64_t>(interfaces(d).size())) + " interfaces";
  options.legend = false;
  plot_mesh(colored_subdomains(d), path, options);
}

}  // namespace driftmesh
