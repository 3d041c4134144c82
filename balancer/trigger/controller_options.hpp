#pragma once

#include <algorithm>

#include "balancer/cost/move_cost.hpp"
#include "balancer/snapshot/experience.hpp"
#include "driftmesh/defaults.hpp"

namespace driftmesh::balancer {

/// When a rank looks at its load, reports, asks and plans, and what moves must be worth.
struct ControllerOptions {
  double look = defaults::kLook;          ///< seconds between checks of the rank's own load
  double gap = defaults::kGap;            ///< shortest time in seconds between reports of a rank, and between plans
  double interval = defaults::kInterval;  ///< longest time in seconds between reports of a rank with work
  double change = 0.1;                    ///< a forecast that is off by this fraction is reported (see ReportRule)
  int refusals = 8;                ///< after this many in a row a rank stops asking for work until it is given some
  double ahead = 0.25;             ///< fraction of the time left: a rank that runs out of work within it gets more
  double overhead = 0.01;          ///< fraction of the time that planning may take
  double reference_speed = 7.9e6;  ///< triangles a second of a rank that plans as fast as Policy::planning_seconds says
  double work_to_start = kWorkToStart;  ///< triangles that take as long as the start of a subdomain
  MoveCost cost;
  Worth worth;

  /// From asking for work to having it, in seconds: a look at the load, the way to rank 0, to the giver and back.
  [[nodiscard]] double time_to_get_work() const { return look + 3 * cost.latency; }
  /// How many triangles a rank makes before it looks at its messages again: at most that many, and on a slow rank no
  /// more than it makes between two checks of its load, so that what it is asked or advised does not wait.
  [[nodiscard]] double triangles_between_looks(double most, double speed) const {
    constexpr double kLeast = 128, kWhileUnknown = 512;  // fewer cost more than they help
    return std::min(most, speed > 0 ? std::max(kLeast, look * speed) : kWhileUnknown);
  }
  /// How long before a rank runs out of work others should give it some, in seconds, if so much time is left and a plan
  /// takes so long. Not sooner: forecasts get better, and borders between what stays and what moves become settled.
  [[nodiscard]] double time_ahead(double left, double planning) const {
    return std::max({ahead * left, 8 * time_to_get_work(), 4 * planning});
  }
  /// How long a subdomain stays where it has come to, in seconds, if so much time is left.
  [[nodiscard]] double rest_after_move(double left) const { return std::min(interval, left / 20); }
  /// How long to wait for a planned move, in seconds.
  [[nodiscard]] double patience() const { return 3 * interval; }
};

}  // namespace driftmesh::balancer
