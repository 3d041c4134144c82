#include "protocol/virtual_network.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::protocol {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

void require_positive(double value, const char* what) {
  if (!(value > 0) || value == kNever)
    throw Error(formatted("virtual cluster: {} must be above 0, not {}", what, value));
}

}  // namespace

class VirtualNetwork::Endpoint final : public Transport {
 public:
  Endpoint(VirtualNetwork& network, Rank rank) : network_(network), rank_(rank) {}
  [[nodiscard]] Rank rank() const override { return rank_; }
  [[nodiscard]] std::int32_t ranks() const override { return static_cast<std::int32_t>(network_.ranks_.size()); }
  void send(Rank destination, Bytes bytes) override { network_.send(rank_, destination, std::move(bytes)); }
  std::optional<Received> poll() override { return network_.poll(rank_); }
  void idle() override {}
  [[nodiscard]] double now() const override { return network_.clock(rank_); }
  void spend(double seconds) override {
    double& clock = network_.ranks_[rank_].clock;
    clock = network_.cluster_.schedules[rank_].end_of(clock, seconds / network_.cluster_.speeds[rank_]);
  }

 private:
  VirtualNetwork& network_;
  Rank rank_;
};

VirtualNetwork::VirtualNetwork(VirtualCluster cluster) : cluster_(std::move(cluster)), ranks_(cluster_.speeds.size()) {
  for (const double speed : cluster_.speeds) require_positive(speed, "a rank's speed");
  require_positive(cluster_.step_overhead, "the time of a step");
  require_positive(cluster_.ranks_per_host, "the number of ranks on a host");
  if (!ranks_.empty()) line_free_.assign(host_of(Rank{static_cast<std::int32_t>(ranks_.size()) - 1}) + 1, 0);
  if (cluster_.schedules.empty()) cluster_.schedules.resize(ranks_.size());
  if (cluster_.schedules.size() != ranks_.size())
    throw Error("virtual cluster: speeds must change for all ranks or none");
  if (!cluster_.link) cluster_.link = [](Rank, Rank) { return Link{}; };
  for (const Rank r : ids_of(ranks_)) ranks_[r].endpoint = std::make_unique<Endpoint>(*this, r);
}

VirtualNetwork::~VirtualNetwork() = default;

Transport& VirtualNetwork::transport(Rank rank) {
  return *ranks_.at(rank).endpoint;
}

double VirtualNetwork::makespan() const {
  double latest = 0;
  for (const RankState& rank : ranks_) latest = std::max(latest, rank.clock);
  return latest;
}

/// When a rank can go on: it must be there.
double VirtualNetwork::wake_time(Rank rank) const {
  const RankState& me = ranks_[rank];
  if (me.idle && me.inbox.empty()) return kNever;
  return cluster_.schedules[rank].present_from(me.idle ? std::max(me.clock, me.inbox.front().arrival) : me.clock);
}

void VirtualNetwork::send(Rank source, Rank destination, Bytes bytes) {
  if (!ranks_.has(destination))
    throw LimitError("rank " + to_string(source) + " sends to rank " + to_string(destination) + " of " +
                     std::to_string(ranks_.size()));
  double& now = ranks_[source].clock;
  now += cluster_.message_overhead;
  const auto size = static_cast<double>(bytes.size());
  bytes_ += bytes.size();
  const std::uint64_t serial = serial_++;
  Received message{source, std::move(bytes)};
  if (source == destination) return deliver(now, serial, destination, std::move(message));
  if (host_of(source) == host_of(destination)) {
    const Link& memory = cluster_.within_host;
    return deliver(now + size / memory.bandwidth + memory.latency, serial, destination, std::move(message));
  }
  Departure departure{now, serial, destination, std::move(message)};
  if (cluster_.ranks_per_host == 1) return depart(std::move(departure));
  departures_.push_back(std::move(departure));
  std::push_heap(departures_.begin(), departures_.end(), std::greater<>());
}

void VirtualNetwork::depart(Departure departure) {
  const Rank source = departure.message.source;
  const Link link = cluster_.link(source, departure.destination);
  double& line_free = line_free_[host_of(source)];
  line_free =
      std::max(line_free, departure.ready) + static_cast<double>(departure.message.bytes.size()) / link.bandwidth;
  deliver(line_free + link.latency, departure.serial, departure.destination, std::move(departure.message));
}

/// Whoever steps next sends nothing before it does: what is ready by then can leave.
void VirtualNetwork::depart_before_steps() {
  while (!departures_.empty() && (agenda_.empty() || departures_.front().ready <= agenda_.begin()->first)) {
    std::pop_heap(departures_.begin(), departures_.end(), std::greater<>());
    Departure next = std::move(departures_.back());
    departures_.pop_back();
    depart(std::move(next));
  }
}

void VirtualNetwork::deliver(double arrival, std::uint64_t serial, Rank destination, Received message) {
  RankState& to = ranks_[destination];
  const double before = wake_time(destination);
  to.inbox.push_back({arrival, serial, std::move(message)});
  std::push_heap(to.inbox.begin(), to.inbox.end(), std::greater<>());
  if (to.idle && !to.finished) {
    agenda_.erase({before, destination});
    agenda_.insert({wake_time(destination), destination});
  }
}

std::optional<Received> VirtualNetwork::poll(Rank rank) {
  RankState& me = ranks_[rank];
  if (me.inbox.empty() || me.inbox.front().arrival > me.clock) return std::nullopt;
  std::pop_heap(me.inbox.begin(), me.inbox.end(), std::greater<>());
  Received message = std::move(me.inbox.back().message);
  me.inbox.pop_back();
  me.clock += cluster_.message_overhead;
  return message;
}

RunResult VirtualNetwork::run(IdSpan<Rank, const RankStep> steps) {
  agenda_.clear();
  std::size_t going = ranks_.size();
  for (const Rank r : ids_of(ranks_)) agenda_.insert({wake_time(r), r});
  std::uint64_t taken = 0;
  while (going > 0) {
    depart_before_steps();
    if (agenda_.empty() || agenda_.begin()->first == kNever) return {RunEnd::kStalled, taken};
    if (taken == cluster_.step_limit) return {RunEnd::kStepLimit, taken};
    ++taken;
    const auto [when, rank] = *agenda_.begin();
    agenda_.erase(agenda_.begin());
    RankState& me = ranks_[rank];
    me.waited += when - me.clock;
    me.clock = when;
    me.idle = false;
    const StepResult result = steps[rank]();
    me.clock = std::max(me.clock, when + cluster_.step_overhead);
    me.idle = result == StepResult::kIdle;
    me.finished = result == StepResult::kFinished;
    if (me.finished)
      --going;
    else
      agenda_.insert({wake_time(rank), rank});
  }
  return {RunEnd::kFinished, taken};
}

}  // namespace driftmesh::protocol
