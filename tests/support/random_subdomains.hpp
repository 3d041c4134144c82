#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "decompose/decompose.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/cdt.hpp"
#include "mesh/corners.hpp"
#include "mesh/exceptions.hpp"
#include "migration/subdomain.hpp"
#include "oracles/random_pslg.hpp"

namespace driftmesh::testing {

/// Fine at one point, growing with the distance.
class RadialField final : public SizeField {
 public:
  RadialField(Point center, double least, double growth) : center_(center), least_(least), growth_(growth) {}
  [[nodiscard]] double edge_length(const Point& p) const override {
    return least_ + growth_ * std::sqrt((p.x - center_.x) * (p.x - center_.x) + (p.y - center_.y) * (p.y - center_.y));
  }

 private:
  Point center_;
  double least_, growth_;
};

/// A random domain cut into subdomains, with random bounds: some with regions that have their own bounds, some with a
/// size field. About `triangles` triangles in all.
class RandomSubdomains {
 public:
  RandomSubdomains(std::uint64_t seed, int subdomains, double triangles) : random_(seed) {
    const oracles::RandomPslg pslg = oracles::make_random_pslg(seed, oracles::make_random_shape(seed));
    Triangulation mesh = triangulate(pslg.input);
    prepare_corners(mesh);
    DecomposeOptions options;
    options.subdomains = subdomains;
    decomposition_ = decompose(mesh, options);
    choose_bounds(pslg.input, summarize_angles(mesh).total_area, triangles);
    context_.decomposition = &decomposition_;
    context_.presplit = random_() % 2 == 0;
  }
  RandomSubdomains(const RandomSubdomains&) = delete;
  RandomSubdomains& operator=(const RandomSubdomains&) = delete;

  [[nodiscard]] const SubdomainContext& context() const { return context_; }
  [[nodiscard]] std::size_t size() const { return decomposition_.size(); }
  [[nodiscard]] std::mt19937_64& random() { return random_; }
  /// A point of depth up to `deepest` that a neighbor might put on the border of subdomain i.
  [[nodiscard]] SplitPoint<GlobalRootId> split_of(SubdomainId i, int deepest) {
    const auto roots = decomposition_.roots_of(i);
    const GlobalRootId root = roots[random_() % roots.size()];
    return {root, 1 + random_() % ((std::uint64_t{1} << deepest) - 1)};
  }

 private:
  void choose_bounds(const Pslg& input, double area, double triangles) {
    QualityBounds& bounds = context_.bounds;
    bounds.min_angle = random_() % 2 == 0 ? 20 : 26;
    bounds.plain.area = area / triangles * 1.5;
    if (!input.regions.empty() && random_() % 2 == 0) {
      bounds.region_max_area.assign(input.regions.size() + 1, 0);
      for (double& bound : bounds.region_max_area) bound = random_() % 2 == 0 ? 0 : bounds.plain.area / 3;
      bounds.region_max_area[0] = 0;  // outside all regions
    }
    if (random_() % 3 != 0) return;
    const double h = std::sqrt(area / triangles);
    field_ = std::make_unique<RadialField>(decomposition_.points.front(), h / 2, 0.1);
    bounds.size = field_.get();
  }

  std::mt19937_64 random_;
  Decomposition decomposition_;
  std::unique_ptr<SizeField> field_;
  SubdomainContext context_;
};

}  // namespace driftmesh::testing
