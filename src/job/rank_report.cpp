#include "job/rank_report.hpp"

#include <algorithm>

#include "job/mesh_facts.hpp"

namespace driftmesh::job {
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

RankReport report_of(const RankOutcome& outcome, const std::map<SubdomainId, Subdomain>& subdomains,
                     const RunPlan& plan, FactsBook& book) {
  RankReport report;
  static_cast<RankOutcome&>(report.rank) = outcome;
  for (const auto& [id, subdomain] : subdomains) {
    if (!book.has(id)) book.note(subdomain, plan.bounds);
    add_facts(report.facts, book.of(id));
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
  run.max_area = prepared.plan.bounds.plain.area;
}

}  // namespace driftmesh::job
