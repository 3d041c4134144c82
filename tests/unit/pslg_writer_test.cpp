#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>

#include "pslg/poly_file.hpp"
#include "temporary_folder.hpp"

using namespace driftmesh;

namespace {

bool identical(const Pslg& a, const Pslg& b) {
  return a.points == b.points && a.point_markers == b.point_markers && a.attributes == b.attributes &&
         a.attributes_per_point == b.attributes_per_point && a.segments == b.segments && a.holes == b.holes &&
         a.regions == b.regions && a.first_number == b.first_number;
}

// Coordinates of every magnitude, to detect a writer that drops a digit.
Pslg random_pslg(std::mt19937_64& random) {
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-60, 60);
  std::uniform_int_distribution<std::int32_t> integer(-1000, 1000);
  const auto number = [&] { return std::ldexp(mantissa(random), exponent(random)); };
  Pslg pslg;
  pslg.first_number = integer(random) & 1;
  pslg.attributes_per_point = integer(random) & 3;
  for (int i = 0; i < 50; ++i) {
    pslg.points.push_back({number(), number()});
    pslg.point_markers.push_back(integer(random));
    for (int k = 0; k < pslg.attributes_per_point; ++k) pslg.attributes.push_back(number());
    pslg.segments.push_back({i, (i * 7 + 3) % 50, integer(random)});
  }
  for (int i = 0; i < 3; ++i) pslg.holes.push_back({number(), number()});
  for (int i = 0; i < 3; ++i) pslg.regions.push_back({{number(), number()}, number(), number()});
  return pslg;
}

}  // namespace

TEST_CASE("files read back to the same bits") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "x.poly").string();
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Pslg pslg = random_pslg(random);
    write_poly(pslg, path);
    CHECK(identical(read_poly(path), pslg));
  }
}

TEST_CASE("the published models can be read, and survive a round trip") {
  struct Expected {
    const char* file;
    std::size_t points, segments, holes;
  };
  const Expected cases[] = {{"A", 29, 29, 1},
                            {"key", 54, 54, 1},
                            {"pipe", 686, 686, 9},
                            {"cylinder_flow", 364, 364, 0},
                            {"chesapeake", 14267, 14267, 26}};
  const TemporaryFolder folder;
  const std::string copy = (folder.path() / "copy.poly").string();
  for (const Expected& expected : cases) {
    const std::string path = std::string(DRIFTMESH_SOURCE_DIR "/../shared/data/") + expected.file + ".poly";
    if (!std::filesystem::exists(path)) {
      MESSAGE("skipped, not here: " << path);
      continue;
    }
    const Pslg pslg = read_poly(path);
    CHECK(pslg.points.size() == expected.points);
    CHECK(pslg.segments.size() == expected.segments);
    CHECK(pslg.holes.size() == expected.holes);
    write_poly(pslg, copy);
    CHECK(identical(read_poly(copy), pslg));
  }
}
