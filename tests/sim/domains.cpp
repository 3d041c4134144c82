#include "sim/domains.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "decompose/decompose.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/digest.hpp"
#include "migration/subdomain.hpp"

namespace driftmesh::sim {
namespace {

/// The ingredients of a domain before it is triangulated.
struct Recipe {
  Pslg input;
  QualityBounds bounds{20, {0}, {}, nullptr};
  std::unique_ptr<SizeField> size;
};

void add_ring(Pslg& pslg, const std::vector<Point>& ring, std::int32_t marker) {
  const auto first = static_cast<std::int32_t>(pslg.points.size()), n = static_cast<std::int32_t>(ring.size());
  pslg.points.insert(pslg.points.end(), ring.begin(), ring.end());
  for (std::int32_t i = 0; i < n; ++i) pslg.segments.push_back({first + i, first + (i + 1) % n, marker});
}

Recipe square() {
  Recipe r;
  add_ring(r.input, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1);
  r.bounds.plain.area = 0.005;
  return r;
}

Recipe ell() {
  Recipe r;
  add_ring(r.input, {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 1);
  add_ring(r.input, {{0.3, 0.3}, {0.6, 0.3}, {0.6, 0.6}, {0.3, 0.6}}, 2);
  r.input.holes = {{0.45, 0.45}};
  r.bounds.plain.area = 0.015;
  return r;
}

/// A corner of 22 degrees that a segment halves, and slits at 4 and 0.5 degrees: the angles alone make most points.
Recipe wedge() {
  Recipe r;
  add_ring(r.input, {{0, 0}, {3, 0}, {3, 1.2}}, 1);
  r.input.points.insert(r.input.points.end(), {{2, 0.4}, {2.9, 0.2}, {2.3, 0.242}, {2.5, 0.75}, {2.6, 0.9}});
  r.input.segments.insert(r.input.segments.end(), {{0, 3, 2}, {4, 5, 3}, {5, 3, 3}, {6, 7, 4}});
  r.bounds.min_angle = 25;
  r.bounds.plain.area = 0.1;
  return r;
}

/// Two disconnected pieces, one of them with an island in a hole.
Recipe apart() {
  Recipe r;
  add_ring(r.input, {{0, 0}, {1, 0.1}, {1.2, 1}, {0.1, 1.1}}, 1);
  add_ring(r.input, {{2, 0}, {4, 0}, {4, 2}, {2, 2}}, 2);
  add_ring(r.input, {{2.5, 0.5}, {3.5, 0.5}, {3.5, 1.5}, {2.5, 1.5}}, 3);
  add_ring(r.input, {{2.8, 0.8}, {3.2, 0.8}, {3.1, 1.2}, {2.9, 1.2}}, 4);
  r.input.holes = {{2.6, 0.6}};
  r.bounds.plain.area = 0.03;
  return r;
}

/// Three regions with their own bounds.
Recipe regions() {
  Recipe r;
  add_ring(r.input, {{0, 0}, {0.8, 0}, {2, 0}, {2, 0.6}, {2, 1}, {0.9, 1}, {0, 1}}, 1);
  r.input.segments.insert(r.input.segments.end(), {{1, 5, 2}, {1, 3, 3}});
  r.input.regions = {{{0.4, 0.5}, 1, 0.004}, {{1.7, 0.1}, 2, 0.05}, {{1.5, 0.8}, 3, 0.015}};
  r.bounds.region_max_area = {0, 0.004, 0.05, 0.015};
  return r;
}

/// Edges of length 0.04 at one point, growing with the distance.
class Radial final : public SizeField {
 public:
  [[nodiscard]] double edge_length(const Point& p) const override {
    return 0.04 + 0.25 * std::sqrt((p.x - 0.3) * (p.x - 0.3) + (p.y - 0.6) * (p.y - 0.6));
  }
};

Recipe sized() {
  Recipe r = square();
  r.size = std::make_unique<Radial>();
  r.bounds.plain.area = 0;
  r.bounds.size = r.size.get();
  return r;
}

const std::vector<std::pair<std::string, Recipe (*)()>>& recipes() {
  static const std::vector<std::pair<std::string, Recipe (*)()>> kAll{
      {"square", square}, {"ell", ell}, {"wedge", wedge}, {"apart", apart}, {"regions", regions}, {"sized", sized}};
  return kAll;
}

Recipe recipe(const std::string& name) {
  for (const auto& [known, make] : recipes())
    if (known == name) return make();
  std::string known;
  for (const std::string& n : domain_names()) known += " " + n;
  throw Error("unknown domain '" + name + "'; known are" + known);
}

}  // namespace

const std::vector<std::string>& domain_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& [name, make] : recipes()) names.push_back(name);
    return names;
  }();
  return kNames;
}

Domain::Domain(const std::string& name) {
  Recipe r = recipe(name);
  if (repair(r.input).changed()) throw Error("the domain '" + name + "' needs repair");
  input_ = std::move(r.input);
  bounds_ = std::move(r.bounds);
  size_ = std::move(r.size);
  mesh_ = triangulate(input_);
  prepare_corners(mesh_);
}

const Decomposition& Domain::cut(std::int32_t subdomains) {
  const auto known = cuts_.find(subdomains);
  if (known != cuts_.end()) return known->second;
  DecomposeOptions options;
  options.subdomains = subdomains;
  options.bounds = bounds_;
  return cuts_.emplace(subdomains, decompose(mesh_, options)).first->second;
}

std::optional<std::uint64_t> Domain::digest_alone(std::int32_t subdomains) {
  const auto known = digests_.find(subdomains);
  if (known != digests_.end()) return known->second;
  const Decomposition& decomposition = cut(subdomains);
  const SubdomainContext context{&decomposition, bounds_, true};
  std::uint64_t sum = 0;
  std::vector<SplitPoint<GlobalRootId>> said;
  for (const SubdomainId s : first_ids<SubdomainId>(decomposition.size())) {
    Subdomain subdomain(s, context);
    subdomain.work(std::numeric_limits<std::int64_t>::max(), said);
    sum += mesh_digest(subdomain.mesh().mesh);
  }
  std::optional<std::uint64_t> digest;
  if (said.empty()) digest = sum;
  return digests_[subdomains] = digest;
}

Domain& Domains::operator[](const std::string& name) {
  std::unique_ptr<Domain>& domain = made_[name];
  if (!domain) domain = std::make_unique<Domain>(name);
  return *domain;
}

}  // namespace driftmesh::sim
