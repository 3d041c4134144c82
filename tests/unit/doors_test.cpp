#include <doctest/doctest.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "driftmesh/decomposition.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/mesher.hpp"
#include "driftmesh/simulated.hpp"
#include "pslg/generators.hpp"

// What goes wrong in the same way behind every door of the library: one table of cases for all of them. The doors of
// ranks are in tests/mpi, those of the program in tests/cli.

using namespace driftmesh;

namespace {

const Pslg& domain() {
  static const Pslg pipe = generate("pipe", {});
  return pipe;
}

struct Door {
  const char* name;
  std::function<void(MeshOptions)> open;
};

const std::vector<Door>& doors() {
  static const std::vector<Door> all{
      {"in one piece",
       [](MeshOptions options) {
         options.subdomains.count = 1;
         options.threads = 1;
         static_cast<void>(mesh(domain(), options));
       }},
      {"on threads",
       [](MeshOptions options) {
         options.subdomains.count = 8;
         options.threads = 2;
         static_cast<void>(mesh(domain(), options));
       }},
      {"on simulated ranks",
       [](MeshOptions options) {
         options.subdomains.count = 8;
         static_cast<void>(simulate(domain(), options, {.ranks = 3}));
       }},
  };
  return all;
}

template <class Expected>
std::string message_behind(const Door& door, const MeshOptions& options) {
  INFO(std::string(door.name));
  try {
    door.open(options);
    FAIL_CHECK("nothing is thrown");
  } catch (const Expected& error) {
    return error.what();
  } catch (const std::exception& error) {
    FAIL_CHECK("throws another exception: " << std::string(error.what()));
  }
  return {};
}

MeshOptions fine() {
  MeshOptions options;
  options.triangles = 2e5;
  return options;
}

}  // namespace

TEST_CASE("a limit on triangles is told before the work, in the words of the library") {
  for (const Door& door : doors()) {
    MeshOptions options = fine();
    options.max_triangles = 1000;
    const std::string message = message_behind<LimitError>(door, options);
    CAPTURE(message);
    CHECK(message.find("these bounds need about 200,000 triangles") == 0);
    CHECK(message.find("MeshOptions::max_triangles") != std::string::npos);
    CHECK(message.find("--") == std::string::npos);
  }
}

TEST_CASE("a limit on memory is told before the work, in the words of the library") {
  for (const Door& door : doors()) {
    MeshOptions options = fine();
    options.max_memory = 1 << 20;
    const std::string message = message_behind<LimitError>(door, options);
    CAPTURE(message);
    CHECK(message.find("these bounds need about 200,000 triangles") == 0);
    CHECK(message.find("MeshOptions::max_memory") != std::string::npos);
  }
}

TEST_CASE("more triangles than can be numbered are refused before the work") {
  for (const Door& door : doors()) {
    MeshOptions options;
    options.triangles = 1e11;
    options.max_memory = std::int64_t{1} << 59;
    const std::string message = message_behind<LimitError>(door, options);
    CAPTURE(message);
    CHECK(message.find("more than") != std::string::npos);
    CHECK(message.find("MeshOptions::subdomains.count") != std::string::npos);
  }
}

TEST_CASE("whoever looks on can cancel") {
  for (const Door& door : doors()) {
    MeshOptions options = fine();
    int looks = 0;
    options.progress = [&](const Progress& report) {
      CHECK(report.forecast > 1000);
      return ++looks < 2;
    };
    CHECK(message_behind<Cancelled>(door, options).find("MeshOptions::progress") != std::string::npos);
  }
}

TEST_CASE("what a size function throws reaches its caller") {
  struct Own : std::runtime_error {
    using runtime_error::runtime_error;
  };
  for (const Door& door : doors()) {
    MeshOptions options;
    std::atomic<int> calls = 0;
    options.size = [&](const Point&) -> double {
      if (++calls > 100) throw Own("not again");
      return 0.05;
    };
    CHECK(message_behind<Own>(door, options) == "not again");
  }
}

TEST_CASE("options that have no meaning together are told by their names") {
  for (const Door& door : doors()) {
    MeshOptions options = fine();
    options.max_area = 0.01;
    const std::string message = message_behind<Error>(door, options);
    CHECK(message.find("MeshOptions::triangles cannot be combined with MeshOptions::max_area") == 0);
  }
}
