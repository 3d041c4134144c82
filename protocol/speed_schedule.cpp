#include "protocol/speed_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/formatted.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::protocol {

SpeedSchedule::SpeedSchedule(const std::vector<SpeedChange>& changes) {
  for (const SpeedChange& change : changes) {
    if (!(change.at >= 0) || !std::isfinite(change.at) || !(change.factor >= 0) || !std::isfinite(change.factor))
      throw Error(formatted("speeds change at finite times from 0 on, to finite factors from 0 on, not at {} to {}",
                            change.at, change.factor));
    if (change.at > steps_.back().at)
      steps_.push_back(change);
    else if (change.at == 0 && steps_.size() == 1)
      steps_.back().factor = change.factor;
    else
      throw Error(
          formatted("changes of a speed must be in the order of time: {} follows {}", change.at, steps_.back().at));
  }
  if (steps_.back().factor == 0)
    throw Error("the last change of a rank's speed must not be to 0: its work would not end");
}

double SpeedSchedule::end_of(double start, double seconds) const {
  auto step =
      std::find_if(steps_.rbegin(), steps_.rend(), [&](const SpeedChange& s) { return s.at <= start; }).base() - 1;
  for (;; ++step) {
    const double until = step + 1 == steps_.end() ? std::numeric_limits<double>::infinity() : (step + 1)->at;
    const double possible = step->factor == 0 ? 0 : step->factor * (until - start);
    if (seconds <= possible && step->factor > 0) return start + seconds / step->factor;
    seconds -= possible;
    start = until;
  }
}

double SpeedSchedule::done_by(double time) const {
  double done = 0;
  for (auto step = steps_.begin(); step != steps_.end() && step->at < time; ++step) {
    const double until = step + 1 == steps_.end() ? time : std::min(time, (step + 1)->at);
    done += step->factor * (until - step->at);
  }
  return done;
}

double SpeedSchedule::present_from(double time) const {
  auto step =
      std::find_if(steps_.rbegin(), steps_.rend(), [&](const SpeedChange& s) { return s.at <= time; }).base() - 1;
  if (step->factor > 0) return time;
  return std::find_if(step, steps_.end(), [](const SpeedChange& s) { return s.factor > 0; })->at;
}

}  // namespace driftmesh::protocol
