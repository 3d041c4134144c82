#include "job/limits.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/words.hpp"
#include "driftmesh/error.hpp"
#include "job/memory.hpp"

namespace driftmesh::job {
namespace {

// Measured on meshes of 4 to 10 million triangles, rounded up: the triangulation with its work lists, and additionally
// with the flat arrays from which files are written.
constexpr std::uint64_t kBytesRefining = 44;
constexpr std::uint64_t kBytesWriting = 64;
constexpr std::uint64_t kBytesRegion = 10;
constexpr std::uint64_t kBytesAttribute = 4;  // 8 bytes per vertex, of which there are half as many
constexpr double kForecastError = 1.1;
constexpr double kGoodPart = 0.1;  // of the triangles at which a mesh was stopped

std::uint64_t bytes_per_triangle(const Pslg& pslg, bool writes) {
  if (!writes) return kBytesRefining;
  return kBytesWriting + (pslg.regions.empty() ? 0 : kBytesRegion) +
         kBytesAttribute * static_cast<std::uint64_t>(pslg.attributes_per_point);
}

std::string advice(const Limits& limits) {
  return fmt::format("allow more with {}, or ask for larger triangles", limits.option());
}

/// Good angles require triangles as small as the gap all along it.
std::string narrow_words(const NarrowPlace& narrow, const Limits& limits) {
  return fmt::format(
      "near ({:.10g}, {:.10g}) two segments of the input that do not touch are {:.3g} apart and run side by side for "
      "{:.3g}, which alone takes about {} triangles at any area bound; join them or move them apart there, or allow "
      "more "
      "with {}",
      narrow.at.x, narrow.at.y, narrow.width, narrow.length, estimate_words(narrow.triangles), limits.option());
}

std::string words_of(const Limits& limits) {
  if (!limits.by_memory) return "the " + grouped(limits.triangles) + " of --max-triangles";
  return fmt::format("the {} that fit in {} of memory (about {} bytes each)", grouped(limits.triangles),
                     bytes_words(limits.memory), limits.bytes_per_triangle);
}

}  // namespace

Limits find_limits(const Request::Limits& asked, const Pslg& pslg, bool writes, int processes_on_machine) {
  Limits limits{asked.max_triangles, false, static_cast<std::uint64_t>(asked.max_memory),
                bytes_per_triangle(pslg, writes)};
  const std::uint64_t present = present_memory();
  if (limits.memory == 0)
    if (const std::uint64_t free = free_memory(); free != 0)
      limits.memory = present + free / 10 * 9 / static_cast<std::uint64_t>(processes_on_machine);
  if (limits.memory == 0) return limits;
  const std::uint64_t room = limits.memory > present ? limits.memory - present : 0;
  const auto fit = static_cast<std::int64_t>(std::min<std::uint64_t>(room / limits.bytes_per_triangle, INT64_MAX));
  limits.by_memory = fit < limits.triangles;
  limits.triangles = std::min(limits.triangles, fit);
  return limits;
}

Limits limits_of_all(const Request::Limits& asked, Limits limits, int ranks) {
  if (!limits.by_memory) return limits;
  limits.by_memory = limits.triangles < asked.max_triangles / ranks;
  limits.triangles = limits.by_memory ? limits.triangles * ranks : asked.max_triangles;
  limits.memory *= static_cast<std::uint64_t>(ranks);
  return limits;
}

void check_forecast(const Limits& limits, double forecast, bool may_keep) {
  if (!(forecast > kForecastError * static_cast<double>(limits.triangles))) return;
  throw LimitError(fmt::format("these bounds need about {} triangles, more than {}; {}{}", estimate_words(forecast),
                               words_of(limits), advice(limits),
                               may_keep ? ", or keep what fits with --keep-incomplete" : ""));
}

std::string stopped_message(const Limits& limits, std::int64_t triangles, bool kept,
                            const std::optional<NarrowPlace>& narrow) {
  const bool by_narrowness = narrow && narrow->triangles > kGoodPart * static_cast<double>(triangles);
  return fmt::format("stopped at {} triangles, {}, before all bounds were met; {}{}", grouped(triangles),
                     words_of(limits), by_narrowness ? narrow_words(*narrow, limits) : advice(limits),
                     kept ? "" : ". No mesh was written; --keep-incomplete writes what was made");
}

}  // namespace driftmesh::job
