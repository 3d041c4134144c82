#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "balancer/snapshot/situation.hpp"
#include "balancer/trigger/controller_options.hpp"
#include "balancer/trigger/report_rule.hpp"

namespace driftmesh::balancer {

/// What a rank tells those who plan of its own load, and when.
class LoadReporter {
 public:
  using Loads = std::vector<ReportedLoad>;

  /// A report: with all subdomains, for those who plan with them, and with their sum alone, for distant partners. Both
  /// mention what has come and gone.
  struct Reports {
    LoadReport list, sum;
  };

  explicit LoadReporter(const ControllerOptions& options) : rule_(options.gap, options.interval, options.change) {}

  /// The next report has this subdomain, as if it were finished. The planner of a move must learn that it was made,
  /// even if the subdomain has been finished since, and that it was not made because the subdomain was finished before:
  /// otherwise it counts on that work for the destination.
  void mention(SubdomainId id, protocol::Epoch epoch = 0) { mentioned_.push_back({id, epoch, 0, 0}); }
  /// The planners should hear of this rank soon.
  void has_changed() { changed_ = true; }
  /// The rank has carried out what it could of this plan.
  void acted_on(std::uint32_t plan) {
    plan_ = std::max(plan_, plan);
    has_changed();
  }

  /// The load as it is now, for the planner on this rank.
  [[nodiscard]] LoadReport current(const Situation& situation, const Loads& own);
  /// The reports to be sent now, if the load has changed unexpectedly since the last ones.
  [[nodiscard]] std::optional<Reports> due(const Situation& situation, const Loads& own);

 private:
  [[nodiscard]] Loads with_mentioned(Loads own) const;

  ReportRule rule_;
  std::uint32_t count_ = 0;        // reports so far
  std::uint32_t plan_ = 0;         // the last one that was acted on
  std::vector<SubdomainId> told_;  // ascending; of the last report
  Loads mentioned_;
  bool changed_ = false;
};

}  // namespace driftmesh::balancer
