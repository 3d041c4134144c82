#include "protocol/rank_protocol.hpp"

#include <algorithm>

#include "protocol/protocol_error.hpp"

namespace driftmesh::protocol {

RankProtocol::RankProtocol(Rank self, std::int32_t ranks, IdSpan<SubdomainId, const Rank> owners,
                           std::size_t aggregation, const Rules& rules)
    : rules_(&rules),
      self_(self),
      ranks_(ranks),
      aggregator_(self, aggregation),
      directory_(self, owners),
      termination_(self, ranks, rules.arity()) {}

void RankProtocol::count_sent(Station station, std::size_t count) {
  if (rules_->counts_as_sent(station)) termination_.work_sent(static_cast<std::int64_t>(count));
}

void RankProtocol::count_handled(Station station, std::size_t count) {
  if (!rules_->counts_as_handled(station)) return;
  if (station == Station::kArrives)
    termination_.subdomain_handled();
  else
    termination_.work_handled(static_cast<std::int64_t>(count));
}

void RankProtocol::learn(SubdomainId s, const Location& news) {
  if (rules_->supersedes(news, directory_.where(s))) directory_.set(s, news);
}

std::size_t RankProtocol::held_groups() const {
  std::size_t groups = 0;
  for (const auto& [s, waiting] : held_) groups += waiting.size();
  return groups;
}

std::string RankProtocol::describe() const {
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

void RankProtocol::send_split(SubdomainId to, const SplitPoint<GlobalRootId>& split) {
  if (holds(to)) throw Error("a SPLIT for subdomain " + to_string(to) + ", which this rank holds, is no message");
  count_sent(Station::kEntersAggregator, 1);
  ++counters_.splits_sent;
  const Location location = directory_.where(to);
  if (auto batch = aggregator_.add(location.owner, to, location.epoch, split)) send_batch(std::move(*batch));
}

void RankProtocol::send_batch(Outgoing batch) {
  ++counters_.batches_sent;
  for (const SplitGroup& group : std::get<SplitBatch>(batch.message).groups)
    count_sent(Station::kLeavesAggregator, group.points.size());
  outgoing_.push_back(std::move(batch));
}

void RankProtocol::hand_off(SubdomainId s, Rank destination, Bytes packed) {
  if (destination == self_) throw Error("subdomain " + to_string(s) + " is handed to the rank that holds it");
  const Location next = directory_.depart(s, destination);
  count_sent(Station::kGivenAway, 1);
  ++counters_.hand_offs;
  counters_.hand_off_bytes += static_cast<std::int64_t>(packed.size());
  outgoing_.push_back({destination, HandOff{s, next.epoch, std::move(packed)}});
}

bool RankProtocol::send_control(Rank destination, Message message) {
  if (phase() != Termination::Phase::kWorking) return false;
  termination_.control_sent();
  outgoing_.push_back({destination, std::move(message)});
  return true;
}

void RankProtocol::abandon() {
  for (const Rank other : first_ids<Rank>(ranks_))
    if (other != self_) send_control(other, Abandon{});
}

Delivery RankProtocol::receive(Rank source, Message message) {
  Delivery delivery;
  std::visit([&](auto& m) { take(source, std::move(m), delivery); }, message);
  return delivery;
}

void RankProtocol::take(Rank source, SplitBatch&& batch, Delivery& delivery) {
  refuse_work_after_the_end(source);
  for (SplitGroup& group : batch.groups) take_group(source, std::move(group), delivery);
}

void RankProtocol::take_group(Rank source, SplitGroup&& group, Delivery& delivery) {
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

void RankProtocol::handle(Station station, SplitGroup&& group, Delivery& delivery) {
  count_handled(station, group.points.size());
  counters_.most_hops = std::max<std::int64_t>(counters_.most_hops, group.hops);
  counters_.splits_handled += static_cast<std::int64_t>(group.points.size());
  delivery.splits.push_back(std::move(group));
}

// Transit: neither count nor color changes. The rank that made the SPLITs learns where to send the next ones, and so
// does the rank that sent these here.
void RankProtocol::forward(Rank source, SplitGroup&& group) {
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

void RankProtocol::take(Rank source, HandOff&& arrival, Delivery& delivery) {
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

void RankProtocol::take(Rank, LocationUpdate&& update, Delivery&) {
  termination_.control_received();
  learn(update.subdomain, {update.owner, update.epoch});
}

void RankProtocol::take(Rank, Abandon&&, Delivery& delivery) {
  termination_.control_received();
  delivery.abandoned = true;
}

void RankProtocol::take(Rank, Advice&& advice, Delivery& delivery) {
  termination_.control_received();
  if (phase() == Termination::Phase::kWorking) delivery.advice = std::move(advice);
}

void RankProtocol::refuse_work_after_the_end(Rank source) const {
  if (phase() != Termination::Phase::kWorking)
    throw ProtocolError(source, "work arrives after termination: it was declared too early");
}

void RankProtocol::rest(bool program_is_passive) {
  if (rules_->flushes_when_idle())
    for (Outgoing& batch : aggregator_.flush()) send_batch(std::move(batch));
  const bool passive = rules_->passive(program_is_passive, aggregator_.empty(), held_.empty());
  termination_.advance(passive, outgoing_);
}

}  // namespace driftmesh::protocol
