#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

#include "driftmesh/error.hpp"
#include "driftmesh/repair.hpp"
#include "driftmesh/simplify.hpp"
#include "oracles/random_pslg.hpp"
#include "support/grid_polygons.hpp"
#include "support/recorded.hpp"
#include "support/value_digest.hpp"

// What repair and simplification make of inputs that are wrong in many ways, to the last bit, with all that they say:
// ranks, and the runs that go on with a saved one, read and repair the same files apart from each other.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

/// Numbers that do not depend on the library's distributions.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : random_(seed) {}
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 random_;
};

/// Segments between points of a coarse grid, and between points next to those and to segments.
Pslg tangle(Numbers& random) {
  Pslg pslg;
  const std::uint64_t points = 6 + random.below(12);
  for (std::uint64_t i = 0; i < points; ++i) {
    Point p{static_cast<double>(random.below(6)), static_cast<double>(random.below(6))};
    if (random.below(4) == 0) p.x += 0x1p-51;
    if (random.below(4) == 0) p.y += 0.004 * random.unit();
    if (random.below(9) == 0) p.x *= 1e-40;
    pslg.points.push_back(p);
  }
  for (std::uint64_t i = 0; i < points + random.below(10); ++i)
    pslg.segments.push_back({static_cast<std::int32_t>(random.below(points)),
                             static_cast<std::int32_t>(random.below(points)),
                             static_cast<std::int32_t>(random.below(3))});
  return pslg;
}

/// A domain whose segments are crossed by others.
Pslg crossed(std::uint64_t seed, Numbers& random) {
  oracles::RandomPslgShape shape = oracles::make_random_shape(seed);
  shape.scale = 1;
  shape.offset = static_cast<double>(seed % 3);
  Pslg pslg = oracles::make_random_pslg(seed, shape).input;
  for (int k = 0; k < 3; ++k)
    pslg.segments.push_back({static_cast<std::int32_t>(random.below(pslg.points.size())),
                             static_cast<std::int32_t>(random.below(pslg.points.size())), 4});
  return pslg;
}

/// A rough coast with islands, of some of which little is left.
Pslg coast(Numbers& random) {
  Pslg pslg;
  const auto ring = [&](const Point& center, double radius, double roughness, std::int32_t corners) {
    const auto first = static_cast<std::int32_t>(pslg.points.size());
    for (std::int32_t i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, r = radius * (1 + roughness * (random.unit() - 0.5));
      pslg.points.push_back({center.x + std::round(r * std::cos(angle) * 0x1p30) * 0x1p-30,
                             center.y + std::round(r * std::sin(angle) * 0x1p30) * 0x1p-30});
      pslg.segments.push_back({first + i, first + (i + 1) % corners, random.below(40) == 0 ? 2 : 1});
    }
  };
  ring({0, 0}, 3, 0.15, 120);
  for (int k = 0; k < 8; ++k) {
    const Point center{0.6 * (k % 4) - 0.9 + 0.2 * random.unit(), 0.8 * static_cast<double>(k / 4) - 0.5};
    ring(center, 0.02 + 0.2 * random.unit(), 0.5, static_cast<std::int32_t>(5 + random.below(20)));
    pslg.holes.push_back(center);
  }
  return pslg;
}

Pslg input_of(std::uint64_t seed) {
  Numbers random(seed);
  Pslg pslg = seed % 4 == 0   ? tangle(random)
              : seed % 4 == 1 ? raw_rings(oracles::make_random_polygons(seed), 1)
              : seed % 4 == 2 ? crossed(seed, random)
                              : coast(random);
  if (seed % 3 == 0)
    for (std::size_t i = 0; i < pslg.points.size(); ++i)
      pslg.point_markers.push_back(static_cast<std::int32_t>(random.below(3)));
  if (seed % 7 == 0) {
    pslg.attributes_per_point = 1;
    for (std::size_t i = 0; i < pslg.points.size(); ++i) pslg.attributes.push_back(random.unit());
  }
  if (seed % 4 == 0) {
    pslg.holes.push_back({5 * random.unit(), 5 * random.unit()});
    pslg.regions.push_back({{5 * random.unit() + 1e-45, 5 * random.unit()}, 3, 0.5});
  }
  return pslg;
}

