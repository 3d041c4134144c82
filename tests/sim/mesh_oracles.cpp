#include "sim/mesh_oracles.hpp"

#include <bit>
#include <set>
#include <unordered_map>
#include <utility>

#include "verify/report_text.hpp"
#include "verify/verify.hpp"

namespace driftmesh::sim {
namespace {

struct BitsOfPoint {
  std::size_t operator()(const Point& p) const {
    const auto x = std::bit_cast<std::uint64_t>(p.x + 0.0), y = std::bit_cast<std::uint64_t>(p.y + 0.0);
    return static_cast<std::size_t>((x * 0x9e3779b97f4a7c15u) ^ (y * 0xc2b2ae3d27d4eb4fu));
  }
};

class Merge {
 public:
  Merge(const Domain& domain, const Decomposition& decomposition) : domain_(domain), decomposition_(decomposition) {}

  void add(const Subdomain& subdomain) {
    const Triangulation& mesh = subdomain.mesh().mesh;
    const auto number = [&](VertexId v) { return number_of(mesh.points[v]); };
    for (const TriangleId t : ids_of(mesh.triangles)) {
      if (!mesh.triangles[t].alive()) continue;
      const auto& v = mesh.triangles[t].vertex;
      piece_.triangles.push_back({number(v[0]), number(v[1]), number(v[2])});
      piece_.subdomains.push_back(to_int(subdomain.id()));
      if (domain_.input().regions.empty()) continue;
      const std::size_t label = mesh.region.empty() ? 0 : mesh.region[t];
      piece_.regions.push_back(label == 0 ? 0 : domain_.input().regions[label - 1].attribute);
    }
    for (const Subsegment& s : mesh.subsegments) {
      if (!s.is_leaf()) continue;
      const Decomposition::Root& root = decomposition_.roots[subdomain.mesh().roots[s.root]];
      if (root.separator) continue;
      const std::pair<std::int32_t, std::int32_t> ends = std::minmax(number(s.vertex[0]), number(s.vertex[1]));
      if (edges_.insert(ends).second) piece_.edges.push_back({ends.first, ends.second, root.marker});
    }
  }
  Mesh take() { return std::move(piece_); }

 private:
  std::int32_t number_of(const Point& p) {
    const auto [entry, is_new] = numbers_.try_emplace(p, static_cast<std::int32_t>(piece_.points.size()));
    if (is_new) piece_.points.push_back(p);
    return entry->second;
  }

  const Domain& domain_;
  const Decomposition& decomposition_;
  Mesh piece_;
  std::unordered_map<Point, std::int32_t, BitsOfPoint> numbers_;
  std::set<std::pair<std::int32_t, std::int32_t>> edges_;
};

}  // namespace

Mesh merge(const Domain& domain, const Decomposition& decomposition, const std::vector<const Subdomain*>& subdomains) {
  Merge merging(domain, decomposition);
  for (const Subdomain* s : subdomains) merging.add(*s);
  return merging.take();
}

std::string verdict_on_mesh(const Domain& domain, const Decomposition& decomposition,
                            const std::vector<const Subdomain*>& subdomains) {
  VerifyOptions options;
  options.min_angle = domain.bounds().min_angle;
  options.plain.area = domain.bounds().plain.area;
  options.size = domain.bounds().size;
  const VerifyReport report = verify(merge(domain, decomposition, subdomains), domain.input(), options);
  return report.accepted() ? "" : report_text(report, options);
}

}  // namespace driftmesh::sim
