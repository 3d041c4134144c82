#include "job/pulse.hpp"

#include <utility>

namespace driftmesh::job {

Pulse::Pulse(Team& team, Ranks& ranks, const Request::Patience& patience, double forecast, Watch& watch,
             std::function<KeyText()> left)
    : ranks_(ranks), progress_(team, patience, std::move(left)), forecast_(forecast), watch_(watch) {
  ranks_.meanwhile([this] { while_waiting(); });
}

Pulse::~Pulse() {
  ranks_.meanwhile({});
}

void Pulse::does(const std::string& doing, std::int64_t triangles) {
  triangles_ = triangles;
  hear(progress_.tell(triangles, doing));
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void Pulse::is_at(const std::string& doing) {
  progress_.tell_now(triangles_, doing);
}

void Pulse::while_waiting() {
  hear(progress_.tell(triangles_, "waiting for other ranks"));
}

void Pulse::hear(bool shows) {
  const std::string silence = progress_.silence();
  if (thrown_) return;
  try {
    if (!silence.empty()) watch_.stalled(silence);
    if (shows) watch_.refining_on_all(progress_.triangles(), forecast_);
  } catch (const std::exception&) {
    thrown_ = std::current_exception();
  }
}

void Pulse::close() {
  progress_.close(triangles_, [this] { hear(ranks_.rank() == Rank{0}); });
  ranks_.meanwhile({});
  ranks_.agree([this] {
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  });
}

}  // namespace driftmesh::job
