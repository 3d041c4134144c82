#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/aggregator.hpp"
#include "protocol/directory.hpp"
#include "protocol/messages.hpp"
#include "protocol/protocol_error.hpp"
#include "protocol/termination.hpp"

namespace driftmesh::protocol {

/// The decisions that the proofs in docs/protocol.md rest on, in one place so that tests can replace each by a wrong
/// one and see that it is noticed.
struct SoundRules {
  /// The stations of a SPLIT on its way to the subdomain that it is for, and of a subdomain on its way to a rank.
  enum class Station {
    kEntersAggregator,
    kLeavesAggregator,
    kForwarded,
    kHeld,
    kReleased,  ///< was held, and its subdomain has come
    kReachesSubdomain,
    kGivenAway,
    kArrives
  };
  /// Each counts as sent once, and from the first moment: nothing that waits anywhere is unknown to the counts.
  static constexpr bool counts_as_sent(Station station) {
    return station == Station::kEntersAggregator || station == Station::kGivenAway;
  }
  /// Each counts as handled once, and not before it is where it belongs: what is held back is still under way.
  static constexpr bool counts_as_handled(Station station) {
    return station == Station::kReachesSubdomain || station == Station::kReleased || station == Station::kArrives;
  }
  /// A rank with nothing to do does not let others wait for what it has collected.
  static constexpr bool flushes_when_idle() { return true; }
  /// A rank passes the token only when nothing that it holds could become work.
  static constexpr bool passive(bool program_is_passive, bool aggregator_empty, bool nothing_held) {
    return program_is_passive && aggregator_empty && nothing_held;
  }
  /// A rank calls itself passive only when none of its subdomains has work.
  static constexpr bool rests(bool has_work) { return !has_work; }
  /// Records only move forward.
  static constexpr bool supersedes(const Location& news, const Location& record) { return news.epoch > record.epoch; }
};

/// What a message brought to the program of the rank that received it.
struct Delivery {
  std::optional<HandOff> arrival;  ///< a subdomain that now lives here; unpack it before looking at the splits
  std::vector<SplitGroup> splits;  ///< for subdomains that live here
  std::optional<Advice> advice;    ///< what the sender said by advise()
};

/// How often things happened on one rank.
struct ProtocolCounters {
  std::int64_t splits_sent = 0;     ///< SPLITs made here for subdomains elsewhere
  std::int64_t splits_handled = 0;  ///< SPLITs from other ranks that found their subdomain here
  std::int64_t batches_sent = 0;    ///< messages that carried splits_sent
  std::int64_t hand_offs = 0;       ///< subdomains that left this rank
  std::int64_t hand_off_bytes = 0;  ///< their packed size
  std::int64_t arrivals = 0;        ///< subdomains that came
  std::int64_t forwarded = 0;       ///< groups that were sent on
  std::int64_t most_hops = 0;       ///< how often a group had been sent on that found its subdomain here, at most
  std::int64_t held = 0;            ///< groups that had to wait for their subdomain
};

/// One rank's side of the protocol: aggregation, the directory, and termination, as one state machine. It is told what
/// happens (SPLITs made, subdomains given away, messages received, nothing to do) and collects what is to be sent; it
/// knows no transport, no clock and no mesh.
template <class Rules>
class BasicRankProtocol {
 public:
  /// `owners[s]` is the rank of subdomain s at the start, equal on all ranks.
  BasicRankProtocol(Rank self, std::int32_t ranks, IdSpan<SubdomainId, const Rank> owners,
                    std::size_t aggregation = Aggregator::kDefaultThreshold)
      : self_(self), aggregator_(self, aggregation), directory_(self, owners), termination_(self, ranks) {}

  [[nodiscard]] bool holds(SubdomainId s) const { return directory_.holds(s); }
  [[nodiscard]] Location where(SubdomainId s) const { return directory_.where(s); }
  [[nodiscard]] Termination::Phase phase() const { return termination_.phase(); }
  /// Nothing will arrive any more; the rank leaves once it has sent what take_outgoing() holds.
  [[nodiscard]] bool finished() const { return phase() == Termination::Phase::kFinished; }
  [[nodiscard]] const Termination& termination() const { return termination_; }
  [[nodiscard]] const ProtocolCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t aggregated() const { return aggregator_.size(); }
  [[nodiscard]] std::size_t held_groups() const;
  /// One line for a person who wants to know why nothing goes on: what this rank waits for, and what waits here.
  [[nodiscard]] std::string describe() const;

  /// A point was put on an edge shared with subdomain `to`, which is not held here (what is needs no message).
  void send_split(SubdomainId to, const SplitPoint<GlobalRootId>& split);

  /// Subdomain `s`, held here, moves to another rank. Everything it was sent must be inside `packed`. Moving it to this
  /// rank is the caller's no-op: throws Error.
  void hand_off(SubdomainId s, Rank destination, Bytes packed);

