#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace driftmesh {

/// Numbers of points, as runs of consecutive ones: where a program numbers the points of a piece one after the other,
/// these are few.
class NumberRuns {
 public:
  struct Run {
    std::int64_t first = 0;
    std::int64_t end = 0;  ///< the one behind the last
  };

  /// Adds a number. Those added in ascending order one after the other make one run.
  void add(std::int64_t number);
  /// Takes over all runs of another set; numbers may occur several times.
  void append(const NumberRuns& other);
  /// Ascending. Call it before what follows.
  void sort();

  [[nodiscard]] std::span<const Run> runs() const { return runs_; }
  /// The numbers that occur several times, ascending.
  [[nodiscard]] std::vector<std::int64_t> repeated() const;
  /// How many different numbers there are.
  [[nodiscard]] std::int64_t count() const;
  /// The largest number, -1 if there is none.
  [[nodiscard]] std::int64_t largest() const;

 private:
  std::vector<Run> runs_;
};

}  // namespace driftmesh
