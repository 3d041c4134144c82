#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <string>

#include "base/key_text.hpp"
#include "distributed/ranks.hpp"
#include "job/ranks_progress.hpp"
#include "job/request.hpp"
#include "job/team.hpp"
#include "job/watch.hpp"

namespace driftmesh::job {

/// What a rank that refines in rounds tells the others of itself, and hears of them, while it works and while it waits
/// for them: so a rank that has fallen silent is named, and rank 0 shows the progress of all.
class Pulse {
 public:
  /// `ranks`: those of the team. `forecast`: of all triangles. `left`: what is left of a run that is given up. All
  /// outlive the object. Collective.
  Pulse(Team& team, Ranks& ranks, const Request::Patience& patience, double forecast, Watch& watch,
        std::function<KeyText()> left);
  ~Pulse();
  Pulse(const Pulse&) = delete;
  Pulse& operator=(const Pulse&) = delete;

  /// This rank does that, and has so many triangles. Throws what the watch throws, or has thrown while this rank
  /// waited; Error where another one is given up.
  void does(const std::string& doing, std::int64_t triangles);
  /// It is at something that may take long, and does not listen: the others are told when it begins, and now and then.
  void is_at(const std::string& doing);

  /// It is done. Throws what the watch has thrown. Collective.
  void close();

 private:
  void hear(bool shows);
  void while_waiting();

  Ranks& ranks_;
  RanksProgress progress_;
  double forecast_;
  Watch& watch_;
  std::int64_t triangles_ = 0;
  std::exception_ptr thrown_;  // by the watch, where not all throw together
};

}  // namespace driftmesh::job