  /// Sends advice. Returns false, and sends nothing, once the work is over.
  bool advise(Rank destination, Advice advice) { return send_control(destination, std::move(advice)); }
  /// The same of where a subdomain is. The protocol does so by itself when it forwards SPLITs.
  bool advise(Rank destination, const LocationUpdate& update) { return send_control(destination, update); }

  /// Takes in a message. What it brings to the program is returned; the program queues it as work of its subdomains
  /// before it next calls rest(). Throws ProtocolError for a message that must not come.
  Delivery receive(Rank source, Message message);

  /// Called when the program has nothing to do at the moment: flushes what waits. `program_is_passive` says that no
  /// subdomain here has work, and no request or plan of this rank is pending.
  void rest(bool program_is_passive);

  /// What is to be sent since the last call.
  [[nodiscard]] std::vector<Outgoing> take_outgoing() { return std::exchange(outgoing_, {}); }

 private:
  using Station = SoundRules::Station;

  void count_sent(Station station, std::size_t entries) {
    if (Rules::counts_as_sent(station)) termination_.work_sent(static_cast<std::int64_t>(entries));
  }
  void count_handled(Station station, std::size_t entries) {
    if (Rules::counts_as_handled(station)) termination_.work_handled(static_cast<std::int64_t>(entries));
  }
  void send_batch(Outgoing batch);
  bool send_control(Rank destination, Message message);
  void learn(SubdomainId s, const Location& news) {
    if (Rules::supersedes(news, directory_.where(s))) directory_.set(s, news);
  }

  void take(Rank source, SplitBatch&& batch, Delivery& delivery);
  void take(Rank source, HandOff&& arrival, Delivery& delivery);
  void take(Rank source, LocationUpdate&& update, Delivery& delivery);
  void take(Rank source, Advice&& advice, Delivery& delivery);
  void take(Rank source, Token&& token, Delivery&) { termination_.receive(source, token); }
  void take(Rank source, Terminate&& terminate, Delivery&) { termination_.receive(source, terminate); }
  void take(Rank source, Finish&& finish, Delivery&) { termination_.receive(source, finish); }
  void take_group(Rank source, SplitGroup&& group, Delivery& delivery);
  void handle(Station station, SplitGroup&& group, Delivery& delivery);
  void forward(Rank source, SplitGroup&& group);
  void refuse_work_after_the_end(Rank source) const;

