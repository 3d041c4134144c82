#pragma once

#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "balancer/conduct.hpp"
#include "balancer/snapshot/rank_board.hpp"
#include "balancer/snapshot/rank_news.hpp"
#include "balancer/snapshot/situation.hpp"
#include "balancer/trigger/controller_options.hpp"
#include "balancer/trigger/report_rule.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::balancer {

/// Behavior of a rank when work is requested (Placement::kRequests). Ranks report unexpected changes of their load to
/// rank 0, the broker. A rank that runs low asks the broker, which passes the request on to a rank with plenty of work;
/// that rank decides what to give, and answers. Every request is answered once, if only with a refusal. The broker
/// refuses at once if no more could be saved than a move must save, or the rank has work for about as long as all ranks
/// together. It remembers whom it refused, and asks on their behalf when they are out of work, or some rank turns out
/// to have more work than was known.
class RequestConduct {
 public:
  RequestConduct(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
                 const ControllerOptions& options, double now);

  void receive(Rank source, Message advice, double now);
  void arrived(SubdomainId id);
  /// A subdomain that was to come does not.
  void not_coming(SubdomainId id) { arrived(id); }
  /// That was for lack of memory here, of which rank 0 should know.
  void refused() { changed_ = true; }
  [[nodiscard]] bool waiting() const { return asked_ || !requests_.empty(); }
  [[nodiscard]] bool pressing() const { return !requests_.empty(); }
  /// Work is on its way here.
  [[nodiscard]] bool expects_work() const { return !coming_.empty(); }
  [[nodiscard]] Decision think(const Situation& situation);

 private:
  using Loads = std::vector<ReportedLoad>;
  struct Giver {
    std::optional<Rank> rank;
    double share = 0;  // triangles
  };

  void take_answer(Rank source, const WorkAnswer& answer, double now);
  void take_news(Rank source, const LoadNews& news, double now);

  // On every rank:
  void notice_end_of_work(const Loads& own);
  double give(const WorkRequest& request, const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] std::vector<Move> gifts(const WorkRequest& request, const Situation& situation, const Loads& own) const;
  void report(const Situation& situation, const Loads& own, Decision& decision);
  void forget_promises(double now);
  void ask(const Situation& situation, Loads& own, Decision& decision);

  // On the broker:
  void place(const WorkRequest& request, const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] bool pass_on(WorkRequest request, const Situation& situation, Loads& own, Decision& decision);
  [[nodiscard]] double horizon() const;
  [[nodiscard]] Giver find_giver(const WorkRequest& request) const;
  void feed_hungry(const Situation& situation, Loads& own, Decision& decision);

  Rank self_;
  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Policy> policy_;
  ControllerOptions options_;

  ReportRule rule_;
  bool changed_ = false;  // gave work away or refused since the last report
  std::uint32_t reports_ = 0;
  std::vector<WorkRequest> requests_;  // not looked at

  double crumbs_ = 0;   // triangles: no more is left in finished subdomains whose neighbors have split their borders
  bool asked_ = false;  // not yet answered
  std::uint32_t round_ = 0;  // number of the last request
  int refusals_ = 0;         // refusals in a row
  bool remembered_ = false;  // the broker has refused, and keeps the request
  bool idle_ = false;
  std::vector<SubdomainId> arrived_;  // since the last request; they may arrive before the answer that promises them
  std::vector<SubdomainId> coming_;   // promised, not yet here
  double promised_ = 0;               // time of the promise

  std::optional<RankNews> news_;    // kept by the broker
  std::optional<RankBoard> board_;  // made from it for the requests of one think()
  bool surprised_ = false;          // news has come since hungry ranks were last served
  std::set<Rank> hungry_;
};

}  // namespace driftmesh::balancer
