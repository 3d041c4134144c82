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

RankReport report_of(const RankLoop& loop, const RunPlan& plan) {
  RankReport report;
  static_cast<RankOutcome&>(report.rank) = loop.outcome();
  const HeldSubdomains held = held_by_rank(loop.subdomains());
  held([&](SubdomainId, const SubdomainMesh& part) { add_part(report.facts, part.mesh, plan.bounds, true); });
  for (const auto& [id, subdomain] : loop.subdomains()) add_counters(report.facts, subdomain.counters());
  report.facts.vertices = report.facts.subsegments = 0;  // add_part counts shared ones in each part
  for (const SubdomainCensus& census : take_census(plan.decomposition, held)) {
    report.facts.vertices += owned_points(plan.decomposition, census);
    report.facts.subsegments += owned_subsegments(plan.decomposition, census);
  }
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
