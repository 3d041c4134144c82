#pragma once

#include <functional>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "driftmesh/defaults.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/speed_schedule.hpp"
#include "protocol/transport.hpp"

namespace driftmesh::protocol {

/// One direction of the connection between two ranks.
struct Link {
  double latency = defaults::kLatency;      ///< seconds
  double bandwidth = defaults::kBandwidth;  ///< bytes per second
};

/// A simulated cluster. Message costs follow the LogGP model (Alexandrov et al. 1995): a sender is busy for the
/// overhead, its messages leave one after the other at the given bandwidth and arrive one latency later; the receiver
/// pays the overhead again. Ranks may share a host, and with it the line by which messages leave it, in the order in
/// which they are sent; messages within a host go through its memory.
struct VirtualCluster {
  IdVector<Rank, double> speeds;                 ///< one for each rank, relative to the reference machine
  std::function<Link(Rank from, Rank to)> link;  ///< Link{} between all, if empty; a rank reaches itself in no time
  double message_overhead =
      defaults::kMessageOverhead;  ///< seconds of a rank's time for each message sent and each received
  double step_overhead = 1e-6;     ///< seconds that the shortest step takes; above 0
  std::uint64_t step_limit = UINT64_MAX;
  std::int32_t ranks_per_host = 1;            ///< consecutive ones
  Link within_host = {1e-6, 5e9};             ///< between any two ranks on a host
  IdVector<Rank, SpeedSchedule> schedules{};  ///< how speeds change over time; empty: not at all
};

/// Ranks in one process and on one thread, each with a clock of its own that advances by what it spends and by waiting.
/// The rank whose clock is furthest behind steps next, so a message sent at some moment is available to every poll at
/// later moments. Within a step, poll before spending: messages that others send during the step are not visible to it.
/// A message for a line that ranks share waits until no rank can send an earlier one.
class VirtualNetwork {
 public:
  /// One rank for each entry of `cluster.speeds`. Throws Error for speeds, overheads that are not above 0.
  explicit VirtualNetwork(VirtualCluster cluster);
  ~VirtualNetwork();
  VirtualNetwork(const VirtualNetwork&) = delete;
  VirtualNetwork& operator=(const VirtualNetwork&) = delete;

  [[nodiscard]] Transport& transport(Rank rank);

  /// Steps the ranks until all have finished or none can go on. An exception thrown by a step ends the run.
  RunResult run(IdSpan<Rank, const RankStep> steps);

  [[nodiscard]] double clock(Rank rank) const { return ranks_[rank].clock; }    ///< seconds
  [[nodiscard]] double waited(Rank rank) const { return ranks_[rank].waited; }  ///< seconds of the clock, idle
  [[nodiscard]] double makespan() const;                                        ///< the latest clock
  [[nodiscard]] std::uint64_t messages() const { return serial_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  class Endpoint;
  struct Parcel {
    double arrival;
    std::uint64_t serial;
    Received message;
    bool operator>(const Parcel& o) const { return arrival != o.arrival ? arrival > o.arrival : serial > o.serial; }
  };
  /// A message on its way out of a host.
  struct Departure {
    double ready;
    std::uint64_t serial;
    Rank destination{};
    Received message;
    bool operator>(const Departure& o) const { return ready != o.ready ? ready > o.ready : serial > o.serial; }
  };
  struct RankState {
    std::unique_ptr<Endpoint> endpoint;
    double clock = 0;
    double waited = 0;
    bool idle = false;
    bool finished = false;
    std::vector<Parcel> inbox;  // a heap, the earliest arrival first
  };
  [[nodiscard]] double wake_time(Rank rank) const;
  [[nodiscard]] std::size_t host_of(Rank rank) const {
    return to_index(rank) / static_cast<std::size_t>(cluster_.ranks_per_host);
  }
  void depart(Departure departure);
  void depart_before_steps();
  void deliver(double arrival, std::uint64_t serial, Rank destination, Received message);
  void send(Rank source, Rank destination, Bytes bytes);
  std::optional<Received> poll(Rank rank);

  VirtualCluster cluster_;
  IdVector<Rank, RankState> ranks_;
  std::vector<double> line_free_;             // for each host, when the last message has left
  std::vector<Departure> departures_;         // from hosts of several ranks: a heap, the earliest first
  std::set<std::pair<double, Rank>> agenda_;  // ranks that can step, and when
  std::uint64_t serial_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace driftmesh::protocol
