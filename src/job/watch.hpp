#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/stopwatch.hpp"
#include "driftmesh/repair.hpp"

namespace driftmesh::job {

struct StageTime {
  std::string name;
  double seconds = 0;
};

/// An observer of the work on a mesh: a progress line, a summary, a caller of the library. Exceptions thrown by its
/// functions end the work and propagate.
class Watch {
 public:
  virtual ~Watch() = default;
  Watch() = default;
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  virtual void begins(const std::string& /*stage*/) {}
  /// Without its warnings, which follow by warned().
  virtual void repaired(const RepairReport& /*repairs*/) {}
  /// Something that the author of the input may not have meant.
  virtual void warned(const std::string& /*warning*/) {}
  /// Refinement is about to begin, in subdomains: a file in pieces will have this many.
  virtual void pieces(std::int32_t /*count*/) {}
  /// Called from time to time during refinement. With many ranks, `triangles` and `forecast` are those of this rank.
  virtual void refining(std::int64_t /*triangles*/, double /*forecast*/) {}
  /// With many ranks, called on rank 0 in addition, with the triangles and the forecast of all.
  virtual void refining_on_all(std::int64_t /*triangles*/, double /*forecast*/) {}
  /// The file at `path` is about to be written, within a stage.
  virtual void writing(const std::string& /*path*/) {}
  /// Nothing has moved on this rank for a minute, or another one does not answer.
  virtual void stalled(const std::string& /*why*/) {}

  /// Calls warned(), and keeps the warning.
  void warn(const std::string& warning) {
    warnings_.push_back(warning);
    warned(warning);
  }
  /// The warnings since the last call.
  [[nodiscard]] std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

  /// Keeps the time of a stage that has ended, or failed.
  void ended(const std::string& stage, double seconds) { stages_.push_back({stage, seconds}); }
  /// The stages since the last call.
  [[nodiscard]] std::vector<StageTime> take_stages() { return std::exchange(stages_, {}); }

 private:
  std::vector<std::string> warnings_;
  std::vector<StageTime> stages_;
};

/// Does `work` as a stage with this name.
template <class Work>
std::invoke_result_t<Work> timed(Watch& watch, const char* stage, Work&& work) {
  watch.begins(stage);
  struct Note {  // also when work returns a value
    Watch& watch;
    const char* stage;
    Stopwatch clock{};
    ~Note() { watch.ended(stage, clock.seconds()); }
  } note{watch, stage};
  return std::forward<Work>(work)();
}

}  // namespace driftmesh::job
