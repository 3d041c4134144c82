#include <doctest/doctest.h>

#include <string>

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
  const Limits by_memory = find_limits(options, Pslg{}, false);
  CHECK(by_memory.by_memory);
  CHECK(by_memory.option() == "--max-memory");
  CHECK(by_memory.triangles > 10'000'000);
  CHECK(by_memory.triangles < 30'000'000);
  options.max_triangles = 1000;
  const Limits by_count = find_limits(options, Pslg{}, false);
  CHECK(by_count.option() == "--max-triangles");
  CHECK(by_count.triangles == 1000);
}

TEST_CASE("Arrays that are written with a mesh take memory too") {
  Request::Limits options = with_memory(present_memory() + 1'000'000'000);
  Pslg pslg;
  const std::int64_t summary_alone = find_limits(options, pslg, false).triangles;
  const std::int64_t written = find_limits(options, pslg, true).triangles;
  pslg.attributes_per_point = 10;
  pslg.regions.resize(1);
  const std::int64_t with_values = find_limits(options, pslg, true).triangles;
  CHECK(written < summary_alone);
  CHECK(with_values < written);
}

TEST_CASE("No memory means no triangles, not a wrapped number") {
  CHECK(find_limits(with_memory(1), Pslg{}, false).triangles == 0);
}

TEST_CASE("A forecast above the limit is rejected with both numbers and what to change") {
  Limits limits;
  limits.triangles = 1'000'000;
  CHECK(refusal(limits, 900'000) == "accepted");
  CHECK(refusal(limits, 1'050'000) == "accepted");  // forecasts err
  const std::string message = refusal(limits, 12'345'678);
  for (const char* expected : {"12,300,000", "1,000,000", "--max-triangles", "--keep-incomplete"})
    CHECK_MESSAGE(message.find(expected) != std::string::npos, message);
}

TEST_CASE("Ranks together may have as many triangles as their memory allows, or as the limit for all") {
  Request::Limits asked;
  asked.max_triangles = 1000;
  Limits one;
  one.triangles = 300;
  one.by_memory = true;
  one.memory = 10;
  const Limits two = limits_of_all(asked, one, 2);
  CHECK(two.triangles == 600);
  CHECK(two.by_memory);
  CHECK(two.memory == 20);
  const Limits four = limits_of_all(asked, one, 4);
  CHECK(four.triangles == 1000);
  CHECK_FALSE(four.by_memory);
}
