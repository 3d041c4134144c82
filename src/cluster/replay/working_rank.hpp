#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "balancer/controller.hpp"
#include "balancer/experience.hpp"
#include "balancer/speed_estimate.hpp"
#include "protocol/rank_protocol.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/transport.hpp"
#include "protocol/wire.hpp"

namespace driftmesh {

/// Work that a rank can do step by step and hand over: all that balancing sees of a subdomain.
struct CountedWork {
  double done = 0;      ///< triangles
  double work = 0;      ///< the actual amount
  double forecast = 0;  ///< what all ranks believe
  [[nodiscard]] bool finished() const { return done >= work; }
  [[nodiscard]] std::uint64_t bytes() const;  ///< size of its packed form
};

/// A rank that does such work with the real protocol, codec and controller, and learns from it. Its time is counted in
/// triangles.
class WorkingRank {
 public:
  struct Counts {
    int moves = 0;
    std::map<SubdomainId, int> moves_of;
    double done = 0;
  };
  struct Options {
    double slice = 16384;    ///< triangles, at most; always that many where the speed is given
    double given_speed = 0;  ///< triangles a second, where there is no time to measure one; 0: it is measured
    double memory = balancer::kAmpleMemory;  ///< triangles that it has memory for
    double planning_speed = 0;  ///< triangles a second of the machine whose planning costs are charged; 0: none are
  };

  WorkingRank(protocol::Transport& transport, const std::shared_ptr<const balancer::Layout>& layout,
              const IdVector<SubdomainId, CountedWork>& work, std::shared_ptr<const balancer::Policy> policy,
              const balancer::ControllerOptions& balancing, const Options& options);

  protocol::StepResult step();

  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const std::map<SubdomainId, CountedWork>& jobs() const { return jobs_; }
  /// Triangles of its jobs when all are done, by their forecasts.
  [[nodiscard]] double occupied() const;
  double last_work = 0;  ///< the time when it last had something to do

 private:
  void send();
  bool poll();
  [[nodiscard]] std::vector<SubdomainId> agenda() const;
  [[nodiscard]] std::vector<balancer::ReportedLoad> loads() const;
  void balance();
  void hand_over(const balancer::Move& move);
  bool work();

  protocol::Transport& transport_;
  std::shared_ptr<const balancer::Layout> layout_;
  IdVector<SubdomainId, Rank> owners_;  // at the start
  protocol::RankProtocol protocol_;
  protocol::WireLimits limits_;
  balancer::Controller controller_;
  balancer::SpeedEstimate speed_;
  balancer::Experience experience_{0};  // counted work contains the start of subdomains
  std::map<SubdomainId, CountedWork> jobs_;
  balancer::ControllerOptions balancing_;
  Options options_;
  bool worked_ = false;  // in the last step
  Counts counts_;
};

}  // namespace driftmesh
