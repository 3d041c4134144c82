#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "runtime/crew.hpp"

namespace driftmesh::testing {

/// A crew without threads: shifts end in any order, and when the seed says so.
class SimulatedCrew final : public Crew {
 public:
  SimulatedCrew(std::size_t size, std::uint64_t seed) : size_(size), random_(seed) {}

  [[nodiscard]] std::size_t size() const override { return size_; }
  void start(Shift& shift) override { started_.push_back(&shift); }
  [[nodiscard]] Shift* finished() override {
    if (started_.empty() || random_() % 4 != 0) return nullptr;
    std::swap(started_[random_() % started_.size()], started_.back());
    Shift* const shift = started_.back();
    started_.pop_back();
    shift->perform();
    ++performed_;
    return shift;
  }
  void wait() override {}

  [[nodiscard]] std::int64_t performed() const { return performed_; }

 private:
  std::size_t size_;
  std::mt19937_64 random_;
  std::vector<Shift*> started_;
  std::int64_t performed_ = 0;
};

}  // namespace driftmesh::testing
