#pragma once

#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "balancer/admissions.hpp"
#include "balancer/cost/move_cost.hpp"
#include "balancer/planning_conduct.hpp"
#include "balancer/request_conduct.hpp"
#include "balancer/snapshot/messages.hpp"
#include "balancer/snapshot/situation.hpp"
#include "balancer/trigger/controller_options.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// One rank's side of balancing, as a state machine: it takes the time, the rank's own load and the advice of other
/// ranks, and returns what to send and what to hand over. It knows no transport and no clock, so that it runs on real
/// and on simulated ranks. A rank's loop passes all arriving advice to receive(), and calls arrived() for each
/// subdomain handed over to this rank. When due(), and when work has just run out, it calls think() after handling
/// arrivals and before working, hands over what think() returns, and sends its messages by RankProtocol::advise. A rank
/// at rest is passive only if also `!waiting()`. Advice never makes a rank without work send work: think() moves only
/// subdomains listed as unfinished.
class Controller {
 public:
  /// The run starts at `now`. Layout, policy and options are equal on all ranks.
  Controller(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
             const ControllerOptions& options, double now);

  /// Advice arrived from another rank. It is handled in the next think().
  void receive(Rank source, Message advice, double now);

  /// A subdomain arrived from another rank. It may be finished before the next think(), which then does not list it;
  /// this call says that it is no longer in transit.
  void arrived(SubdomainId id, protocol::Epoch epoch);

  /// A move that think() decided on could not be made: the subdomain is still here.
  void stayed(SubdomainId id) { admissions_.stayed(id); }

  /// Whether think() has something to do. Cheap.
  [[nodiscard]] bool due(double now) const;

  /// Whether others may be waiting for this rank, so that it should think() before it continues to work.
  [[nodiscard]] bool pressing() const;

  /// `own`: the unfinished subdomains here, in the order in which they will be worked on, as far as known. `speed`:
  /// triangles per second, 0 if unknown. `free_memory`: as in RankLoad.
  [[nodiscard]] Decision think(double now, std::span<const ReportedLoad> own, double speed, double doubt = 0,
                               double free_memory = kAmpleMemory);

  /// Whether a request or a question of this rank is unanswered, or received advice is unhandled.
  [[nodiscard]] bool waiting() const;

  /// The run has been abandoned: from now on nothing is planned, answered or waited for.
  void give_up();

  /// The duration of the last think(). Plans that take long are made less often.
  void took(double seconds);

  /// The duration of the last think() with the listing of loads for it, until `now`. Where that takes long, because
  /// there are many subdomains, it is not due again before much more time has been spent on work, unless advice
  /// arrives.
  void looked(double now, double seconds);

 private:
  void tell(const Admissions::Settled& settled);

  Rank self_;
  std::variant<std::monostate, PlanningConduct, RequestConduct> conduct_;
  Admissions admissions_;
  double look_interval_;
  double next_look_;
};

}  // namespace driftmesh::balancer
