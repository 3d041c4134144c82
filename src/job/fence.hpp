#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace driftmesh::job {

/// What a process says at a fence of refinement in rounds.
struct AtFence {
  enum class Wish : std::uint8_t {
    kNothing,
    kSave,  ///< a checkpoint is due, or was asked for
    kEnd,   ///< a limit was met, or the process was told to end
  };
  bool rests = false;  ///< its subdomains have nothing left to do in this round
  Wish wish = Wish::kNothing;
};

/// What all do after it. Who ends leaves a checkpoint.
struct AfterFence {
  bool save = false;
  bool end = false;
  bool round_is_over = false;
  friend bool operator==(const AfterFence&, const AfterFence&) = default;
};

/// By what each of them says: the same on all.
[[nodiscard]] inline AfterFence after_fence(std::span<const AtFence> all) {
  const auto any = [&](AtFence::Wish least) {
    return std::ranges::any_of(all, [=](const AtFence& one) { return one.wish >= least; });
  };
  return {.save = any(AtFence::Wish::kSave),
          .end = any(AtFence::Wish::kEnd),
          .round_is_over = std::ranges::all_of(all, [](const AtFence& one) { return one.rests; })};
}

}  // namespace driftmesh::job
