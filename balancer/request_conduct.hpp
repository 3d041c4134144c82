#pragma once

#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "balancer/conduct.hpp"
#include "balancer/rank_news.hpp"
#include "balancer/report_rule.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// How a rank behaves where work is asked for (Placement::kRequests). All tell rank 0, the broker, how much they have
/// when that is a surprise. A rank that runs low asks the broker, who passes the request on to a rank that has much;
/// that rank decides what it gives, and answers. Every request is answered once, if only with a refusal. The broker
/// remembers who went away with nothing, and asks on their behalf when somebody turns out to have more than was known.
class RequestConduct {
 public:
  RequestConduct(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                 const ControllerOptions& options, double now);

  void receive(Rank source, Message advice, double now);
  void arrived(SubdomainId id);
  [[nodiscard]] bool waiting() const { return asked_ || !requests_.empty(); }
  /// Work is on its way here.
  [[nodiscard]] bool expects_work() const { return !coming_.empty(); }
  [[nodiscard]] Decision think(const Situation& situation);

 private:
  using Loads = std::vector<ReportedLoad>;

  void take_answer(Rank source, const WorkAnswer& answer, double now);

  // Of every rank:
  double give(const WorkRequest& request, const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] std::vector<Move> gifts(const WorkRequest& request, const Situation& situation, const Loads& own) const;
  void report(const Situation& situation, const Loads& own, Decision& decision);
  void forget_promises(double now);
  void ask(const Situation& situation, Loads& own, Decision& decision);

  // Of the broker:
  void place(const WorkRequest& request, const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] bool pass_on(WorkRequest request, const Situation& situation, Loads& own, Decision& decision);
  void feed_hungry(const Situation& situation, Loads& own, Decision& decision);

  Rank self_;
  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Policy> policy_;
  ControllerOptions options_;

  ReportRule rule_;
  bool changed_ = false;  // gave work away or refused, since the last report
  std::uint32_t reports_ = 0;
  std::vector<WorkRequest> requests_;  // not looked at

  bool asked_ = false;                // and not answered
  std::uint32_t round_ = 0;           // of the last request
  int refusals_ = 0;                  // in a row
  std::vector<SubdomainId> arrived_;  // since the last request; they may be here before the answer that promises them
  std::vector<SubdomainId> coming_;   // promised, and not here yet
  double promised_ = 0;               // when

  std::optional<RankNews> news_;  // of the broker
  bool surprised_ = false;        // by news since the hungry were last thought of
  std::set<Rank> hungry_;
};

}  // namespace driftmesh::balancer
