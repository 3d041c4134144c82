#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <vector>

#include "migration/work.hpp"

namespace driftmesh {

/// A slice of work on one subdomain, which nobody else touches meanwhile.
struct Shift {
  Work* work = nullptr;
  std::int64_t insertions = 0;  ///< about as many

  // Results:
  SliceWork done{};
  std::vector<SplitPoint<GlobalRootId>> said{};  ///< points that it put on interfaces
  std::exception_ptr failure{};                  ///< what the work threw
  double seconds = 0;                            ///< wall-clock time, if a crew did it

  /// Does the work, on any thread; if there is nothing to do after it, lets it rest.
  void perform();
};

/// Threads that work for a rank, besides its own: those of ThreadCrew (threads/thread_crew.hpp), or in tests nobody who
/// could not be replayed. All calls come from the rank's own thread.
class Crew {
 public:
  virtual ~Crew() = default;
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Lets the next free thread perform a shift, which stays where it is until finished() returns it.
  virtual void start(Shift& shift) = 0;
  /// A shift that has been performed; null if there is none now.
  [[nodiscard]] virtual Shift* finished() = 0;
  /// Waits until there may be one, but not for long.
  virtual void wait() = 0;

 protected:
  Crew() = default;
};

}  // namespace driftmesh
