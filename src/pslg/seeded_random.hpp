#pragma once

#include <cstdint>
#include <random>

namespace driftmesh {

/// Random numbers that are the same on every platform (unlike those of the standard library's distributions).
class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : engine_(seed) {}

  [[nodiscard]] std::uint64_t bits() { return engine_(); }
  /// In [0, 1), a multiple of 2^-53.
  [[nodiscard]] double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, count). The bias, below count / 2^64, is negligible here.
  [[nodiscard]] std::uint64_t below(std::uint64_t count) { return bits() % count; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace driftmesh
