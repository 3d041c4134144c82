#include <doctest/doctest.h>

#include <string>

#include "app/limits.hpp"
#include "app/memory.hpp"
#include "base/error.hpp"

using namespace driftmesh;
using namespace driftmesh::app;

namespace {

MeshOptions with_memory(std::uint64_t bytes) {
  MeshOptions options;
  options.max_memory = bytes;
  return options;
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
  MeshOptions options = with_memory(present_memory() + 1'000'000'000);
  const Limits by_memory = find_limits(options, Pslg{});
  CHECK(by_memory.by_memory);
  CHECK(by_memory.option() == "--max-memory");
  CHECK(by_memory.triangles > 10'000'000);
  CHECK(by_memory.triangles < 30'000'000);
  options.max_triangles = 1000;
  const Limits by_count = find_limits(options, Pslg{});
  CHECK(by_count.option() == "--max-triangles");
  CHECK(by_count.triangles == 1000);
}

TEST_CASE("What is written with a mesh takes memory too") {
  MeshOptions options = with_memory(present_memory() + 1'000'000'000);
  Pslg pslg;
  const std::int64_t summary_alone = find_limits(options, pslg).triangles;
  options.outputs = {"a.vtu"};
  const std::int64_t written = find_limits(options, pslg).triangles;
  pslg.attributes_per_point = 10;
  pslg.regions.resize(1);
  const std::int64_t with_values = find_limits(options, pslg).triangles;
  CHECK(written < summary_alone);
  CHECK(with_values < written);
}

TEST_CASE("No memory is no triangle, not a wrapped number") {
  CHECK(find_limits(with_memory(1), Pslg{}).triangles == 0);
}

TEST_CASE("A forecast beyond the limit is refused with both numbers and what to change") {
  Limits limits;
  limits.triangles = 1'000'000;
  CHECK(refusal(limits, 900'000) == "accepted");
  CHECK(refusal(limits, 1'050'000) == "accepted");  // forecasts err
  const std::string message = refusal(limits, 12'345'678);
  for (const char* expected : {"12,300,000", "1,000,000", "--max-triangles", "--keep-incomplete"})
    CHECK_MESSAGE(message.find(expected) != std::string::npos, message);
}
