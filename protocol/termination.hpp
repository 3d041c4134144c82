#pragma once

#include <cstdint>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/wave.hpp"

namespace driftmesh::protocol {

/// One rank's part in termination detection: Safra's algorithm (Dijkstra, EWD998) over a tree, then a fence.
///
/// Detection. Every rank counts the SPLITs and hand-offs that it sent, less those that it handled, and is black after
/// it handled one. Rank 0 sends tokens down a tree of all ranks; a rank answers only when the ranks below have
/// answered, adds its count and its color, and turns white. It answers while passive, or where the probe fails anyway,
/// so that the next one comes sooner: if a rank below is black, or it has received a subdomain. The work is over when
/// the sum is white and 0, with rank 0 passive and its own color and count included. After the last work this takes at
/// most two probes beyond the current one.
///
/// Fence. Then Terminate goes down the same tree. A rank that has seen it sends no more control messages, and answers
/// with the number of control messages it sent minus those it received. When a pass comes back with a total of 0, none
/// is in transit: Finish goes down, and each rank stops as it passes it on. A pass that comes back with a work count
/// other than 0 shows that the detection was wrong, and is an Error: the audit of every run, in every build. A rank
/// may become active again only by handling a counted message: control traffic must not make a passive rank send work.
/// work_sent throws if this rule is broken.
class Termination {
 public:
  enum class Phase {
    kWorking,   ///< there may be work somewhere
    kDraining,  ///< all work is over everywhere; control messages may still arrive
    kFinished,  ///< nothing will arrive any more
  };

  /// No rank of the tree has more than `arity` ranks below it, at most TreePlace::kMostChildren; the same for all.
  Termination(Rank self, std::int32_t ranks, std::int32_t arity = TreePlace::kMostChildren)
      : self_(self), alone_(ranks == 1), probe_(self, ranks, arity), pass_(self, ranks, arity) {}

  [[nodiscard]] Phase phase() const { return phase_; }
  [[nodiscard]] std::uint64_t rounds() const { return probe_.round(); }  ///< probes that have reached this rank
  /// Whether a probe waits for this rank or for those below it.
  [[nodiscard]] bool has_token() const { return probe_.asked(); }
  [[nodiscard]] std::int64_t work_balance() const { return work_; }  ///< sent less handled

  /// `count` SPLITs or hand-offs were sent: from now on they are some rank's future work.
  void work_sent(std::int64_t count);
  /// `count` SPLITs or hand-offs reached the rank that holds their subdomain, and are now that rank's own work.
  void work_handled(std::int64_t count);
  /// A subdomain came here: one hand-off was handled.
  void subdomain_handled();
  void control_sent() { ++control_; }
  void control_received() { --control_; }

  /// Duplicates of these messages are ignored. Throws ProtocolError for one that is not due.
  void receive(Rank source, const Token& token);
  void receive(Rank source, const Terminate& terminate);
  void receive(Rank source, const Finish& finish);

  /// Adds the messages to pass on to `out`, given whether the rank is passive at this moment: no work of its own,
  /// nothing received that is not handled, nothing held back, nothing in the aggregator.
  void advance(bool passive, std::vector<Outgoing>& out);

 private:
  void advance_alone(bool passive);
  void answer_probe(bool passive, std::vector<Outgoing>& out);
  void conclude(bool passive);
  void answer_pass(std::vector<Outgoing>& out);
  void finish(std::vector<Outgoing>& out);
  Token own_token();

  Rank self_;
  bool alone_;
  Phase phase_ = Phase::kWorking;

  std::int64_t work_ = 0;     // SPLITs and hand-offs sent less handled
  std::int64_t control_ = 0;  // control messages sent less received
  bool black_ = false;
  bool has_received_ = false;  // a subdomain, since the last answer: it is black
  bool resting_ = false;       // was passive once, and has handled nothing since

  Wave<Token> probe_;
  Wave<Terminate> pass_;
  bool finish_due_ = false;
};

}  // namespace driftmesh::protocol