void add(ValueDigest& digest, const Pslg& pslg) {
  for (const Point& p : pslg.points) digest.add(p.x), digest.add(p.y);
  for (const Pslg::Segment& s : pslg.segments)
    for (const std::int32_t value : {s.a, s.b, s.marker}) digest.add(std::int64_t{value});
  for (const std::int32_t marker : pslg.point_markers) digest.add(std::int64_t{marker});
  for (const double value : pslg.attributes) digest.add(value);
  for (const Point& p : pslg.holes) digest.add(p.x), digest.add(p.y);
  for (const Pslg::Region& region : pslg.regions)
    for (const double value : {region.at.x, region.at.y, region.attribute, region.max_area}) digest.add(value);
  for (const Pslg::Polygon& polygon : pslg.polygons) {
    digest.add(std::int64_t{polygon.region});
    for (const Pslg::Ring& ring : polygon.rings) {
      digest.add(std::uint64_t{ring.size()});
      for (const std::int32_t corner : ring) digest.add(std::int64_t{corner});
    }
  }
}

std::uint64_t digest_of_case(std::uint64_t seed, std::size_t& simplified) {
  ValueDigest digest;
  try {
    Pslg pslg = input_of(seed);
    RepairOptions options;
    if (seed % 3 != 1) options.snap = seed % 2 == 0 ? 0.01 : 0.1;
    options.hull = seed % 5 == 0 && pslg.polygons.empty();
    const RepairReport report = repair(pslg, "input", options);
    add(digest, pslg);
    digest.add(std::string_view(report.summary()));
    digest.add(report.largest_move);
    for (const std::int32_t original : report.original_point) digest.add(std::int64_t{original});
    for (const double tolerance : {0.02, 0.3}) {
      const SimplifyReport thinned = simplify(pslg, tolerance);
      add(digest, pslg);
      digest.add(thinned.points);
      digest.add(thinned.rings);
      for (const std::int32_t original : thinned.original_point) digest.add(std::int64_t{original});
      simplified += thinned.points > 0;
    }
  } catch (const Error& error) {
    digest.add(std::string_view(error.what()));
  }
  return digest.value();
}

