#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/defaults.hpp"
#include "protocol/aggregator.hpp"
#include "protocol/directory.hpp"
#include "protocol/messages.hpp"
#include "protocol/rules.hpp"
#include "protocol/termination.hpp"

namespace driftmesh::protocol {

/// The content of a received message for the program of the rank.
struct Delivery {
  std::optional<HandOff> arrival;  ///< a subdomain that is now here; unpack it before applying the splits
  std::vector<SplitGroup> splits;  ///< for subdomains on this rank
  std::optional<Advice> advice;    ///< sent by advise()
  bool abandoned = false;          ///< the sender has given up the run
};

/// Counts of events on one rank.
struct ProtocolCounters {
  std::int64_t splits_sent = 0;     ///< SPLITs made here for subdomains elsewhere
  std::int64_t splits_handled = 0;  ///< SPLITs from other ranks that found their subdomain here
  std::int64_t batches_sent = 0;    ///< messages that carried splits_sent
  std::int64_t hand_offs = 0;       ///< subdomains that left this rank
  std::int64_t hand_off_bytes = 0;  ///< their packed size
  std::int64_t arrivals = 0;        ///< subdomains that came
  std::int64_t forwarded = 0;       ///< groups that were forwarded
  std::int64_t most_hops = 0;       ///< most hops of a group that found its subdomain here
  std::int64_t held = 0;            ///< groups that had to wait for their subdomain
};

/// One rank's side of the protocol: aggregation, the directory, and termination, as one state machine. It takes events
/// (SPLITs made, subdomains given away, messages received, idleness) and collects outgoing messages; it knows no
/// transport, no clock and no mesh.
class RankProtocol {
 public:
  /// `owners[s]` is the rank of subdomain s at the start, equal on all ranks. They and `rules` must outlive the object.
  RankProtocol(Rank self, std::int32_t ranks, IdSpan<SubdomainId, const Rank> owners,
               std::size_t aggregation = defaults::kAggregation, const Rules& rules = sound_rules());

  [[nodiscard]] bool holds(SubdomainId s) const { return directory_.holds(s); }
  [[nodiscard]] Location where(SubdomainId s) const { return directory_.where(s); }
  [[nodiscard]] Termination::Phase phase() const { return termination_.phase(); }
  /// Nothing will arrive any more; the rank leaves once it has sent what take_outgoing() holds.
  [[nodiscard]] bool finished() const { return phase() == Termination::Phase::kFinished; }
  [[nodiscard]] const Termination& termination() const { return termination_; }
  [[nodiscard]] const ProtocolCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t aggregated() const { return aggregator_.size(); }
  [[nodiscard]] std::size_t held_groups() const;
  /// One line to diagnose a stall: what this rank waits for, and what is waiting here.
  [[nodiscard]] std::string describe() const;

  /// A point was inserted on an edge shared with subdomain `to`, which must not be held here (no message is needed
  /// then).
  void send_split(SubdomainId to, const SplitPoint<GlobalRootId>& split);

  /// Subdomain `s`, held here, moves to another rank. Everything sent to it must be included in `packed`. Throws Error
  /// if the destination is this rank.
  void hand_off(SubdomainId s, Rank destination, Bytes packed);

  /// Sends advice. Returns false, and sends nothing, once the work is over.
  bool advise(Rank destination, Advice advice) { return send_control(destination, std::move(advice)); }
  /// The same for the location of a subdomain. The protocol also sends it on its own when it forwards SPLITs.
  bool advise(Rank destination, const LocationUpdate& update) { return send_control(destination, update); }

  /// Tells all other ranks that this rank gives up the run. They learn of it before the run ends, unless it has ended.
  void abandon();

  /// Handles a message and returns its content for the program, which queues it as work of its subdomains before it
  /// next calls rest(). Throws ProtocolError for a message that must not arrive.
  Delivery receive(Rank source, Message message);

  /// Called when the program has nothing to do at the moment: flushes buffered SPLITs. `program_is_passive` says that
  /// no subdomain here has work, and no request or plan of this rank is pending.
  void rest(bool program_is_passive);

  /// Messages to send since the last call, with what a rank at work has to say about the end: rank 0 asks, questions
  /// are passed on at once, and so are answers to a probe that fails anyway.
  [[nodiscard]] std::vector<Outgoing> take_outgoing() {
    termination_.advance(false, outgoing_);
    return std::exchange(outgoing_, {});
  }

 private:
  using Station = Rules::Station;

  void count_sent(Station station, std::size_t count);
  void count_handled(Station station, std::size_t count);
  void send_batch(Outgoing batch);
  bool send_control(Rank destination, Message message);
  void learn(SubdomainId s, const Location& news);

  void take(Rank source, SplitBatch&& batch, Delivery& delivery);
  void take(Rank source, HandOff&& arrival, Delivery& delivery);
  void take(Rank source, LocationUpdate&& update, Delivery& delivery);
  void take(Rank source, Advice&& advice, Delivery& delivery);
  void take(Rank source, Abandon&& abandon, Delivery& delivery);
  void take(Rank source, Token&& token, Delivery&) { termination_.receive(source, token); }
  void take(Rank source, Terminate&& terminate, Delivery&) { termination_.receive(source, terminate); }
  void take(Rank source, Finish&& finish, Delivery&) { termination_.receive(source, finish); }
  void take_group(Rank source, SplitGroup&& group, Delivery& delivery);
  void handle(Station station, SplitGroup&& group, Delivery& delivery);
  void forward(Rank source, SplitGroup&& group);
  void refuse_work_after_the_end(Rank source) const;

  const Rules* rules_;
  Rank self_;
  std::int32_t ranks_;
  Aggregator aggregator_;
  Directory directory_;
  Termination termination_;
  std::map<SubdomainId, std::vector<SplitGroup>> held_;  // until their subdomain arrives
  std::vector<Outgoing> outgoing_;
  ProtocolCounters counters_;
};

}  // namespace driftmesh::protocol
