#include <doctest/doctest.h>

#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "distributed/parts_file.hpp"
#include "driftmesh/error.hpp"
#include "job/checkpoints.hpp"
#include "support/error_text.hpp"
#include "support/plans.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;

TEST_CASE("a run that has met a limit ends at the next fence, and says where its work is") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "kept").string();
  Pslg square;
  square.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::int32_t i = 0; i < 4; ++i) square.segments.push_back({i, (i + 1) % 4, 1});
  RunPlan plan = testing::plan_for(square, {20, {2e-3}, {}, nullptr}, 1, 8, Presplit::kOff);
  plan.work.slice = 50;
  const std::vector<const SizeField*> no_field{nullptr};
  job::Watch silent;
  OneRank one;
  job::Checkpoints checkpoints(
      {.path = path, .every = 1e9, .subdomains = 8}, one, [] { return std::map<std::string, Bytes>(); },
      [](std::int64_t) {}, silent);
  std::optional<RefinementInRounds> refinement;
  int fences = 0;
  RefinementInRounds::Watch watch;
  watch.check = [&](std::int64_t) { checkpoints.end_for(std::make_exception_ptr(LimitError("enough"))); };
  watch.halts = [&] { return checkpoints.halts(); };
  watch.fence = [&](bool rests) {
    ++fences;
    return checkpoints.fence(rests, *refinement);
  };
  refinement.emplace(plan, no_field, watch);
  const std::string said = testing::error_text<LimitError>([&] { refinement->run(); });
  CHECK(said.find("enough; all that was done is in " + path) == 0);
  CHECK(fences == 1);
  const PartsFile kept(path, kCheckpointFile);
  CHECK(kept.ends().size() == 8);
  for (const SubdomainId s : refinement->here()) CHECK(kept.part(s) == refinement->halted(s));
}
