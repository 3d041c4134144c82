#include "verify/verify.hpp"

#include <optional>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "verify/chains.hpp"
#include "verify/corner_table.hpp"
#include "verify/domain.hpp"
#include "verify/domain_check.hpp"
#include "verify/local_check.hpp"
#include "verify/point_index.hpp"
#include "verify/subsegments.hpp"

namespace driftmesh {
namespace {

VerifyReport verify_against(const MeshPiece& mesh, const Pslg* input, const VerifyOptions& options) {
  VerifyReport report;
  Findings findings(options.max_listed);
  report.points = mesh.points.size();
  report.triangles = mesh.triangles.size();
  report.subsegments = mesh.edges.size();
  report.subsegments_listed = !mesh.edges.empty() || mesh.triangles.empty();
  if (!check_arrays(mesh, findings)) {
    report.findings = std::move(findings);
    return report;
  }

  const CornerTable corners(mesh);
  PointIndex points(mesh.points);
  const std::size_t used = check_points(mesh, corners, points, findings);
  report.unused_points = mesh.points.size() - used;
  if (findings.count(Flaw::bad_coordinate) != 0) {
    report.findings = std::move(findings);
    return report;
  }

  std::optional<Domain> domain;
  if (input != nullptr) {
    domain.emplace(*input);
    if (domain->conflict()) {
      findings.add(Flaw::input_not_planar, [&] { return *domain->conflict(); });
      domain.reset();
    }
  }

  Subsegments subsegments(mesh.points.size(), report.subsegments_listed ? mesh.edges : boundary_edges(mesh, corners));
  std::optional<DisjointSets> parts;
  if (domain && domain->has_regions()) parts.emplace(mesh.triangles.size());
  LocalCheck local(mesh, corners, subsegments, findings);
  local.check_orientations();
  local.check_vertices(parts ? &*parts : nullptr, options.check_delaunay);
  check_subsegments(mesh, subsegments, findings);
  report.boundary_edges = local.boundary().size();
  check_embedding(mesh, local.boundary(), findings);

  std::vector<char> corner;
  if (domain) corner = DomainCheck::find_corners(mesh, *domain, points);
  const Chains chains(mesh, subsegments, [&](std::int32_t v) {
    return domain ? corner[static_cast<std::size_t>(v)] != 0 : bends_at(mesh, subsegments, v);
  });
  CheckedBounds bounds{options.min_angle, options.max_area, {}, options.size, options.max_listed};
  std::optional<DomainCheck> against;
  if (domain) {
    against.emplace(mesh, *domain, points, chains, findings);
    against->check_points();
    against->check_chains();
    against->check_euler(static_cast<std::int64_t>(used), static_cast<std::int64_t>(report.boundary_edges));
    if (parts) {
      against->find_faces(*parts);
      report.regions_listed = !mesh.regions.empty() || mesh.triangles.empty();
      if (report.regions_listed) against->check_regions();
      if (options.region_areas) bounds.region_area = [&](std::size_t t) { return against->region_area(t); };
    }
  }
  report.quality = check_quality(mesh, chains, bounds, findings);
  report.area = report.quality.total_area;
  if (domain) {
    against->check_area(report.area);
    report.against_input = true;
    report.input_area = domain->area();
  }
  report.findings = std::move(findings);
  return report;
}

}  // namespace

VerifyReport verify(const MeshPiece& mesh, const VerifyOptions& options) {
  return verify_against(mesh, nullptr, options);
}

VerifyReport verify(const MeshPiece& mesh, const Pslg& input, const VerifyOptions& options) {
  return verify_against(mesh, &input, options);
}

}  // namespace driftmesh
