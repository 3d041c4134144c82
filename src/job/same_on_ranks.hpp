#pragma once

#include <string>
#include <vector>

#include "driftmesh/size_field.hpp"
#include "job/request.hpp"
#include "job/team.hpp"
#include "runtime/run_plan.hpp"

namespace driftmesh::job {

/// A setting as one rank has it.
struct RankSetting {
  KeyText name;
  std::string value;  ///< in words that differ if the values do
};

/// All settings of a request.
[[nodiscard]] std::vector<RankSetting> settings_of(const Request& request);

/// Unless all ranks have the same settings, throws an Error on all of them that names the first that differs, two of
/// its values, and the ranks whose value is not that of rank 0. Collective; all ranks list the same names.
void require_same(Team& team, const std::vector<RankSetting>& own);

/// Unless all ranks have the same size field, throws an Error on all of them that names a point where they differ, and
/// both values. Looks at the ends and the middle of each root that subdomains share; differences of one part in a
/// million count. Throws what the field throws on one rank on all of them. Collective.
void require_same_size(Team& team, const Decomposition& decomposition, const SizeField& size);

/// The points that all interfaces get before refinement starts. For each root, the rank with the subdomain to its left
/// computes them and all others take them from it, so that both sides have the same points even where size fields
/// differ in their last bits. Collective.
[[nodiscard]] PresplitPaths share_presplit(Team& team, const RunPlan& plan);

}  // namespace driftmesh::job
