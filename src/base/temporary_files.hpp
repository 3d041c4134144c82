#pragma once

#include <string>

namespace driftmesh {

/// A name for a file that will be renamed to `target`, in the same folder: TARGET.tmp-HOST-PROCESS-NUMBER. It is unique
/// in this process by the number and among all processes of this machine by the rest, which says whose it is.
[[nodiscard]] std::string temporary_name(const std::string& target);

/// Removes the temporary files that are abandoned (see remains.hpp) from the folder of `target`: those of processes
/// that have ended without removing them (killed, say). Looks into each folder once in the life of this process.
void remove_remains_beside(const std::string& target);

/// The name of a file that is to be gone when the process ends, while the object exists: also when a signal ends it,
/// after remove_temporaries_on_signals(). A name longer than 4,095 bytes is not noted.
class NotedTemporary {
 public:
  explicit NotedTemporary(const std::string& path);
  ~NotedTemporary();
  NotedTemporary(const NotedTemporary&) = delete;
  NotedTemporary& operator=(const NotedTemporary&) = delete;

 private:
  struct Note* note_;
};

/// Removes all noted files: for an end of the process that destroys no objects.
void remove_noted_temporaries() noexcept;

/// From now on SIGINT, SIGTERM, SIGHUP and SIGPIPE remove the noted files before they end the process, as they do by
/// themselves. Ignored signals stay ignored, except SIGPIPE: a reader that has seen enough (head) ends the process
/// quietly, whoever started it.
void remove_temporaries_on_signals();

/// While one exists, the signals of remove_temporaries_on_signals() wait: for what must not be left half done. They
/// take effect when the last one is gone.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
};

}  // namespace driftmesh
