#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "driftmesh/pslg.hpp"
#include "job/key.hpp"
#include "job/request.hpp"
#include "job/team.hpp"
#include "mesh/handles.hpp"
#include "mesh/narrow_place.hpp"

namespace driftmesh::job {

/// Who asks for a mesh, and what is done with it, as far as that takes memory.
struct Use {
  EntryPoint by = kMesh;
  bool in_subdomains = false;
  bool sleeps = false;   ///< finished subdomains take less memory
  bool stores = false;   ///< finished subdomains sleep on disk
  bool writes = false;   ///< the mesh is written, drawn or returned
  bool gathers = false;  ///< rank 0 gathers it from the others for that
  double at_once = 1;    ///< share of the mesh whose arrays are in memory at a time for that
};

/// Limits on a mesh. The number of triangles for which memory suffices is an expectation, to refuse in time what cannot
/// succeed; at work, a process measures what it has.
struct Limits {
  std::int64_t triangles = kMostRefined;  ///< stop at this number
  std::uint64_t memory = 0;               ///< bytes that a process may have; 0: unknown
  std::int64_t in_memory = INT64_MAX;     ///< the triangles for which that should suffice
  std::uint64_t bytes_refined = 0;        ///< per triangle, once it is refined
  std::uint64_t bytes_finishing = 0;  ///< per triangle, what a process takes after refinement before it frees anything

  /// Whether memory is expected to run out first.
  [[nodiscard]] bool by_memory() const { return in_memory < triangles; }
  /// The key of the limit.
  [[nodiscard]] static const char* key(bool by_memory) {
    return by_memory ? "limits.max-memory" : "limits.max-triangles";
  }
};

/// The processes that make a mesh together.
struct Processes {
  int all = 1;
  int on_machine = 1;  ///< sharing the memory of this machine
};
[[nodiscard]] inline Processes processes_of(const Team& team) {
  return {team.ranks(), team.ranks_on_machine()};
}

/// The limits that a request and the machine set for meshing `pslg` at this moment: max_triangles is for all processes
/// together, the memory that of each.
[[nodiscard]] Limits find_limits(const Request::Limits& asked, const Pslg& pslg, const Use& use,
                                 const Processes& processes = {});

/// Holds this process, a program, to max_memory if it is asked for: beyond it there is no memory to be had, and whoever
/// asks for it throws std::bad_alloc.
void cap_memory(const Request::Limits& asked);

/// For programs: every subdomain takes the memory that the one before has freed. Under a ceiling, free memory counts as
/// well as any other, so there nothing is kept.
void reuse_memory(const Request::Limits& asked);

/// Whether a process that has made this many triangles cannot make more, if it is to finish them within its memory.
[[nodiscard]] bool memory_is_full(const Limits& limits, std::int64_t triangles);

/// Throws LimitError if a process that has made this many triangles, none of which is kept, has reached a limit.
/// `left`: a sentence about what there is then.
void check_limits(const Limits& limits, std::int64_t triangles, const char* left = "No mesh was written");

/// The same for all processes together, as to the number of triangles alone.
void check_number(const Limits& limits, std::int64_t triangles, const char* left = "No mesh was written");

/// For how many more triangles a process that has made this many has memory, with a tenth of it left over: more than
/// that it should not take from others.
[[nodiscard]] double room_for(const Limits& limits, std::int64_t triangles);

/// Exit code of a program stopped by a limit.
inline constexpr int kStoppedByLimit = 3;

/// Throws LimitError if the forecast of the number of triangles exceeds the limit by more than the error of forecasts.
/// `may_keep`: whether an incomplete mesh can be kept.
/// `find_narrow` is asked for the place that stopped_message names, too.
void check_forecast(const Limits& limits, double forecast, bool may_keep = true,
                    const std::function<std::optional<NarrowPlace>()>& find_narrow = {});

/// Throws LimitError if numbers do not suffice for the largest expected subdomain or file, both in triangles; 0: none.
void check_capacity(double subdomain, double file, EntryPoint by);

/// The message for a mesh stopped by the limit on memory or on triangles. `narrow` is the narrow place of the input
/// that needs the most triangles; it is named if it accounts for a large part of them.
[[nodiscard]] KeyText stopped_message(const Limits& limits, bool by_memory, std::int64_t triangles, bool kept,
                                      const std::optional<NarrowPlace>& narrow = {});

}  // namespace driftmesh::job
