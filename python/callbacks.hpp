#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <optional>

#include "driftmesh/options.hpp"

namespace driftmesh::python {

namespace py = pybind11;

/// The calls that the library makes back into Python, from any thread. The first exception of a callable is kept here:
/// the library sees an error of its own instead, which may pass between threads and ranks, and Python's caller gets the
/// exception itself. Made and destroyed with the interpreter's lock (the GIL) held.
class Callbacks {
 public:
  /// What `call` returns, with the lock held. Throws Error if Python raises an exception.
  template <class Call>
  auto ask(const Call& call) -> decltype(call()) {
    const py::gil_scoped_acquire lock;
    try {
      return call();
    } catch (py::error_already_set& raised) {
      fail(raised);
    }
  }

  /// Whether to go on: Python has no signal to handle (Ctrl-C), and the caller's `progress`, if any, did not return
  /// False. Called as often as the library likes; asks Python at the first call and then twenty times a second.
  [[nodiscard]] bool goes_on(const py::object& progress, const Progress& now);

  /// Raises the exception that was kept, if any. With the lock held.
  void raise_first();

 private:
  [[noreturn]] void fail(py::error_already_set& raised);
  [[nodiscard]] bool asks_to_go_on(const py::object& progress, const Progress& now);

  std::optional<py::error_already_set> first_;
  std::optional<std::chrono::steady_clock::time_point> asked_;  // goes_on is called by one thread
};

}  // namespace driftmesh::python
