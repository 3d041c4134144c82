#pragma once

#include <map>
#include <vector>

#include "base/bytes.hpp"
#include "cluster/cluster_run.hpp"
#include "decompose/decomposition.hpp"
#include "protocol/transport.hpp"
#include "runtime/rank_loop.hpp"

namespace driftmesh {

/// A record of what one rank did and when. Its loop writes it, and join() turns the logs of all ranks into the result
/// of the run.
class RankLog {
 public:
  /// An empty one, for read() to fill.
  RankLog() = default;
  /// The run begins now. `transport` and `decomposition`, which is null where work has no borders, must outlive the
  /// writing.
  RankLog(const protocol::Transport& transport, const Decomposition* decomposition);

  void begins(const RankLoop& loop);
  /// `seconds`: the duration of the slice, drag included.
  void worked(const RankLoop& loop, const RankLoop::Slice& slice, double seconds);
  void departs(const RankLoop& loop, const RankLoop::Passage& passage);
  void arrives(const RankLoop& loop, const RankLoop::Passage& passage);
  void deliberated(std::vector<balancer::Deliberation> considered);
  void ends(const RankLoop& loop);

  void write(ByteWriter& writer) const;
  [[nodiscard]] static RankLog read(ByteReader& reader);

  /// The run that the logs of all ranks describe.
  [[nodiscard]] static ClusterRun join(const IdVector<Rank, RankLog>& logs);

 private:
  struct Passage {
    double time = 0;
    SubdomainId subdomain{};
    protocol::Epoch epoch = 0;
    Rank to{};
    std::uint64_t bytes = 0;
  };
  [[nodiscard]] double now() const { return transport_->now() - start_; }
  void sample(const RankLoop& loop, double seconds, SubdomainId subdomain);

  const protocol::Transport* transport_ = nullptr;
  const Decomposition* decomposition_ = nullptr;
  double start_ = 0;
  double end_ = 0;
  RankOutcome outcome_;
  std::vector<LoadSample> samples_;
  std::vector<SplitRecord> splits_;
  std::vector<balancer::Deliberation> deliberations_;
  std::vector<Passage> departures_, arrivals_;
  std::vector<SubdomainId> held_;             // at the end
  std::map<SubdomainId, std::int32_t> told_;  // points by neighbor, of the slice that is being written
};

}  // namespace driftmesh
