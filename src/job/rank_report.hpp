#pragma once

#include <map>

#include "base/bytes.hpp"
#include "job/facts_book.hpp"
#include "job/prepare.hpp"
#include "job/record.hpp"
#include "job/team.hpp"
#include "migration/subdomain.hpp"
#include "runtime/rank_outcome.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// What one rank of a parallel run reports to rank 0 at the end.
struct RankReport {
  RunRecord::Rank rank;
  MeshFacts facts;  ///< vertices and subsegments on roots count for the rank that numbers them

  void write(ByteWriter& writer) const;
  [[nodiscard]] static RankReport read(ByteReader& reader);
};

/// The report of a rank whose loop has ended with these subdomains of `plan`. Those that are not in the book yet are
/// noted there.
[[nodiscard]] RankReport report_of(const RankOutcome& outcome, const std::map<SubdomainId, Subdomain>& subdomains,
                                   const RunPlan& plan, FactsBook& book);

/// Adds the report of a rank to the record of its run.
void add_report(RunRecord& run, const RankReport& report);

/// Adds the facts that all ranks share and none reports.
void add_plan(RunRecord& run, const RunPlan& plan);

/// Adds the results of preparing the run.
void add_prepared(RunRecord& run, const Prepared& prepared);

}  // namespace driftmesh::job
