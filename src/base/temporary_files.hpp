#pragma once

#include <string>

namespace driftmesh {

/// The name of a file that is to be gone when the process ends, while the object exists: also when a signal ends it,
/// after remove_temporaries_on_signals(). A few can be noted at a time; what is too many or too long a name is not.
class NotedTemporary {
 public:
  explicit NotedTemporary(const std::string& path);
  ~NotedTemporary();
  NotedTemporary(const NotedTemporary&) = delete;
  NotedTemporary& operator=(const NotedTemporary&) = delete;

 private:
  int slot_;
};

/// From now on SIGINT, SIGTERM, SIGHUP and SIGPIPE remove the noted files before they end the process, as they do by
/// themselves. Those that are ignored stay ignored, but for SIGPIPE: a reader that has seen enough (head) ends the
/// process quietly, whoever started it.
void remove_temporaries_on_signals();

}  // namespace driftmesh
