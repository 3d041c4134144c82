#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "app/request_line.hpp"
#include "job/keys.hpp"

using namespace driftmesh;
using namespace driftmesh::app;
using job::Request;

namespace {

GivenKeys given(const std::vector<std::pair<const char*, const char*>>& options) {
  GivenKeys keys;
  for (const auto& [option, text] : options) keys.items.push_back({job::find_option(option).key, text});
  return keys;
}

std::string refusal(const GivenKeys& keys, const config::SourcePlaces& places = {}) {
  Request request;
  try {
    try {
      keys.apply(request);
      throw job::KeyError("bounds.angle", "is too steep", "lower it");
    } catch (const job::KeyError& error) {
      throw_with_option(error, keys, places);
    }
  } catch (const std::exception& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("a command line overrides a file, and its lists replace others") {
  Request request;
  request.bounds.area = 3;
  request.bounds.angle = 30;
  request.output.meshes = {"file.vtu"};
  request.balance.parameters = {{"method", "rcb"}};
  given({{"area", "5k"},
         {"output", "a.vtu"},
         {"output", "b.msh"},
         {"speeds", "1,2.5"},
         {"balance-with", "approach=partition"},
         {"no-region-areas", ""},
         {"sleep", ""}})
      .apply(request);
  CHECK(request.bounds.area == 5000);
  CHECK(request.bounds.angle == 30);
  CHECK(request.output.meshes == std::vector<std::string>{"a.vtu", "b.msh"});
  CHECK(request.mapping.speeds == std::vector<double>{1, 2.5});
  CHECK(request.balance.parameters == std::map<std::string, std::string>{{"approach", "partition"}});
  CHECK(!request.bounds.region_areas);
  CHECK(request.run.sleep);
}

TEST_CASE("errors name the option, or the place in the file") {
  CHECK(refusal(given({{"area", "many"}})) == "--area is 'many'; give a number, as in 20, 1.5e3 or 5k");
  CHECK(refusal(given({{"speeds", "1,-2"}})) == "--speeds is -2; it must be above 0");
  CHECK(refusal(given({{"speeds", "1,"}})) == "--speeds is ''; give a number, as in 20, 1.5e3 or 5k");
  CHECK(refusal(given({{"balance-with", "method"}})) == "--balance-with is 'method'; write NAME=VALUE");
  CHECK(refusal({}, {{"bounds.angle", "run.yaml:3:8"}}) == "run.yaml:3:8: 'bounds.angle' is too steep; lower it");
  CHECK(refusal(given({{"angle", "20"}}), {{"bounds.angle", "run.yaml:3:8"}}) == "--angle is too steep; lower it");
}

TEST_CASE("the command line that repeats a run has everything that is not a default") {
  Request request;
  request.input.file = "my bay.poly";
  request.bounds.angle = 30;
  request.bounds.region_areas = false;
  request.sizing.expression = "it's";
  request.mapping.speeds = {1, 0.5};
  request.balance.parameters = {{"method", "graph"}};
  request.output.meshes = {"a.vtu", "b.msh"};
  request.output.quiet = true;
  const std::string line = command_line_of("driftmesh mesh", request, job::kMesh);
  CHECK(line ==
        "driftmesh mesh 'my bay.poly' --angle 30 --no-region-areas --size 'it'\\''s' --speeds 1,0.5 --balance-with "
        "method=graph --output a.vtu --output b.msh");
}

TEST_CASE("an empty value, such as that of an unset shell variable, is rejected") {
  for (const char* option : {"size", "size-mesh", "decomposition", "plot", "json", "output"}) {
    CAPTURE(option);
    CHECK(refusal(given({{option, ""}})) == "--" + std::string(option) + " is empty; give it a value, or leave it out");
  }
}
