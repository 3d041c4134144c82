#include "verify/verify.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/in_parts.hpp"
#include "mesh/merge_pieces.hpp"
#include "verify/chains.hpp"
#include "verify/corner_table.hpp"
#include "verify/domain.hpp"
#include "verify/domain_check.hpp"
#include "verify/local_check.hpp"
#include "verify/point_data_check.hpp"
#include "verify/point_index.hpp"
#include "verify/subsegments.hpp"

namespace driftmesh {
namespace {

/// One verification: its phases in order, and what later ones need from earlier ones.
class Verification {
 public:
  Verification(const Mesh& mesh, const Pslg* input, const VerifyOptions& options)
      : mesh_(mesh), input_(input), options_(options), findings_(options.max_listed), points_(mesh.points) {}

  VerifyReport run() {
    count();
    if (check_arrays(mesh_, findings_) && check_coordinates()) {
      find_domain();
      check_triangulation();
      check_against_domain();
    }
    report_.findings = std::move(findings_);
    return std::move(report_);
  }

 private:
  void count() {
    report_.points = mesh_.points.size();
    report_.triangles = mesh_.triangles.size();
    report_.subsegments = mesh_.edges.size();
    report_.subsegments_listed = !mesh_.edges.empty() || mesh_.triangles.empty();
  }

  /// False if there are coordinates that no check could compute with.
  bool check_coordinates() {
    corners_.emplace(mesh_);
    used_points_ = check_points(mesh_, *corners_, points_, findings_);
    report_.unused_points = mesh_.points.size() - used_points_;
    return findings_.count(Flaw::bad_coordinate) == 0;
  }

  void find_domain() {
    if (input_ == nullptr) return;
    domain_.emplace(*input_);
    if (domain_->conflict()) {
      findings_.add(Flaw::input_not_planar, [&] { return *domain_->conflict(); });
      domain_.reset();
    } else if (domain_->has_regions()) {
      parts_.emplace(mesh_.triangles.size());
    }
  }

  void check_triangulation() {
    subsegments_.emplace(mesh_.points.size(),
                         report_.subsegments_listed ? mesh_.edges : boundary_edges(mesh_, *corners_));
    const LocalCheck local = check_locally();
    findings_.append(local.findings());
    check_subsegments(mesh_, *subsegments_, findings_);
    check_embedding(mesh_, local.boundary(), findings_);
    report_.boundary_edges = local.boundary().size();
    note_interfaces(local.interfaces());
    corners_.reset();
  }

  /// Joining triangles is not for several threads.
  LocalCheck check_locally() {
    const std::size_t threads = parts_ ? 1 : std::max<std::size_t>(options_.threads, 1);
    std::vector<LocalCheck> checks(threads, {mesh_, *corners_, *subsegments_, options_.max_listed});
    in_parts(mesh_.triangles.size(), threads, [&](std::size_t part, std::size_t begin, std::size_t end) {
      checks[part].check_orientations(begin, end);
    });
    in_parts(mesh_.points.size(), threads, [&](std::size_t part, std::size_t begin, std::size_t end) {
      checks[part].check_vertices(begin, end, parts_ ? &*parts_ : nullptr, options_.check_delaunay);
    });
    for (std::size_t part = 1; part < threads; ++part) checks[0].append(checks[part]);
    return std::move(checks[0]);
  }

  void note_interfaces(const Interfaces& interfaces) {
    std::vector<std::int32_t> subdomains = mesh_.subdomains;
    subdomains.erase(std::unique(subdomains.begin(), subdomains.end()), subdomains.end());
    report_.subdomains = std::set(subdomains.begin(), subdomains.end()).size();
    report_.interfaces = interfaces.subdomains.size();
    report_.interface_edges = interfaces.edges;
    report_.interface_edges_not_delaunay = interfaces.not_delaunay;
    report_.rank_interface_edges = interfaces.between_ranks;
  }

  void check_against_domain() {
    const Chains chains = make_chains();
    if (!domain_) return take_quality(chains, {});
    DomainCheck against(mesh_, *domain_, points_, chains, findings_);
    against.check_points();
    check_point_data(mesh_, *input_, points_, findings_);
    against.check_chains();
    against.check_euler(static_cast<std::int64_t>(used_points_), static_cast<std::int64_t>(report_.boundary_edges));
    if (parts_) check_regions(against);
    const bool by_region = parts_ && options_.region_areas;
    take_quality(chains, by_region ? RegionArea([&](std::size_t t) { return against.region_area(t); }) : RegionArea());
    against.check_area(report_.area);
    report_.against_input = true;
    report_.input_area = domain_->area();
  }

  [[nodiscard]] Chains make_chains() const {
    if (!domain_) return {mesh_, *subsegments_, [&](std::int32_t v) { return bends_at(mesh_, *subsegments_, v); }};
    const std::vector<char> corner = DomainCheck::find_corners(mesh_, *domain_, points_);
    return {mesh_, *subsegments_, [&](std::int32_t v) { return corner[v] != 0; }};
  }

  void check_regions(DomainCheck& against) {
    against.find_faces(*parts_);
    report_.regions_listed = !mesh_.regions.empty() || mesh_.triangles.empty();
    if (report_.regions_listed) against.check_regions();
  }

  using RegionArea = std::function<double(std::size_t)>;
  void take_quality(const Chains& chains, const RegionArea& region_area) {
    const CheckedBounds bounds{options_.min_angle,    options_.max_area,   region_area,     options_.size,
                               options_.size_spacing, options_.max_listed, options_.threads};
    report_.quality = check_quality(mesh_, chains, bounds, findings_);
    report_.area = report_.quality.total_area;
  }

  const Mesh& mesh_;
  const Pslg* input_;
  const VerifyOptions& options_;
  VerifyReport report_;
  Findings findings_;
  PointIndex points_;  // of the mesh, by coordinates
  std::size_t used_points_ = 0;
  std::optional<CornerTable> corners_;
  std::optional<Domain> domain_;
  std::optional<DisjointSets<std::int32_t>> parts_;  // triangles that subsegments do not separate, if there are regions
  std::optional<Subsegments> subsegments_;
};

}  // namespace

VerifyReport verify(const Mesh& mesh, const VerifyOptions& options) {
  return Verification(mesh, nullptr, options).run();
}

VerifyReport verify(const Mesh& mesh, const Pslg& input, const VerifyOptions& options) {
  return Verification(mesh, &input, options).run();
}

VerifyReport verify_pieces(std::span<const Mesh> pieces, const Pslg* input, const VerifyOptions& options) {
  MergeFaults faults;
  const Mesh whole = merge_pieces(pieces, faults);
  VerifyReport report = Verification(whole, input, options).run();
  report.pieces = pieces.size();
  for (std::size_t i = 0; i < faults.count; ++i)
    report.findings.add(Flaw::pieces_disagree, [&] { return i < faults.first.size() ? faults.first[i] : "..."; });
  return report;
}

}  // namespace driftmesh
