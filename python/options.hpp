#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "callbacks.hpp"
#include "driftmesh/options.hpp"
#include "table.hpp"

namespace driftmesh::python {

/// The keyword arguments of a call as options of the library. Their names, kinds and values are those of the table of
/// keys; sections such as `subdomains` are dictionaries. Made and destroyed with the interpreter's lock held.
class Options {
 public:
  /// Throws TypeError for unknown names (with the nearest known one) and values of another kind, and Error for values
  /// that the table refuses.
  explicit Options(const py::kwargs& given);
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

  [[nodiscard]] const MeshOptions& values() const { return values_; }
  [[nodiscard]] Callbacks& callbacks() { return callbacks_; }

 private:
  void take_callables(Given& given);

  MeshOptions values_;
  py::object size_, progress_, warning_;
  Callbacks callbacks_;
};

/// What `work(options)` returns. It runs without the lock, and ends early if Python has a signal to handle. Raises what
/// callables raised.
template <class Work>
auto with_options(Options& options, const Work& work) {
  try {
    const py::gil_scoped_release unlocked;
    return work(options.values());
  } catch (const std::exception&) {
    options.callbacks().raise_first();
    throw;
  }
}

template <class Work>
auto with_options(const py::kwargs& given, const Work& work) {
  Options options(given);
  return with_options(options, work);
}

/// The options of the table, in its order: a dictionary for each, with name, kind, unit, default, least, most, choices
/// and help.
[[nodiscard]] py::list option_table();

/// All options as lines of documentation, and what comes before them.
inline constexpr const char* kOptionsHead =
    "\n\nOptions, by keyword; lengths and areas are in units of the input. Those with a dot are entries of a\n"
    "dictionary: subdomains={\"count\": 8}. Numbers can be texts with a unit: \"5k\", \"6G\". None is the default.\n\n";
[[nodiscard]] std::string option_lines();

}  // namespace driftmesh::python
