#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "job/limits.hpp"
#include "job/memory.hpp"

using namespace driftmesh;
using namespace driftmesh::job;

namespace {

Request::Limits with_memory(std::uint64_t bytes) {
  Request::Limits limits;
  limits.max_memory = static_cast<std::int64_t>(bytes);
  return limits;
}

std::string refusal(const Limits& limits, double forecast) {
  try {
    check_forecast(limits, forecast);
  } catch (const LimitError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("The process knows its memory") {
  CHECK(present_memory() > 1'000'000);
  CHECK(peak_memory() >= present_memory() / 2);  // the kernel counts them in different batches
  CHECK(free_memory() > 1'000'000);
}

TEST_CASE("The tighter of two limits counts") {
  Request::Limits options = with_memory(present_memory() + 1'000'000'000);
  const Limits by_memory = find_limits(options, Pslg{}, {});
  CHECK(by_memory.by_memory());
  CHECK(by_memory.in_memory > 10'000'000);
  CHECK(by_memory.in_memory < 30'000'000);
  options.max_triangles = 1000;
  CHECK_FALSE(find_limits(options, Pslg{}, {}).by_memory());
}

TEST_CASE("The capacity of one piece limits one piece, not a mesh in subdomains") {
  constexpr std::int64_t kCapacity = 536'870'848;
  Request::Limits asked;
  CHECK(find_limits(asked, Pslg{}, {}).triangles < kCapacity);
  CHECK(find_limits(asked, Pslg{}, {.in_subdomains = true}).triangles > 1'000'000'000'000);
  asked.max_triangles = 2'000'000'000;
  CHECK(find_limits(asked, Pslg{}, {}).triangles < kCapacity);
  CHECK(find_limits(asked, Pslg{}, {.in_subdomains = true}).triangles == 2'000'000'000);
}

TEST_CASE("Arrays that are written with a mesh take memory too") {
  const Request::Limits options = with_memory(present_memory() + 1'000'000'000);
  const auto fit = [&](const Pslg& pslg, const Use& use, const Processes& processes = {}) {
    return find_limits(options, pslg, use, processes).in_memory;
  };
  Pslg values;
  values.attributes_per_point = 10;
  values.regions.resize(1);
  const std::int64_t summary_alone = fit({}, {});
  const std::int64_t written = fit({}, {.writes = true});
  CHECK(written < summary_alone);
  CHECK(fit(values, {.writes = true}) < written);
  const std::int64_t in_subdomains = fit({}, {.in_subdomains = true, .writes = true});
  CHECK(in_subdomains < written);
  CHECK(fit({}, {.in_subdomains = true, .sleeps = true, .writes = true}) > in_subdomains);
  CHECK(fit({}, {.in_subdomains = true, .sleeps = true}) > 3 * summary_alone);
  const Use on_disk{.in_subdomains = true, .sleeps = true, .stores = true, .writes = true};
  Use in_a_series = on_disk;
  in_a_series.at_once = 0.01;
  CHECK(fit({}, in_a_series) > 10 * fit({}, on_disk));

  const Processes many{100, 2};
  CHECK(fit({}, {.in_subdomains = true, .writes = true}, many) > 99 * in_subdomains);
  CHECK(fit({}, {.in_subdomains = true, .writes = true, .gathers = true}, many) < 2 * in_subdomains);
}

TEST_CASE("What a triangle takes, once refined and until it is finished") {
  const auto bytes = [](const Use& use, const Pslg& pslg = {}) {
    const Limits limits = find_limits(with_memory(UINT64_C(1) << 40), pslg, use);
    return std::pair(limits.bytes_refined, limits.bytes_finishing);
  };
  using Bytes = std::pair<std::uint64_t, std::uint64_t>;
  CHECK(bytes({}) == Bytes{44, 0});
  CHECK(bytes({.sleeps = true}) == Bytes{12, 0});
  CHECK(bytes({.sleeps = true, .stores = true}) == Bytes{1, 0});
  CHECK(bytes({.writes = true}) == Bytes{44, 26});
  CHECK(bytes({.writes = true, .at_once = 0.25}) == Bytes{44, 7});
  CHECK(bytes({.in_subdomains = true, .writes = true}) == Bytes{44, 42});
  Pslg pslg;
  pslg.attributes_per_point = 3;
  CHECK(bytes({.writes = true}, pslg) == Bytes{44, 26 + 3 * 4});
  pslg.regions.resize(1);
  CHECK(bytes({.writes = true}, pslg) == Bytes{44, 26 + 3 * 4 + 8});
  // Its part three times, but no longer refined.
  CHECK(bytes({.in_subdomains = true, .writes = true, .gathers = true}) == Bytes{44, 3 * 42 - 44});
  CHECK(bytes({.in_subdomains = true, .sleeps = true, .writes = true, .gathers = true}) == Bytes{12, 3 * 42 - 12});
}

TEST_CASE("Free memory is shared by the processes of a machine, and what a process has is taken") {
  const auto free = [](int on_machine) {
    return static_cast<double>(find_limits({}, Pslg{}, {}, {on_machine, on_machine}).memory - present_memory());
  };
  CHECK(free(4) == doctest::Approx(free(1) / 4).epsilon(0.2));
  const std::vector<char> present(100'000'000, 'x');
  const Limits limits = find_limits(with_memory(present_memory() + 50'000'000), Pslg{}, {});
  CHECK(static_cast<double>(limits.in_memory) == doctest::Approx(50e6 / 44).epsilon(0.2));
  CHECK(present.back() == 'x');
  const Limits to_finish = find_limits(with_memory(present_memory() + 500'000'000), Pslg{}, {.writes = true});
  CHECK(room_for(to_finish, 0) - room_for(to_finish, 1'000'000) == doctest::Approx(1e6 * 26 / 70).epsilon(0.2));
}

TEST_CASE("A limit is met by the first triangle above it") {
  Limits limits;
  limits.triangles = 1000;
  CHECK_NOTHROW(check_limits(limits, 1000));
  CHECK_THROWS_AS(check_limits(limits, 1001), LimitError);
  CHECK_NOTHROW(check_number(limits, 1000));
  CHECK_THROWS_AS(check_number(limits, 1001), LimitError);
}

TEST_CASE("No memory means no triangles, not a wrapped number") {
  CHECK(find_limits(with_memory(1), Pslg{}, {}).in_memory == 0);
}

TEST_CASE("Memory is full once a mesh can no longer be finished within the limit") {
  constexpr std::int64_t kTriangles = 1'000'000;
  const Use use{.writes = true};
  const auto full = [&](std::uint64_t bytes) {
    return memory_is_full(find_limits(with_memory(bytes), Pslg{}, use), kTriangles);
  };
  const std::uint64_t present = present_memory();
  CHECK(full(present + 10 * kTriangles));
  CHECK_FALSE(full(present + 100 * kTriangles));
  CHECK_FALSE(memory_is_full({}, kTriangles));  // unknown
}

TEST_CASE("A forecast above the limit is rejected with both numbers and what to change") {
  Limits limits;
  limits.triangles = 1'000'000;
  CHECK(refusal(limits, 900'000) == "accepted");
  CHECK(refusal(limits, 1'050'000) == "accepted");  // forecasts err
  const std::string message = refusal(limits, 12'345'678);
  for (const char* expected : {"12,300,000", "1,000,000", "limits.max-triangles", "limits.keep-incomplete"})
    CHECK_MESSAGE(message.find(expected) != std::string::npos, message);
}

TEST_CASE("More than can be numbered is rejected with what to do instead") {
  const auto says = [](double subdomain, double file) -> std::string {
    try {
      check_capacity(subdomain, file, kMesh);
    } catch (const LimitError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(says(5e8, 2.1e9) == "accepted");
  CHECK(says(6e8, 0).find("decomposition.subdomains") != std::string::npos);
  CHECK(says(0, 2.2e9).find(".pvtu") != std::string::npos);
  const std::string of_one_piece = refusal(find_limits(with_memory(UINT64_C(1) << 50), Pslg{}, {}), 1e9);
  CHECK_MESSAGE(of_one_piece.find("decomposition.subdomains") != std::string::npos, of_one_piece);
}

TEST_CASE("The message for a stopped mesh names the limit by its key") {
  const Limits limits = find_limits(with_memory(1 << 30), Pslg{}, {.writes = true});
  const auto says = [](const KeyText& text, const char* words) {
    const std::string message = text.in(full_name);
    CHECK_MESSAGE(message.find(words) != std::string::npos, message);
  };
  says(stopped_message(limits, true, 12345, false), "12,345");
  says(stopped_message(limits, true, 12345, false), "limits.max-memory");
  says(stopped_message(limits, false, 12345, false), "limits.max-triangles");
}
