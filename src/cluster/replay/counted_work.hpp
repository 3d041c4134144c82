#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "migration/work.hpp"
#include "runtime/coupling.hpp"

namespace driftmesh {

/// Triangles that are only counted: all that balancing sees of a subdomain.
struct Count {
  double done = 0;      ///< triangles
  double work = 0;      ///< the actual amount
  double forecast = 0;  ///< what all ranks believe
};

/// Work that takes time and makes nothing.
class CountedWork final : public Work {
 public:
  /// A triangle takes that long on the reference machine.
  CountedWork(SubdomainId id, const Count& count, double seconds) : Work(id), count_(count), seconds_(seconds) {}

  [[nodiscard]] const Count& count() const { return count_; }
  [[nodiscard]] WorkState state() const override;
  /// It has no borders.
  void tell(std::span<const SplitPoint<GlobalRootId>>) override {}
  SliceWork work(std::int64_t insertions, std::vector<SplitPoint<GlobalRootId>>& said) override;
  /// As many bytes as a subdomain has.
  [[nodiscard]] Bytes pack() const override;
  [[nodiscard]] static CountedWork unpack(std::span<const std::byte> packed, double seconds);

 private:
  Count count_;
  double seconds_;
};

/// The counted work that one rank holds.
class CountedHolding final : public HoldingOf<CountedWork> {
 public:
  /// `seconds`: as of CountedWork.
  explicit CountedHolding(double seconds) : seconds_(seconds) {}

  void add(SubdomainId id, const Count& count) { put(CountedWork(id, count, seconds_)); }
  Work& unpack(std::span<const std::byte> packed) override { return put(CountedWork::unpack(packed, seconds_)); }

 private:
  double seconds_;
};

/// Of work that puts no points on borders.
class NoCoupling final : public Coupling {
 public:
  std::optional<SubdomainId> to_tell(SubdomainId, const SplitPoint<GlobalRootId>&) override { return std::nullopt; }
  [[nodiscard]] std::int32_t roots() const override { return 0; }
};

}  // namespace driftmesh
