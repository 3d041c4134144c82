#include "job/rank_report.hpp"

#include <algorithm>

#include "distributed/census.hpp"
#include "distributed/held_subdomains.hpp"
#include "job/mesh_facts.hpp"

namespace driftmesh::job {
namespace {

/// Subsegments of the input on roots whose points this subdomain numbers.
std::int64_t owned_subsegments(const Decomposition& d, const SubdomainCensus& census) {
  std::int64_t count = 0;
  for (const SubdomainCensus::Root& r : census.roots) {
    const Decomposition::Root& root = d.roots[r.root];
    if (!root.separator && owner_of(root) == census.id) count += static_cast<std::int64_t>(r.splits.count) + 1;
  }
  return count;
}

}  // namespace

void RankReport::write(ByteWriter& writer) const {
  writer.value(rank);
  write_facts(writer, facts);
}

RankReport RankReport::read(ByteReader& reader) {
  RankReport report;
  reader.value(report.rank);
  report.facts = read_facts(reader);
  return report;
}

void add_subdomain(MeshFacts& facts, const Decomposition& decomposition, const QualityBounds& bounds,
                   const Subdomain& subdomain) {
  MeshFacts own;
  show_subdomain(subdomain, [&](SubdomainId id, const SubdomainMesh& part) {
    add_part(own, part.mesh, bounds, true);
    const SubdomainCensus census = census_of(decomposition, id, part);
    own.vertices = owned_points(decomposition, census);
    own.subsegments = owned_subsegments(decomposition, census);
  });
  add_counters(own, subdomain.counters());
  add_facts(facts, own);
}

RankReport report_of(const RankLoop& loop, const RunPlan& plan) {
  RankReport report;
  static_cast<RankOutcome&>(report.rank) = loop.outcome();
  for (const auto& [id, subdomain] : loop.subdomains())
    add_subdomain(report.facts, plan.decomposition, plan.bounds, subdomain);
  return report;
}

void add_report(RunRecord& run, const RankReport& report) {
  add_facts(run, report.facts);
  run.ranks.push_back(report.rank);
  run.seconds_refine = std::max(run.seconds_refine, report.rank.times.total());
  run.peak += report.rank.peak;
  run.peak_refining = run.peak;
}

void add_plan(RunRecord& run, const RunPlan& plan) {
  run.vertices += static_cast<std::int64_t>(plan.decomposition.points.size());
  run.subdomains = static_cast<std::int32_t>(plan.decomposition.size());
  run.presplit = plan.presplit;
}

void add_prepared(RunRecord& run, const Prepared& prepared) {
  run.acute_corners = prepared.acute_corners;
  run.forecast = prepared.forecast;
  run.max_area = prepared.plan.bounds.max_area;
}

}  // namespace driftmesh::job
