#include "callbacks.hpp"

#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh::python {

bool Callbacks::goes_on(const py::object& progress, const Progress& now) {
  constexpr std::chrono::milliseconds kInterval(50);
  const auto time = std::chrono::steady_clock::now();
  if (asked_ && time - *asked_ < kInterval) return true;
  asked_ = time;
  const py::gil_scoped_acquire lock;
  try {
    return asks_to_go_on(progress, now);
  } catch (py::error_already_set& raised) {
    if (!first_) first_.emplace(raised);
    return false;  // the library's own way to end early, on all ranks
  }
}

bool Callbacks::asks_to_go_on(const py::object& progress, const Progress& now) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (progress.is_none()) return true;
  const py::object answer = progress(now);
  return answer.is_none() || py::bool_(answer);
}

void Callbacks::raise_first() {
  if (first_) throw py::error_already_set(*std::exchange(first_, std::nullopt));
}

void Callbacks::fail(py::error_already_set& raised) {
  const std::string message = raised.what();
  if (!first_) first_.emplace(raised);
  throw Error(message);
}

}  // namespace driftmesh::python
