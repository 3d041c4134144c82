#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pslg/generators.hpp"
#include "pslg/poly_file.hpp"
#include "support/made_mesh.hpp"

// The number of triangles that an angle bound alone takes, against the number in meshes made by Triangle 1.6 (-pPq) of
// the same inputs.

using namespace driftmesh;

namespace {

constexpr std::array<double, 4> kAngles{20, 25, 30, 33};

struct Counted {
  std::string name;  ///< a generated input, or a file among the published models
  std::map<std::string, std::string> parameters;
  std::array<int, 4> theirs;      ///< triangles at each of the angles
  std::array<int, 4> theirs_low;  ///< angles below the bound

  /// Nothing if the file is not there.
  [[nodiscard]] std::optional<Pslg> input() const {
    if (!name.ends_with(".poly")) return generate(name, parameters);
    const std::filesystem::path file = std::filesystem::path(DRIFTMESH_SOURCE_DIR "/../shared/data") / name;
    if (!std::filesystem::exists(file)) return {};
    return read_poly(file.string());
  }
  [[nodiscard]] std::string words() const {
    std::string text = name;
    for (const auto& [parameter, value] : parameters) text += " " + parameter + "=" + value;
    return text;
  }
};

/// What a count may be at most, relative to theirs; and the number of angles below the bound.
constexpr double kWorst = 1.15;
constexpr double kMostLow = 1.35;

const std::vector<Counted> kCounted = {
    {"A.poly", {}, {60, 70, 87, 128}, {0, 0, 0, 0}},
    {"chesapeake.poly", {}, {20989, 25890, 35282, 45018}, {0, 10, 27, 58}},
    {"cylinder_flow.poly", {}, {963, 1355, 1985, 2689}, {0, 0, 0, 0}},
    {"key.poly", {}, {87, 101, 131, 204}, {0, 0, 0, 0}},
    {"pipe.poly", {}, {1610, 1994, 2892, 3502}, {0, 0, 0, 0}},
    {"bay", {{"resolution", "400"}, {"seed", "41"}}, {2953, 3982, 5887, 7774}, {0, 0, 0, 0}},
    {"bay", {{"resolution", "300"}, {"roughness", "1"}, {"seed", "42"}}, {6709, 9168, 13329, 18268}, {0, 0, 0, 0}},
    {"comb", {}, {1776, 2783, 4398, 6649}, {0, 0, 0, 0}},
    {"comb", {{"pitch", "0.15"}, {"width", "0.02"}}, {536, 622, 902, 1077}, {0, 0, 0, 0}},
    {"fan", {}, {454, 502, 678, 936}, {210, 210, 270, 390}},
    {"fan", {{"angle", "30"}, {"wedges", "10"}}, {48, 100, 128, 185}, {0, 0, 13, 20}},
    {"fan", {{"corner", "true"}}, {438, 493, 578, 881}, {210, 210, 210, 392}},
    {"holes", {}, {4655, 5700, 6682, 8607}, {0, 0, 0, 0}},
    {"holes", {{"radius", "0.15"}, {"seed", "45"}, {"sides", "24"}}, {16262, 25196, 38139, 44223}, {0, 0, 0, 0}},
    {"pipe", {{"channels", "6"}, {"edge", "3"}}, {4433, 6043, 8217, 11313}, {0, 0, 0, 0}},
    {"random-points",
     {{"points", "2000"}, {"seed", "49"}, {"segments", "300"}},
     {7060, 9246, 13318, 18491},
     {0, 0, 0, 0}},
    {"random-points",
     {{"points", "1000"}, {"seed", "51"}, {"segments", "250"}},
     {3598, 4817, 7260, 10397},
     {0, 0, 0, 0}},
    {"random-polygon", {}, {1006, 1054, 1269, 1561}, {0, 1, 3, 4}},
    {"random-polygon",
     {{"jitter", "0.4"}, {"seed", "47"}, {"vertices", "3000"}},
     {3225, 3650, 4686, 5998},
     {0, 0, 11, 14}},
    {"rectangle-hole", {}, {103, 191, 249, 332}, {0, 0, 0, 0}},
};

struct Count {
  double triangles = 0;
  std::int64_t low = 0;
};

Count refined(const Pslg& pslg, double angle) {
  job::Request request = testing::bounded(angle);
  request.bounds.region_areas = false;
  const job::RunRecord record = testing::made(pslg, request).record;
  CHECK(record.complete);
  Count count{static_cast<double>(record.triangles)};
  for (const auto& group : record.exceptions) count.low += group.count;
  return count;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

}  // namespace

TEST_CASE("an angle bound alone takes no more triangles than Triangle makes, in the median of many inputs") {
  for (std::size_t i = 0; i < kAngles.size(); ++i) {
    std::vector<double> ratios;
    for (const Counted& counted : kCounted) {
      const std::optional<Pslg> pslg = counted.input();
      if (!pslg) continue;
      const Count ours = refined(*pslg, kAngles[i]);
      ratios.push_back(ours.triangles / counted.theirs[i]);
      std::printf("%-44s %2.0f degrees: %6.0f triangles, Triangle %6d, ratio %.3f; %lld and %d below the bound\n",
                  counted.words().c_str(), kAngles[i], ours.triangles, counted.theirs[i], ratios.back(),
                  static_cast<long long>(ours.low), counted.theirs_low[i]);
      CAPTURE(counted.words());
      CAPTURE(kAngles[i]);
      CHECK(ratios.back() <= kWorst);
      CHECK(static_cast<double>(ours.low) <= kMostLow * counted.theirs_low[i]);
    }
    CAPTURE(kAngles[i]);
    CHECK(median(ratios) <= 1.01);
  }
}
