#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "job/team.hpp"

namespace driftmesh::job {

/// How many triangles all ranks have, as rank 0 knows it while they refine: each tells it a few times a second, on a
/// channel of their own.
class RanksProgress {
 public:
  /// Collective.
  explicit RanksProgress(Team& team);

  /// Tells rank 0 that this one has so many, if it is time; on rank 0 hears of the others. Whether there is news to
  /// show, on rank 0.
  [[nodiscard]] bool tell(std::int64_t own);
  /// All of them; on rank 0.
  [[nodiscard]] std::int64_t triangles() const;

  /// This rank is done with so many. Waits for all others, and calls show() on rank 0 when there is news. Collective.
  void close(std::int64_t own, const std::function<void()>& show);

 private:
  bool hear();

  std::unique_ptr<Channel> channel_;
  std::vector<std::int64_t> triangles_;  // the triangles of each rank
  std::int32_t done_ = 0;                // ranks
  double last_ = 0;                      // when it was told
};

}  // namespace driftmesh::job
