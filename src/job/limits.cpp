#include "job/limits.hpp"

#include <algorithm>
#include <cmath>

#include "base/formatted.hpp"
#include "base/keep_memory.hpp"
#include "base/key_error.hpp"
#include "base/words.hpp"
#include "driftmesh/error.hpp"
#include "job/memory.hpp"

namespace driftmesh::job {
namespace {

// Measured on meshes of 4 to 10 million triangles, rounded up.
constexpr std::uint64_t kBytesAwake = 44;   // the triangulation with its work lists
constexpr std::uint64_t kBytesAsleep = 12;  // a finished subdomain in memory
constexpr std::uint64_t kBytesStored = 1;   // a finished subdomain on disk: what stays in memory
// What files are written from: corners, and points with their markers, of which there are half as many; in subdomains
// also the subdomain and rank of each triangle, the number and owner of each point.
constexpr std::uint64_t kBytesArrays = 26;
constexpr std::uint64_t kBytesArraysOfRanks = 42;
constexpr std::uint64_t kBytesRegion = 8;
constexpr std::uint64_t kBytesAttribute = 4;
constexpr std::uint64_t kSlack = 20;  // the cap is one part in 20 above the limit, for what comes between two looks
constexpr std::uint64_t kLeastSlack = 4 << 20;
constexpr double kForecastError = 1.5;            // ratio to be expected where details of the input decide
constexpr std::int64_t kCapacity = kMostRefined;  // triangles in one piece
constexpr double kMostInFile = 2147483647;        // triangles; their corners have numbers of 32 bits
constexpr double kGoodPart = 0.1;                 // fraction of the triangles at which a mesh was stopped

std::uint64_t bytes_of_arrays(const Pslg& pslg, const Use& use) {
  return (use.in_subdomains ? kBytesArraysOfRanks : kBytesArrays) + (pslg.regions.empty() ? 0 : kBytesRegion) +
         kBytesAttribute * static_cast<std::uint64_t>(pslg.attributes_per_point);
}

/// The capacity of one piece is no limit for many of them.
std::int64_t most_triangles(const Request::Limits& asked, const Use& use) {
  if (!use.in_subdomains) return std::min(asked.max_triangles, kCapacity);
  return asked.max_triangles == kCapacity ? INT64_MAX : asked.max_triangles;
}

std::uint64_t bytes_refined(const Use& use) {
  return use.stores ? kBytesStored : use.sleeps ? kBytesAsleep : kBytesAwake;
}

/// A rank that sends its part has it three times for a moment, but no longer in the form in which it was refined.
std::uint64_t bytes_finishing(const Pslg& pslg, const Use& use) {
  if (!use.writes) return 0;
  const auto arrays =
      static_cast<std::uint64_t>(std::ceil(use.at_once * static_cast<double>(bytes_of_arrays(pslg, use))));
  return use.gathers ? std::max(arrays, 3 * arrays - bytes_refined(use)) : arrays;
}

KeyText limit_name(bool by_memory) {
  return KeyText::key(Limits::key(by_memory));
}

KeyText advice(const Limits& limits, bool by_memory) {
  if (!by_memory && limits.triangles == kCapacity)
    return "no piece can have more; cut the domain with {decomposition.subdomains}, or ask for larger triangles";
  return KeyText::of("allow more with {}, or ask for larger triangles", limit_name(by_memory));
}

/// Good angles require triangles as small as the gap all along it.
KeyText narrow_words(const NarrowPlace& narrow, bool by_memory) {
  const std::string place = formatted(
      "near ({:.10g}, {:.10g}) two segments of the input that do not touch are {:.3g} apart and run side by side for "
      "{:.3g}, which alone takes about {} triangles at any area bound",
      narrow.at.x, narrow.at.y, narrow.width, narrow.length, estimate_words(narrow.triangles));
  return KeyText::of("{}; join them or move them apart there, or allow more with {}", place, limit_name(by_memory));
}

KeyText words_of(const Limits& limits) {
  if (!limits.by_memory()) return KeyText::of("the {} of {limits.max-triangles}", grouped(limits.triangles));
  return formatted("the {} for which {} of memory suffice", grouped(limits.in_memory), bytes_words(limits.memory));
}

KeyText reached_words(const Limits& limits, bool by_memory) {
  if (!by_memory) return KeyText::of("the {} of {limits.max-triangles}", grouped(limits.triangles));
  return formatted("which fill {} of memory{}", bytes_words(limits.memory),
                   limits.bytes_finishing > 0 ? " together with what it takes to finish them" : "");
}

}  // namespace

Limits find_limits(const Request::Limits& asked, const Pslg& pslg, const Use& use, const Processes& processes) {
  Limits limits{.triangles = most_triangles(asked, use),
                .memory = static_cast<std::uint64_t>(asked.max_memory),
                .bytes_refined = bytes_refined(use),
                .bytes_finishing = bytes_finishing(pslg, use)};
  const std::uint64_t present = present_memory();
  if (limits.memory == 0)
    if (const std::uint64_t free = free_memory(); free != 0)
      limits.memory = present + free / 100 * 90 / static_cast<std::uint64_t>(processes.on_machine);
  if (limits.memory == 0) return limits;
  const std::uint64_t room = limits.memory > present ? limits.memory - present : 0;
  const std::uint64_t each = limits.bytes_refined + limits.bytes_finishing;
  std::uint64_t triangles = room / each * static_cast<std::uint64_t>(processes.all);
  if (use.gathers) triangles = std::min(triangles, room / (2 * bytes_of_arrays(pslg, use)));
  limits.in_memory = static_cast<std::int64_t>(std::min<std::uint64_t>(triangles, INT64_MAX));
  return limits;
}

void cap_memory(const Request::Limits& asked) {
  const auto bytes = static_cast<std::uint64_t>(asked.max_memory);
  cap_memory(bytes + bytes / kSlack);
}

void reuse_memory(const Request::Limits& asked) {
  if (asked.max_memory == 0) keep_freed_memory();
}

bool memory_is_full(const Limits& limits, std::int64_t triangles) {
  if (limits.memory == 0) return false;
  const std::uint64_t needed = static_cast<std::uint64_t>(triangles) * limits.bytes_finishing;
  const std::uint64_t until_next_look = std::max(kLeastSlack, limits.memory / kSlack / 2);
  return present_memory() + needed > limits.memory || needed + until_next_look > room_under_cap();
}

namespace {

[[noreturn]] void stop_at(const Limits& limits, bool by_memory, std::int64_t triangles, const char* left) {
  throw Keyed<LimitError>(KeyText::of("{}. {}", stopped_message(limits, by_memory, triangles, true), left));
}

}  // namespace

void check_limits(const Limits& limits, std::int64_t triangles, const char* left) {
  check_number(limits, triangles, left);
  if (memory_is_full(limits, triangles)) stop_at(limits, true, triangles, left);
}

void check_number(const Limits& limits, std::int64_t triangles, const char* left) {
  if (triangles > limits.triangles) stop_at(limits, false, triangles, left);
}

double room_for(const Limits& limits, std::int64_t triangles) {
  constexpr double kMapped = 1.25;  // bytes mapped for each one in use: arrays have capacity to grow
  if (limits.memory == 0) return INFINITY;
  const double memory = static_cast<double>(limits.memory), present = static_cast<double>(present_memory());
  const double unused = std::min(memory - present, static_cast<double>(room_under_cap()) / kMapped) - 0.1 * memory;
  const auto finishing = static_cast<double>(limits.bytes_finishing);
  return (unused - static_cast<double>(triangles) * finishing) /
         (static_cast<double>(limits.bytes_refined) + finishing);
}

void check_forecast(const Limits& limits, double forecast, bool may_keep,
                    const std::function<std::optional<NarrowPlace>()>& find_narrow) {
  const std::int64_t most = std::min(limits.triangles, limits.in_memory);
  if (!(forecast > kForecastError * static_cast<double>(most))) return;
  const auto narrow = find_narrow ? find_narrow() : std::nullopt;
  const bool by_narrowness = narrow && narrow->triangles > kGoodPart * forecast;
  throw Keyed<LimitError>(KeyText::of(
      "these bounds need about {} triangles, more than {}; {}{}", estimate_words(forecast), words_of(limits),
      by_narrowness ? narrow_words(*narrow, limits.by_memory()) : advice(limits, limits.by_memory()),
      may_keep ? KeyText(", or keep what fits with {limits.keep-incomplete}") : KeyText()));
}

void check_capacity(double subdomain, double file, EntryPoint by) {
  if (subdomain > static_cast<double>(kCapacity))
    throw Keyed<LimitError>(KeyText::of(
        "a subdomain would have about {} triangles, more than the {} that can be numbered; cut the domain into more "
        "with {decomposition.subdomains}",
        estimate_words(subdomain), grouped(kCapacity)));
  if (file > kMostInFile && by == kLibrary)
    throw LimitError(
        formatted("the mesh would have about {} triangles, more than the {} whose corners its arrays can "
                  "number; make it on many ranks, or ask for larger triangles",
                  estimate_words(file), grouped(static_cast<std::int64_t>(kMostInFile))));
  if (file > kMostInFile)
    throw LimitError(
        formatted("a file would have about {} triangles, more than the {} that it can number; write a .pvtu instead, "
                  "on more ranks "
                  "if there are ranks, or ask for larger triangles",
                  estimate_words(file), grouped(static_cast<std::int64_t>(kMostInFile))));
}

KeyText stopped_message(const Limits& limits, bool by_memory, std::int64_t triangles, bool kept,
                        const std::optional<NarrowPlace>& narrow) {
  const bool by_narrowness = narrow && narrow->triangles > kGoodPart * static_cast<double>(triangles);
  return KeyText::of(
      "stopped at {} triangles, {}, before all bounds were met; {}{}", grouped(triangles),
      reached_words(limits, by_memory), by_narrowness ? narrow_words(*narrow, by_memory) : advice(limits, by_memory),
      kept ? KeyText() : KeyText(". No mesh was written; {limits.keep-incomplete} writes what was made"));
}

}  // namespace driftmesh::job
