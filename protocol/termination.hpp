#pragma once

#include <cstdint>
#include <optional>

#include "protocol/messages.hpp"

namespace driftmesh::protocol {

/// One rank's part in termination detection: Safra's algorithm (Dijkstra, EWD998), then a fence.
///
/// Detection. Every rank counts the SPLITs and hand-offs that it sent, less those that it handled, and is black after
/// it handled one. Rank 0 sends a token along the ring 0, 1, ..., P - 1, 0; a rank passes it on only while passive,
/// adds its count and its color, and turns white. The work is over when the token comes back white to a white rank 0
/// with a total of 0. After the last work this takes at most two probes beyond the current one.
///
/// Fence. Then Terminate goes along the same ring. A rank that has seen it sends no more control messages, and adds the
/// number of control messages it sent minus those it received. When a pass comes back with a total of 0, none is in
/// transit: Finish goes around, and each rank stops as it passes it on. A pass that comes back with a work count other
/// than 0 shows that the detection was wrong, and is a ProtocolError: the audit of every run, in every build. A rank
/// may become active again only by handling a counted message: control traffic must not make a passive rank send work.
/// work_sent throws if this rule is broken.
class Termination {
 public:
  enum class Phase {
    kWorking,   ///< there may be work somewhere
    kDraining,  ///< all work is over everywhere; control messages may still arrive
    kFinished,  ///< nothing will arrive any more
  };

  Termination(Rank self, std::int32_t ranks) : self_(self), ranks_(ranks) {}

  [[nodiscard]] Phase phase() const { return phase_; }
  [[nodiscard]] std::uint64_t rounds() const { return round_; }  ///< probes that this rank has passed on or started
  [[nodiscard]] bool has_token() const { return token_.has_value(); }
  [[nodiscard]] std::int64_t work_balance() const { return work_; }  ///< sent less handled

  /// `count` SPLITs or hand-offs were sent: from now on they are some rank's future work.
  void work_sent(std::int64_t count);
  /// `count` SPLITs or hand-offs reached the rank that holds their subdomain, and are now that rank's own work.
  void work_handled(std::int64_t count);
  void control_sent() { ++control_; }
  void control_received() { --control_; }

  /// Duplicates of these messages are ignored. Throws ProtocolError for one that is not due.
  void receive(Rank source, const Token& token);
  void receive(Rank source, const Terminate& terminate);
  void receive(Rank source, const Finish& finish);

  /// The message to pass on, if any, given whether the rank is passive at this moment: no work of its own, nothing
  /// received that is not handled, nothing held back, nothing in the aggregator. Call it again after each message.
  std::optional<Outgoing> advance(bool passive);

 private:
  [[nodiscard]] Rank next() const { return next_in_ring(self_, ranks_); }
  void advance_alone(bool passive);
  std::optional<Outgoing> probe();
  std::optional<Outgoing> pass_token();
  std::optional<Outgoing> fence();
  std::optional<Outgoing> pass_terminate();
  std::optional<Outgoing> finish();

  Rank self_;
  std::int32_t ranks_;
  Phase phase_ = Phase::kWorking;

  std::int64_t work_ = 0;     // SPLITs and hand-offs sent less handled
  std::int64_t control_ = 0;  // control messages sent less received
  bool black_ = false;
  bool resting_ = false;  // was passive once, and has handled nothing since

  std::uint64_t round_ = 0;
  std::optional<Token> token_;  // arrived, and not passed on yet
  std::uint64_t pass_ = 0;
  std::optional<Terminate> terminate_;
  bool finish_due_ = false;
};

}  // namespace driftmesh::protocol
