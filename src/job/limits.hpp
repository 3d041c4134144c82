#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "driftmesh/pslg.hpp"
#include "job/request.hpp"
#include "mesh/mesher.hpp"
#include "mesh/narrow_place.hpp"

namespace driftmesh::job {

/// Limits on the mesh of one process.
struct Limits {
  std::int64_t triangles = MeshRequest{}.max_triangles;  ///< stop at this number
  bool by_memory = false;                                ///< set by memory: max_triangles would allow more
  std::uint64_t memory = 0;                              ///< bytes that the process may use; 0: unknown
  std::uint64_t bytes_per_triangle = 0;                  ///< expected peak per triangle

  /// The option that sets the limit.
  [[nodiscard]] std::string option() const { return by_memory ? "--max-memory" : "--max-triangles"; }
};

/// The limits that a request and the machine set for meshing `pslg` at this moment: memory that the process has now
/// counts as used. Free memory is shared with the other processes of the job on this machine; max_memory is that of
/// each. `writes`: the mesh is also written or drawn, which takes memory.
[[nodiscard]] Limits find_limits(const Request::Limits& asked, const Pslg& pslg, bool writes,
                                 int processes_on_machine = 1);

/// The limits of all `ranks` processes together: the memory limit is per process, max_triangles is for all.
[[nodiscard]] Limits limits_of_all(const Request::Limits& asked, Limits of_one, int ranks);

/// Exit code of a program stopped by a limit.
inline constexpr int kStoppedByLimit = 3;

/// Throws LimitError if the forecast of the number of triangles exceeds the limit by more than the error of forecasts.
/// `may_keep`: whether an incomplete mesh can be kept.
void check_forecast(const Limits& limits, double forecast, bool may_keep = true);

/// The message for a mesh that hit the limit. `narrow` is the narrow place of the input that needs the most triangles;
/// it is named if it accounts for a large part of them.
[[nodiscard]] std::string stopped_message(const Limits& limits, std::int64_t triangles, bool kept,
                                          const std::optional<NarrowPlace>& narrow = {});

}  // namespace driftmesh::job
