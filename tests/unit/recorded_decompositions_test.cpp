#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

#include "decompose/check_decomposition.hpp"
#include "decompose/decompose.hpp"
#include "decompose/presplit.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/generate.hpp"
#include "driftmesh/size_field.hpp"
#include "support/prepared_mesh.hpp"
#include "support/random_domain.hpp"
#include "support/recorded.hpp"
#include "support/value_digest.hpp"

// Decompositions of many kinds of domains, to the last bit. All ranks of a run compute their own, whatever their
// hardware, and saved runs go on with them: what changes one changes all meshes that are made in subdomains.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

class Ring final : public SizeField {
 public:
  [[nodiscard]] double edge_length(const Point& p) const override {
    return 0.01 + 0.2 * std::abs(std::hypot(p.x, p.y) - 0.5);
  }
};

/// A domain at another place, in another size.
Pslg placed(Pslg domain, double offset, double scale) {
  const auto place = [&](Point& p) { p = {scale * p.x + offset, scale * p.y}; };
  for (Point& p : domain.points) place(p);
  for (Point& p : domain.holes) place(p);
  for (Pslg::Region& region : domain.regions) place(region.at);
  return domain;
}

/// A polygon whose best cut is one into three.
Pslg three_cornered(std::uint64_t seed) {
  Pslg pslg;
  std::mt19937_64 random(seed);
  const auto some = [&](double most) { return most * static_cast<double>(random() >> 11) * 0x1p-53; };
  pslg.points = {{some(0.3), -some(0.3)}, {1, some(0.2)}, {0.5, 0.8 + some(0.2)}};
  for (int k = 0; k < static_cast<int>(seed % 4); ++k) {  // with a dent
    const Point &a = pslg.points[0], &b = pslg.points.back();
    const Point middle{(a.x + b.x) / 2 + 0.1 - some(0.2), (a.y + b.y) / 2};
    pslg.points.push_back(middle);
  }
  const auto n = static_cast<std::int32_t>(pslg.points.size());
  for (std::int32_t i = 0; i < n; ++i) pslg.segments.push_back({i, (i + 1) % n, 1});
  return pslg;
}

Pslg domain_of(std::uint64_t seed) {
  switch (seed % 6) {
    case 0: {  // several parts, more than there are subdomains or fewer
      Pslg parts;
      for (std::uint64_t k = 0; k < 2 + seed % 7; ++k)
        append(parts, placed(random_domain_with_areas(100 * seed + k), 4.0 * static_cast<double>(k),
                             1 / static_cast<double>(1 + k * (seed % 4))));
      return parts;
    }
    case 1:
      return generate_holes({.columns = 3, .rows = 2});
    case 2: {
      BayOptions bay;
      bay.resolution = 1500;
      bay.seed = seed;
      return generate_bay(bay);
    }
    case 3:
      return generate_comb({});
    case 4:
      return random_domain_with_areas(seed, 9);
    default:
      return seed % 4 == 1 ? three_cornered(seed) : random_domain_with_areas(seed);
  }
}

std::uint64_t digest_of(const Decomposition& d, const QualityBounds& bounds) {
  ValueDigest digest;
  for (const GlobalPointId v : ids_of(d.points)) {
    digest.add(d.points[v].x);
    digest.add(d.points[v].y);
    digest.add(std::int64_t{d.origin[v]});
  }
  for (const GlobalRootId r : ids_of(d.roots)) {
    const Decomposition::Root& root = d.roots[r];
    for (const std::int32_t value :
         {to_int(root.a), to_int(root.b), root.marker, root.shell, to_int(root.left), to_int(root.right),
          std::int32_t{root.left_region}, std::int32_t{root.right_region}, std::int32_t{root.separator}})
      digest.add(std::int64_t{value});
    for (const dyadic::Path path : presplit_paths(d, r, bounds)) digest.add(std::uint64_t{path});
  }
  for (const Decomposition::Subdomain& s : d.subdomains) {
    for (const double value : {s.area, s.predicted, s.centroid.x, s.centroid.y}) digest.add(value);
    digest.add(std::int64_t{s.region});
  }
  for (const std::int32_t begin : d.root_begin) digest.add(std::int64_t{begin});
  for (const GlobalRootId r : d.root_list) digest.add(std::int64_t{to_int(r)});
  for (const std::int32_t begin : d.point_begin) digest.add(std::int64_t{begin});
  for (const GlobalPointId v : d.point_list) digest.add(std::int64_t{to_int(v)});
  return digest.value();
}

