#pragma once

#include "app/run_record.hpp"
#include "base/byte_stream.hpp"
#include "runtime/rank_loop.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::app {

/// What one rank of a parallel run tells rank 0 at the end.
struct RankReport {
  RunRecord::Rank rank;
  MeshFacts facts;  ///< vertices and subsegments on roots count for the rank that numbers them

  void write(ByteWriter& writer) const;
  [[nodiscard]] static RankReport read(ByteReader& reader);
};

/// The report of a rank whose loop has come to its end, on `plan`.
[[nodiscard]] RankReport report_of(const RankLoop& loop, const RunPlan& plan);

/// Adds what a rank reports to the record of its run.
void add_report(RunRecord& run, const RankReport& report);

/// Adds what all ranks have in common, and none reports.
void add_plan(RunRecord& run, const RunPlan& plan);

}  // namespace driftmesh::app
