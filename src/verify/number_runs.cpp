#include "verify/number_runs.hpp"

#include <algorithm>

namespace driftmesh {

void NumberRuns::add(std::int64_t number) {
  if (!runs_.empty() && runs_.back().end == number)
    ++runs_.back().end;
  else
    runs_.push_back({number, number + 1});
}

void NumberRuns::append(const NumberRuns& other) {
  runs_.insert(runs_.end(), other.runs_.begin(), other.runs_.end());
}

void NumberRuns::sort() {
  std::ranges::sort(runs_, {}, &Run::first);
}

std::vector<std::int64_t> NumberRuns::repeated() const {
  std::vector<std::int64_t> result;
  std::int64_t end = 0, told = 0;  // ends so far of the runs, and of the numbers in the result
  for (const Run& run : runs_) {
    for (std::int64_t n = std::max(run.first, told); n < std::min(run.end, end); ++n) result.push_back(n);
    told = std::max(told, std::min(run.end, end));
    end = std::max(end, run.end);
  }
  return result;
}

std::int64_t NumberRuns::count() const {
  std::int64_t sum = 0, end = 0;
  for (const Run& run : runs_) {
    sum += std::max<std::int64_t>(0, run.end - std::max(run.first, end));
    end = std::max(end, run.end);
  }
  return sum;
}

std::int64_t NumberRuns::largest() const {
  std::int64_t end = 0;
  for (const Run& run : runs_) end = std::max(end, run.end);
  return end - 1;
}

}  // namespace driftmesh