/// Of the decomposition that a case gives, or of none where the domain cannot be cut like that.
std::uint64_t digest_of_case(std::uint64_t seed, std::size_t& subdomains) {
  const Ring ring;
  const Pslg input = domain_of(seed);
  const Triangulation mesh = prepared(input);
  const Box box = Box::of(input.points);
  DecomposeOptions options;
  options.subdomains = static_cast<std::int32_t>(1 + seed * seed % (seed % 12 == 0 ? 7 : 37));
  if (seed % 12 == 5) options.subdomains = 3;
  if (seed % 3 == 0) options.bounds.plain.area = (box.high.x - box.low.x) * (box.high.y - box.low.y) / 1e5;
  if (seed % 3 == 1) options.bounds.region_max_area = areas_by_region(input);
  if (seed % 5 == 0) options.bounds.size = &ring;
  if (seed % 2 == 0) options.bounds.min_angle = 20;
  if (seed % 7 == 0) options.skew = 0.5;
  options.seed = seed;
  options.whole_segments = seed % 8 == 1;
  try {
    const Decomposition d = decompose(mesh, options);
    CHECK(check_decomposition(d).valid());
    subdomains += d.size();
    return digest_of(d, options.bounds);
  } catch (const Error&) {
    return 0;
  }
}

constexpr std::array<std::uint64_t, 240> kRecorded{
    0x70f566b3f359f8e3, 0xdab5aede4280031c, 0x99fb80f7906dac3a, 0x91e626c5f85fcce9, 0xa9eb54f4a936a6c9,
    0x121d42d335d15ba9, 0x9731f935ebd35b5f, 0x60ec5c8d16220232, 0x7539c4ef25434897, 0xd13224dbd26b8d7d,
    0x54b1088468105f8a, 0x6d4ae6360f4c11a7, 0x514787f402f196ee, 0x6cee268ce8c5d3e0, 0xd1cb3ed7af6fa428,
    0xb621329faa84c5ff, 0x0000000000000000, 0xbe9f4c69284bb5ce, 0x2c51b32f683581e8, 0x1927045dd4cb2c4b,
    0x66a10766ca5b7d98, 0xbedea2a66712c526, 0x83b45ab54741904b, 0x3c63820873a6e193, 0x7cd90e75bb5ec450,
    0xa875f4e25127ed15, 0x03a202d358644e3c, 0xc0f39b96a80bdea2, 0xc7125dac9d4a171d, 0x528fbf330f14d7c7,
    0xdcde9d13c97831f1, 0x19b128cada6c62b7, 0x578d9865e0877cb1, 0xc7cec42f0ec55342, 0x5be52bac8eb619b1,
    0xa0b0c12262068615, 0x30ad237ebd29dcf6, 0x2e3f5b3d966482f0, 0xcd0274ec957fb335, 0x323a67dd29068bd5,
    0xf5fbe184e960ba60, 0x66a2313f531f39b9, 0xdcde9d13c97831f1, 0x1fc35bc384241955, 0x3a82dc0b79e78bc9,
    0xfee8ac6d0a6cbc8f, 0x89089d0ca384b5e2, 0xf14a88849393d7b1, 0x61f6717b8fbeb3f2, 0x3fa2aae9ed004940,
    0x177be655b3cabb45, 0x7a4760ce999c5bcd, 0x86c303c42482dae5, 0xbb232903a0430b78, 0xc9099fd81f5f4730,
    0x8bd79c0b15b5a7c4, 0xec5b16ddc7b2a7b3, 0x7b2c7c91b162a572, 0x2a06aac7a73b44d7, 0x2a774adb4a675587,
    0x514787f402f196ee, 0x6f40b1e73aa52715, 0xead726ffd72c9899, 0x7ddb3fa570e7aa2b, 0x0000000000000000,
    0x139e8f22bdfb43d0, 0x51e2515e098cfcd7, 0xffc3b5b70d567fb2, 0x772b85b7be728ea2, 0x196827ebd986cc07,
    0x8afac33d3ebc2a97, 0xb69bc932a4b24a4f, 0x70f566b3f359f8e3, 0xad25c67b660e4881, 0xa6988999ca11f345,
    0xb6e1e161a29a86f9, 0x1fff56ddf9f69db7, 0xa119ac897e2ee073, 0x10e7937e096bea94, 0x020808bc1f8fab53,
    0xb3838f370d1255db, 0x9c77206be8218efc, 0xfd1fe4e63b47e73e, 0xd4baa2d059cc178f, 0x45c9a62c3de64ef6,
    0xac7addf7388b8514, 0x4a3479322b527f0a, 0xbef8c957f83ea0d9, 0x0000000000000000, 0xffa5915d28897da7,
    0xba9b3fe8336309fb, 0x877f5536d23dfc37, 0x714f15f5fcd6d308, 0xf77cab06fdec8c5c, 0x064de363381530a9,
    0x6ca99f016c578548, 0xb6604edf432ad492, 0x4ca25d8c7853b2db, 0xac4fc3c59c7193cf, 0x3fec0e2072622628,
    0x24b21c8e5b6feb1b, 0xbcdc6d5edb263fc1, 0x3ed8b2e2bae06109, 0x4d65ca4aa76a1c01, 0xadb57208b8050ece,
    0xed263e9638ac5ce8, 0x466d0207ac84e796, 0xc561007e552afb13, 0x553279682daca107, 0x800b7d2c90b79d52,
    0xf74fb7be43ba5a7f, 0x2ed5078662131eb8, 0xb450e9c286f7b2c5, 0x26b8f71cecb33378, 0xc6ffb5a325a24ee1,
    0x02168df450793e72, 0x3ccb38cc35b6c643, 0x7dd2d684c2810ba2, 0x1666fd38da1c333e, 0xbf4f3643fdee2eb6,
    0xb94b0472c7840995, 0xa1ca1ee16fe17655, 0xac4fc3c59c7193cf, 0x55d7872bb456b303, 0xe7c42f5e41b49ff1,
    0x05a1f5f1c525f629, 0x79eed97772f5d7ce, 0x0bcfebc0dee5062f, 0xc72921439101e3c9, 0xc67f6da08778fd00,
    0xe96459ba8a0f9685, 0x46eab494045c7fc1, 0xc7804fa9762bfae5, 0xcb535f3ccd5c96d1, 0xa7a9b72541da2669,
    0x9bb01694df161c5f, 0x0000000000000000, 0x2b521cda24a59ff3, 0x9dfd435d2a2dcc4a, 0x273924cb6100cebf,
    0xd99c57e7f023b62e, 0x8d475ca7a7f107a9, 0x75c4f311c06986c5, 0xb1a73644730960d5, 0xe45623a6ea1e5118,
    0xebd1f987e4730f28, 0xb926f59552b902d2, 0xeaf040a136cdd7c1, 0xd1d46a681e192c23, 0xab727e0c6f60570a,
    0x019aeae7702036dc, 0xa26e7c78d5a0ba35, 0x63e7daf7655c0a20, 0xb9adc9fe67f05559, 0x533a4330a4481130,
    0xb9e59296a5b2f1bd, 0x9dfd435d2a2dcc4a, 0x0ca8b85ef41847cb, 0x1f02f27d5024ff57, 0xc7576f391d2eee38,
    0x8bd659634e72af6b, 0x925383d3c28b11de, 0xf331130e842e981f, 0xe0356966207751ed, 0x100d8507427d8971,
    0xecd2d7ee5fa29fce, 0xacd97ce21821a128, 0x1c59313d055c86e8, 0x0724b1c2abdbd80c, 0x6b03799d11b3d58d,
    0x177be655b3cabb45, 0x96f71717639fd738, 0x833ee7e6b2c70803, 0xc8a1006602f8be3d, 0x95b68a4bba21ec29,
    0xc194dee9d519d900, 0xbac190b0a0f38aef, 0xae532e7c307ce7dc, 0x83979763413cf650, 0x9859500a80395d42,
    0xb503ba58c632649a, 0xbe3ffdbf5379247a, 0xcd0274ec957fb335, 0x0456905c0b30b457, 0x0000000000000000,
    0xc344f3677a2384c2, 0x553279682daca107, 0x7f0775c37d712e1f, 0xbc25f08b5d48ed97, 0xdd067e8e766bf137,
    0x2c555ab346abf3b6, 0x567c0c2b7d0de1c1, 0xb5f8e5b9d3ccd8ab, 0x414fd07f2cc460ec, 0x6bc8187bbda78930,
    0x4946db6245b4d94c, 0xee75a7c756b02ccf, 0xa152ef0ab198234c, 0x9a032b774f3e7eb4, 0xb2fd18b4bfc19957,
    0x1e950aa222b21a24, 0xf7e5e7dcf39625bc, 0x118b781e50b1c969, 0xef6eadc8c84f7e13, 0x2402a161e1975462,
    0x48c749ef29c10a21, 0x95507b008b036e02, 0x36a6180ca47b0c11, 0x27af53b614bdf2fb, 0x8d5359fd5fa25929,
    0xe042867d3fec4bf9, 0x938f3b5d808a7ed1, 0xc2cd364fe6315aef, 0x09ee4ca76bf4c8a1, 0x8bd0f4bb504ecec2,
    0x88ab9c02a70c4af6, 0x51527c6c5343e381, 0xa6eb1cedbec2ae08, 0x99fb80f7906dac3a, 0xaa6d3122dba37d89,
    0xdd684e865095e21f, 0xe5bb22a0c7f91301, 0x70f566b3f359f8e3, 0xb7fe4f88b055b681, 0x8453604a1ac70cf8,
    0x414bc55db66f8f39, 0x1503672ac8d7f011, 0xf3f1b3e82215c77f, 0x51e2515e098cfcd7, 0x3b96070d9f61fe9e,
    0x7e86dddb8a9ea390, 0x719093a68900080f, 0x0000000000000000, 0x58d84c504150048b, 0xd75d11ded07ec348,
    0x3c14e490324fa404, 0x95507b008b036e02, 0x8a435e2ebba19ce9, 0x9f06160df19b45b5, 0x2519a3c7b2da6bcd};

}  // namespace

TEST_CASE("decompositions are those that were recorded") {
  std::size_t subdomains = 0, cut = 0;
  check_recorded(kRecorded, [&](std::uint64_t seed) {
    const std::uint64_t digest = digest_of_case(seed, subdomains);
    cut += digest != 0;
    return digest;
  });
  CHECK(cut > 200);
  CHECK(subdomains > 1000);
}