constexpr std::array<std::uint64_t, 160> kRecorded{
    0x4f3654c81a409a43, 0x27725aae0e4156a2, 0xb4cf18ebfda8278e, 0x05227e65468ad5ac, 0x9ad75125c5e67021,
    0xeac8914c80ce1ea0, 0xbd871ffe02bbc14d, 0x22cf71186afff426, 0x7cbe38b75a975781, 0xe19e807340a5120f,
    0x0f15af17b9e323cb, 0x25c022285d5215b9, 0xe78298f7b70c7eef, 0x173839f18430029f, 0xbbf6890480881234,
    0x397a0004e2631ddc, 0xeacebd08d985af8a, 0x6a2f9b5d6bd29ea3, 0xf7bb0206976a57ab, 0x0c36868c5e038fa4,
    0x2b1284bed4a2b720, 0x6ed387075a2372e3, 0x65260e71ee7c1cc7, 0x86d2b56ac84fddac, 0xb59a38ed9438a0d2,
    0xf96010e23a6c284a, 0x0757dbdd276925d0, 0xec586d61625511cd, 0xd7f866fc0bfe5664, 0xfc7dcc9448d23679,
    0x2ddced873aab01ce, 0x9cc5e29755655329, 0x184c60049be1848d, 0xd48e930d7a44effe, 0x4d1c748ddf60f4d2,
    0x3a94263a82c543d0, 0x377bc5d8329285b9, 0x66e69fb72b550be4, 0xaa3284be50c6a85a, 0x1f62cf9c4d3f85aa,
    0xdb4eda122d933820, 0x66f2a789e75864a5, 0x8bba53d7ee178760, 0x2269281200d807c4, 0x9799a2d8ca3967f8,
    0xf1bbdb6f0b7584b2, 0x302331ddc25ef7bf, 0x6169f1656a231f1c, 0x1b365e4905fb50a9, 0x44e8a6e9e7d85a14,
    0x240af5daab02199e, 0x8a2c875659e10911, 0x5138e70ed282bda4, 0x5e2675f348593bab, 0xfc431f332f5d2037,
    0x39a9e103159f56ff, 0x4f3e972bad3071cc, 0x09b4ea0ee76558f4, 0x97f3046ffbd76c90, 0xc605ce61dc131469,
    0xd82dbeb547d843fe, 0xc403b0515c2e8a40, 0xfeda67a37ea1c048, 0x4dd51bd8236905d4, 0x3044ab940eda9bb0,
    0x5a8dce69203bf733, 0x5b46171be63bf923, 0x29a385f9891a1957, 0x2e6419a68e5c8454, 0xe05e951cc805352c,
    0xee41c736b487c6be, 0xf93a0b89366a099a, 0x8b0e49fe432fd4d1, 0x739e606a41fafade, 0xc845c74c8cb25038,
    0x54ae4301d4e8198d, 0xac26db1a280b8f4d, 0x27211c0975347eb5, 0x73eca5981cb830e7, 0x762f3aeb2ccebfc3,
    0x970ec6ec7be2a45b, 0xad6a1a3e9d858ce1, 0x53c326d40116f866, 0x8dbf76f147692a66, 0x72725a716f5f2c86,
    0xaab8924a68164a2b, 0xfd4811d6dba507b3, 0xe19dcbd7220590f0, 0x27767aac2d7037b6, 0x1fb9b4e3b1f87ed2,
    0xab2479c48cd446d4, 0x64735ba13b4970ce, 0x83e8be0797332da6, 0x17f158c226a89eff, 0x76b8343b0fe2a4a7,
    0xf1c2ff9f3e661573, 0x0f41cb01ec0e95fd, 0xf9c2411adc178944, 0xb73d423593a9d9bb, 0xdcfaa760f65e8cac,
    0xcde10e23677547ad, 0x6263429089ab5621, 0x6833caaf8da1a90b, 0x6e8ee1a57f25c450, 0x0ba63d8d8ca3c607,
    0x4d69566995e21600, 0x7d034004ca8e7598, 0xf4d15907f2385719, 0x7a4bb397ae5d21e4, 0x6da4bddccb734e42,
    0xc7452311199cecbb, 0x0b464f53f8fea29f, 0x8308e1feca725f0f, 0x5450f199b541616b, 0x70e839647668338e,
    0xba059f0723bc8034, 0x5c905e123bfa9fe8, 0xcafe4920c02e7a79, 0x6db7e49b48241384, 0xa8f52ce8cd28caf9,
    0x530220ed9495638a, 0x5afc4e7ffb86ebd0, 0x26e6265ae031ca10, 0x0cd1e48fe50d7fee, 0x728460ff99e254e2,
    0x1118457189a25ddb, 0x7fb0ee1bd292b822, 0x2971a5f3e4aa4edf, 0xc24939d3c86be9d5, 0xebd59cf0863ed2f3,
    0xc0fec43c21842b4a, 0xdc148a1a145e5f92, 0xf522e3068760f9df, 0xbb85a8b2ae048b6b, 0x450acb0bfea97344,
    0xedfad47ae815554b, 0xe1450cd0b01beddf, 0x16980678a838e466, 0xbc7f05a20de9b5ea, 0xf9a37188acbabead,
    0x2b9a4139c0623967, 0xa69d4c2554390ae9, 0x71116422928003bd, 0xc77181033ff6b2a0, 0x133dafbb2944f277,
    0x770f2e0b3c03fc69, 0x4e5734f52d411bd1, 0x94998eb528b98be2, 0xa7eff58421b3ded1, 0xa403f718f173ddc2,
    0x3fd07cb95a736a72, 0x63b1f707d5c4f2bc, 0x145cedd6b35b9b5b, 0x202d8eaee3fc18b0, 0x2265c786ec6fe005,
    0xb8c319e70abb69cd, 0x94a458b2bb66937b, 0x1077f627fefcdf5c, 0x290ccd39a79dc72f, 0x50161729c7dad8d5};

}  // namespace

TEST_CASE("repairs are those that were recorded") {
  std::size_t simplified = 0;
  check_recorded(kRecorded, [&](std::uint64_t seed) { return digest_of_case(seed, simplified); });
  CHECK(simplified > 60);
}
