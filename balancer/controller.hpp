#pragma once

#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "balancer/collective_conduct.hpp"
#include "balancer/council.hpp"
#include "balancer/messages.hpp"
#include "balancer/move_cost.hpp"
#include "balancer/planning_conduct.hpp"
#include "balancer/request_conduct.hpp"
#include "driftmesh/load_snapshot.hpp"

namespace driftmesh::balancer {

/// One rank's side of balancing, as a state machine: it is told the time, the rank's own load and what other ranks
/// advise, and says what to send and what to hand over. It knows no transport and no clock, so that it runs on real and
/// on simulated ranks.
///
/// How a rank's loop drives it: pass all advice that arrives to receive(), and tell arrived() of each subdomain that
/// was handed over to this rank. When due(), and when work has just run out,
/// call think() between taking in what arrived and working; hand over what it says, and send its messages by
/// RankProtocol::advise. A rank at rest is passive only if also `!waiting()`. Nothing that a rank without work is told
/// makes it send work: think() moves only what is listed as unfinished.
class Controller {
 public:
  /// At `now` the run begins. `layout` is equal on all ranks, and so are policy and options. Where all ranks plan
  /// together they need a `council`, which must outlive the controller: throws Error without one.
  Controller(Rank self, std::shared_ptr<const Layout> layout, std::shared_ptr<const Policy> policy,
             const ControllerOptions& options, double now, Council* council = nullptr);

  /// Advice came from another rank. It is looked at in the next think().
  void receive(Rank source, Message advice, double now);

  /// A subdomain has come from another rank. It may be finished before the next think(), which then does not list it;
  /// this tells that it is not under way any more.
  void arrived(SubdomainId id, protocol::Epoch epoch, double now);

  /// Whether think() has something to do; costs next to nothing.
  [[nodiscard]] bool due(double now) const;

  /// All others may be waiting for this rank: it should think() before it works on.
  [[nodiscard]] bool pressing() const;

  /// `own`: the subdomains here that are not finished, in the order in which they will be worked on as far as it is
  /// known. `speed`: triangles a second, 0 while it is not known.
  [[nodiscard]] Decision think(double now, std::span<const ReportedLoad> own, double speed);

  /// A request of this rank has not been answered, something that came has not been looked at, or a plan is being made
  /// together.
  [[nodiscard]] bool waiting() const;

  /// The last think() took that long. Plans that take long are made less often.
  void took(double seconds);

 private:
  std::variant<std::monostate, PlanningConduct, RequestConduct, CollectiveConduct> conduct_;
  double look_interval_;
  double next_look_;
};

}  // namespace driftmesh::balancer
