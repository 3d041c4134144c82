#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/value_json.hpp"

namespace driftmesh::study {

/// What the page of a report shows of a trace, at a resolution that eyes have: a run on thousands of ranks has millions
/// of slices. Times are in seconds.
struct Timeline {
  /// A rank refined without a break that could be seen.
  struct Busy {
    std::int32_t rank = 0;
    double start = 0, stop = 0;
    std::int64_t triangles = 0;  ///< made by the rank by then
  };
  /// A plan, or advice that a rank received.
  struct Plan {
    std::int32_t rank = 0;
    double time = 0;
    std::string what;        ///< its subject and verdict
    bool made = false;       ///< the plan was made, or the advice followed
    std::int64_t moves = 0;  ///< moves made
  };
  /// The triangles that ranks had still to make.
  struct Load {
    double time = 0, least = 0, mean = 0, most = 0;
  };
  std::vector<Busy> busy;  ///< by rank and time
  std::vector<Plan> plans;
  std::vector<Load> load;  ///< at `kLoadSamples` equal steps from 0 to the end; empty without any slice
};
inline constexpr int kLoadSamples = 200;

/// Reads a trace as chrome_trace writes it from `text`; `path` is for errors. Throws InputError for what is not
/// JSON.
[[nodiscard]] Timeline timeline_of(const std::string& text, const std::filesystem::path& path);

/// As the page reads it: {busy: [[rank, start, stop, triangles], ...], plans: [{...}], load: [{...}]}.
[[nodiscard]] config::Json json_of(const Timeline& timeline);

}  // namespace driftmesh::study
