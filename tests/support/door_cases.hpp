#pragma once

#include <doctest/doctest.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/options.hpp"
#include "driftmesh/pslg.hpp"
#include "pslg/generators.hpp"

// What goes wrong in the same way behind every door of the library: one table of cases for all of them.
namespace driftmesh::testing {

/// A function of the library that makes a mesh of door_domain().
struct Door {
  const char* name;
  std::function<void(MeshOptions)> open;
  bool on_ranks = false;  ///< a message names the rank that met the error: "rank 2: "
};

struct DoorCase {
  const char* name;
  std::function<void(const Door&)> check;
};

[[nodiscard]] inline const Pslg& door_domain() {
  static const Pslg pipe = generate("pipe", {});
  return pipe;
}

[[nodiscard]] inline MeshOptions fine_options() {
  MeshOptions options;
  options.triangles = 2e5;
  return options;
}

/// The message of the exception of this kind that all ranks behind the door throw.
template <class Expected>
std::string message_behind(const Door& door, const MeshOptions& options) {
  try {
    door.open(options);
    FAIL_CHECK("nothing is thrown");
  } catch (const Expected& error) {
    return error.what();
  } catch (const std::exception& error) {
    FAIL_CHECK("throws another exception: " << std::string(error.what()));
  }
  return {};
}

/// The message without "rank 2: ".
[[nodiscard]] inline std::string without_rank(const Door& door, const std::string& message) {
  const std::size_t colon = message.find(": ");
  return door.on_ranks && message.starts_with("rank ") && colon != std::string::npos ? message.substr(colon + 2)
                                                                                     : message;
}

inline void limit_on_triangles(const Door& door) {
  MeshOptions options = fine_options();
  options.max_triangles = 1000;
  const std::string message = message_behind<LimitError>(door, options);
  CAPTURE(message);
  CHECK(message.find("these bounds need about 200,000 triangles") == 0);
  CHECK(message.find("MeshOptions::max_triangles") != std::string::npos);
  CHECK(message.find("--") == std::string::npos);
}

inline void limit_on_memory(const Door& door) {
  MeshOptions options = fine_options();
  options.max_memory = 1 << 20;
  const std::string message = message_behind<LimitError>(door, options);
  CAPTURE(message);
  CHECK(message.find("these bounds need about 200,000 triangles") == 0);
  CHECK(message.find("MeshOptions::max_memory") != std::string::npos);
}

inline void too_large(const Door& door) {
  MeshOptions options;
  options.triangles = 1e11;
  options.max_memory = std::int64_t{1} << 59;
  const std::string message = message_behind<LimitError>(door, options);
  CAPTURE(message);
  CHECK(message.find("more than") != std::string::npos);
  CHECK(message.find("MeshOptions::subdomains.count") != std::string::npos);
}

inline void canceled(const Door& door) {
  MeshOptions options = fine_options();
  int looks = 0;
  options.progress = [&](const Progress& report) {
    CHECK(report.forecast > 1000);
    return ++looks < 2;
  };
  CHECK(without_rank(door, message_behind<Cancelled>(door, options)) == "cancelled by MeshOptions::progress");
}

/// One process throws what the caller threw. Other ranks have no such type, and all of them throw an Error.
inline void failing_callable(const Door& door) {
  struct Own : std::runtime_error {
    using runtime_error::runtime_error;
  };
  MeshOptions options;
  std::atomic<int> calls = 0;
  options.size = [&](const Point&) -> double {
    if (++calls > 100) throw Own("not again");
    return 0.05;
  };
  if (door.on_ranks)
    CHECK(without_rank(door, message_behind<std::runtime_error>(door, options)) == "not again");
  else
    CHECK(message_behind<Own>(door, options) == "not again");
}

inline void options_without_meaning_together(const Door& door) {
  MeshOptions options = fine_options();
  options.max_area = 0.01;
  const std::string message = message_behind<Error>(door, options);
  CHECK(message.find("MeshOptions::triangles cannot be combined with MeshOptions::max_area") == 0);
}

[[nodiscard]] inline const std::vector<DoorCase>& door_cases() {
  static const std::vector<DoorCase> all{
      {"a limit on triangles is told before the work, in the words of the library", limit_on_triangles},
      {"a limit on memory is told before the work, in the words of the library", limit_on_memory},
      {"more triangles than can be numbered are refused before the work", too_large},
      {"whoever looks on can cancel", canceled},
      {"what a size function throws reaches its caller", failing_callable},
      {"options that have no meaning together are told by their names", options_without_meaning_together}};
  return all;
}

/// All cases behind one door.
inline void check_door(const Door& door) {
  for (const DoorCase& one : door_cases()) {
    const std::string where = std::string(door.name) + ": " + one.name;
    INFO(where);
    one.check(door);
  }
}

}  // namespace driftmesh::testing
