#include "balancer/load_reporter.hpp"

#include <algorithm>
#include <utility>

namespace driftmesh::balancer {

LoadReport LoadReporter::current(const Situation& situation, const Loads& own) {
  return {++count_, plan_, situation.speed, with_mentioned(own), situation.doubt, 0, situation.free_memory};
}

std::optional<LoadReporter::Reports> LoadReporter::due(const Situation& situation, const Loads& own) {
  const auto is_new = [&](const auto& load) { return !std::ranges::binary_search(told_, load.subdomain); };
  const bool changed = changed_ || !mentioned_.empty() || std::ranges::any_of(own, is_new);
  const double total = total_work(own);
  if (!rule_.due(situation.now, total, situation.speed, changed)) return std::nullopt;
  rule_.told(situation.now, total, situation.speed);
  changed_ = false;
  told_.clear();
  for (const auto& load : own) told_.push_back(load.subdomain);
  std::ranges::sort(told_);
  Reports reports{.list = current(situation, own), .sum = {}};
  reports.sum = reports.list;
  reports.sum.loads = std::exchange(mentioned_, {});
  reports.sum.unlisted = total;
  return reports;
}

LoadReporter::Loads LoadReporter::with_mentioned(Loads own) const {
  for (const ReportedLoad& load : mentioned_)
    if (std::ranges::find(own, load.subdomain, &ReportedLoad::subdomain) == own.end()) own.push_back(load);
  return own;
}

}  // namespace driftmesh::balancer