  Rank self_;
  Aggregator aggregator_;
  Directory directory_;
  Termination termination_;
  std::map<SubdomainId, std::vector<SplitGroup>> held_;  // until their subdomain arrives
  std::vector<Outgoing> outgoing_;
  ProtocolCounters counters_;
};

using RankProtocol = BasicRankProtocol<SoundRules>;

template <class Rules>
std::size_t BasicRankProtocol<Rules>::held_groups() const {
  std::size_t groups = 0;
  for (const auto& [s, waiting] : held_) groups += waiting.size();
  return groups;
}

template <class Rules>
std::string BasicRankProtocol<Rules>::describe() const {
  static constexpr const char* kPhases[] = {"working", "draining", "finished"};
  std::string text = "rank " + to_string(self_) + ": " + kPhases[static_cast<int>(phase())] + ", probe " +
                     std::to_string(termination_.rounds()) + (termination_.has_token() ? " with" : " without") +
                     " the token, SPLITs and hand-offs sent less handled " +
                     std::to_string(termination_.work_balance()) + ", " + std::to_string(aggregator_.size()) +
                     " SPLITs in the aggregator";
  for (const auto& [s, waiting] : held_)
    text += ", " + std::to_string(waiting.size()) + " groups held for subdomain " + to_string(s);
  return text;
}

template <class Rules>
void BasicRankProtocol<Rules>::send_split(SubdomainId to, const SplitPoint<GlobalRootId>& split) {
  if (holds(to)) throw Error("a SPLIT for subdomain " + to_string(to) + ", which this rank holds, is no message");
  count_sent(Station::kEntersAggregator, 1);
  ++counters_.splits_sent;
  const Location location = directory_.where(to);
  if (auto batch = aggregator_.add(location.owner, to, location.epoch, split)) send_batch(std::move(*batch));
}

template <class Rules>
void BasicRankProtocol<Rules>::send_batch(Outgoing batch) {
  ++counters_.batches_sent;
  for (const SplitGroup& group : std::get<SplitBatch>(batch.message).groups)
    count_sent(Station::kLeavesAggregator, group.points.size());
  outgoing_.push_back(std::move(batch));
}

template <class Rules>
void BasicRankProtocol<Rules>::hand_off(SubdomainId s, Rank destination, Bytes packed) {
  if (destination == self_) throw Error("subdomain " + to_string(s) + " is handed to the rank that holds it");
  const Location next = directory_.depart(s, destination);
  count_sent(Station::kGivenAway, 1);
  ++counters_.hand_offs;
  counters_.hand_off_bytes += static_cast<std::int64_t>(packed.size());
  outgoing_.push_back({destination, HandOff{s, next.epoch, std::move(packed)}});
}

template <class Rules>
bool BasicRankProtocol<Rules>::send_control(Rank destination, Message message) {
  if (phase() != Termination::Phase::kWorking) return false;
  termination_.control_sent();
  outgoing_.push_back({destination, std::move(message)});
  return true;
}

template <class Rules>
Delivery BasicRankProtocol<Rules>::receive(Rank source, Message message) {
  Delivery delivery;
  std::visit([&](auto&& m) { take(source, std::move(m), delivery); }, std::move(message));
  return delivery;
}

template <class Rules>
void BasicRankProtocol<Rules>::take(Rank source, SplitBatch&& batch, Delivery& delivery) {
  refuse_work_after_the_end(source);
  for (SplitGroup& group : batch.groups) take_group(source, std::move(group), delivery);
}

template <class Rules>
void BasicRankProtocol<Rules>::take_group(Rank source, SplitGroup&& group, Delivery& delivery) {
  if (group.hops > group.epoch)
    throw ProtocolError(source, "SPLITs for subdomain " + to_string(group.to) + " were forwarded " +
                                    std::to_string(group.hops) + " times; it has moved " + std::to_string(group.epoch) +
                                    " times");
  switch (directory_.route(group.to, group.epoch)) {
    case Directory::Route::kHere:
      return handle(Station::kReachesSubdomain, std::move(group), delivery);
    case Directory::Route::kHold:
      ++counters_.held;
      count_handled(Station::kHeld, group.points.size());
      held_[group.to].push_back(std::move(group));
      return;
    case Directory::Route::kForward:
      return forward(source, std::move(group));
  }
}

template <class Rules>
void BasicRankProtocol<Rules>::handle(Station station, SplitGroup&& group, Delivery& delivery) {
  count_handled(station, group.points.size());
  counters_.most_hops = std::max<std::int64_t>(counters_.most_hops, group.hops);
  counters_.splits_handled += static_cast<std::int64_t>(group.points.size());
  delivery.splits.push_back(std::move(group));
}

// Transit: neither count nor colour changes. The rank that made the SPLITs learns where to send the next ones, and so
// does the rank that sent these here.
template <class Rules>
void BasicRankProtocol<Rules>::forward(Rank source, SplitGroup&& group) {
  const Location location = directory_.where(group.to);
  const auto tell = [&](Rank misled) {
    if (misled != self_ && misled != location.owner)
      advise(misled, LocationUpdate{group.to, location.owner, location.epoch});
  };
  tell(group.origin);
  if (source != group.origin) tell(source);
  ++counters_.forwarded;
  count_sent(Station::kForwarded, group.points.size());
  group.epoch = location.epoch;
  ++group.hops;
  outgoing_.push_back({location.owner, SplitBatch{{std::move(group)}}});
}

template <class Rules>
void BasicRankProtocol<Rules>::take(Rank source, HandOff&& arrival, Delivery& delivery) {
  refuse_work_after_the_end(source);
  if (!directory_.arrive(arrival.subdomain, arrival.epoch))
    throw ProtocolError(source, "hands over subdomain " + to_string(arrival.subdomain) + " with epoch " +
                                    std::to_string(arrival.epoch) + ", which is here or was here before");
  count_handled(Station::kArrives, 1);
  ++counters_.arrivals;
  if (auto waiting = held_.extract(arrival.subdomain))
    for (SplitGroup& group : waiting.mapped()) handle(Station::kReleased, std::move(group), delivery);
  delivery.arrival = std::move(arrival);
}

template <class Rules>
void BasicRankProtocol<Rules>::take(Rank, LocationUpdate&& update, Delivery&) {
  termination_.control_received();
  learn(update.subdomain, {update.owner, update.epoch});
}

template <class Rules>
void BasicRankProtocol<Rules>::take(Rank, Advice&& advice, Delivery& delivery) {
  termination_.control_received();
  if (phase() == Termination::Phase::kWorking) delivery.advice = std::move(advice);
}

template <class Rules>
void BasicRankProtocol<Rules>::refuse_work_after_the_end(Rank source) const {
  if (phase() != Termination::Phase::kWorking)
    throw ProtocolError(source, "work arrives after termination: it was declared too early");
}

template <class Rules>
void BasicRankProtocol<Rules>::rest(bool program_is_passive) {
  if (Rules::flushes_when_idle())
    for (Outgoing& batch : aggregator_.flush()) send_batch(std::move(batch));
  const bool passive = Rules::passive(program_is_passive, aggregator_.empty(), held_.empty());
  while (auto message = termination_.advance(passive)) outgoing_.push_back(std::move(*message));
}

}  // namespace driftmesh::protocol
