#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "driftmesh/generate.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/digest.hpp"
#include "mesh/forecast.hpp"
#include "mesh/refiner.hpp"
#include "raster/raster.hpp"
#include "small_domains.hpp"
#include "support/prepared_mesh.hpp"
#include "support/random_domain.hpp"
#include "support/recorded.hpp"
#include "support/value_digest.hpp"

// Meshes of small domains of many kinds by many kinds of bounds, to the last bit, with what the refiner counts and the
// forecast says. tests/digests has those of real inputs, as users make them.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

class Front final : public SizeField {
 public:
  [[nodiscard]] double edge_length(const Point& p) const override {
    return 0.02 + 0.3 * std::abs(std::hypot(p.x, p.y) - 0.5);
  }
};

/// Depths that grow with x.
std::shared_ptr<const Raster> shelf() {
  TiledGrid grid(RasterFrame{9, 9, {-2, -2}, 0.5, 0.5});
  for (std::int64_t j = 0; j < 9; ++j)
    for (std::int64_t i = 0; i < 9; ++i) grid.set(i, j, static_cast<float>(2 + 5 * i));
  return std::make_shared<const GridRaster>(std::move(grid));
}

Pslg domain_to_refine(std::uint64_t seed) {
  switch (seed % 5) {
    case 0:
      return fan(static_cast<unsigned>(seed), static_cast<int>(3 + seed % 20));
    case 1:
      return rectangle(2, seed % 2 == 0 ? 1 : 0.01);
    case 2:
      return generate_holes({.columns = 3, .rows = 2});
    default:
      return random_domain_with_areas(seed);
  }
}

std::uint64_t digest_of_refinement(std::uint64_t seed, std::int64_t& triangles) {
  constexpr std::array<double, 6> kAngles{20, 0, 10, 28, 33, 25};
  const Front front;
  const TimeStep step({.step = 0.004}, shelf());
  const Pslg input = domain_to_refine(seed);
  Triangulation mesh = prepared(input);
  QualityBounds bounds;
  bounds.min_angle = kAngles[seed % kAngles.size()];
  if (seed % 3 == 0) bounds.plain.area = 0.002;
  if (seed % 3 == 1) bounds.region_max_area = areas_by_region(input);
  if (seed % 4 == 0) bounds.size = &front;
  if (seed % 7 == 0) bounds.step = &step;
  if (seed % 11 == 0) bounds.rules.conforming = true;
  if (seed % 13 == 0) bounds.rules.split = InsertionRules::Split::kInside;
  if (seed % 13 == 1) bounds.rules.split = InsertionRules::Split::kNowhere;
  if (seed % 17 == 0) bounds.rules.most_points = 40;
  ValueDigest digest;
  digest.add(forecast_triangles(mesh, bounds));
  Refiner refiner(mesh, bounds);
  while (refiner.refine(50) == Refiner::Status::kBudget) {
  }
  digest.add(mesh_digest(mesh));
  const RefineCounters& c = refiner.counters();
  for (const std::int64_t count : {c.free_points, c.segment_points, c.deleted_points, c.encroaching, c.given_up})
    digest.add(count);
  triangles += static_cast<std::int64_t>(mesh.live_triangles());
  return digest.value();
}

constexpr std::array<std::uint64_t, 160> kRecorded{
    0x7cd32433eda7b4e2, 0xd2a3772025e5cc9f, 0x5510201cc62118a8, 0xf17ff59a5b6b3684, 0xea17504ede5c1a23,
    0xa6885b9a6ae02e16, 0xb719793f85f4ea20, 0x59b0daa3df930793, 0x5f394210d6c47b65, 0x7b2911ee0701b348,
    0x5cd92f2d1478355e, 0x047c8595d2e47dc2, 0xa392a63056464704, 0xabd1dc46930acbde, 0xe546e9aecb084a3b,
    0xe8687fbebd816272, 0x294d5078013fe851, 0x6982153b664e9a51, 0xcf766d4a2633e703, 0xcda13a4c054a8dc6,
    0x305eae6259ca1e97, 0xd52bd671e6d7a082, 0x10ce86c5d8208092, 0xffa44432efdade1e, 0x184ef2e04443725c,
    0x69e9116151d7f5c4, 0x5482248db413d3e7, 0x6502021f24d578e4, 0xcec008cf3aec1063, 0x04699e638f84ea39,
    0x7cd32433eda7b4e2, 0x74fa833f9e06ec71, 0xdaa7bfcc21a07e84, 0x4e98716ea6e041ff, 0x529951e249367d26,
    0xd1504a048217fe33, 0xb719793f85f4ea20, 0x07b4b7a0a6acbd08, 0x068478113e7863b8, 0xfcf2be0e6c43699d,
    0x305eae6259ca1e97, 0xf26240b3bc00b371, 0x816d9bae8606444c, 0x02c0c177a9466f2b, 0x04553d5e852f661b,
    0xb8a7dfd74d1c7f50, 0x59d978358e5aece8, 0xc38b64c555ed732c, 0x59c28de480847a4c, 0x02d8c37c0aa1fbde,
    0x9a238cce76580047, 0x48b6bc4dd5e87d47, 0xc2988185b6ad55b9, 0xb2d99cf3a99e704d, 0x9163ad85361d03d3,
    0x8680aa05c22b7f6e, 0xc59aecfa52bd8f45, 0x9b17d1d77c9d7ec5, 0x9b412782db00e842, 0x070f778644f1a59c,
    0x7cd32433eda7b4e2, 0xd2a3772025e5cc9f, 0xeaadd255c30037bf, 0x65da2aa7abfa54a9, 0x7335f85ac5f5e18b,
    0xa04c2b29f2f026e4, 0xb719793f85f4ea20, 0xa588ecb52c695962, 0x31057e3cd2840833, 0x991eaf8d72222d42,
    0x305eae6259ca1e97, 0x047c8595d2e47dc2, 0x64f901b26a691158, 0x677dd234f7f604da, 0xd02f74258ebfdd8e,
    0xe8687fbebd816272, 0xa225c80bd3f36cbe, 0xe352ae06d8a85625, 0xd1a7b0bb0d63f6f4, 0x0838e01e7e4a1353,
    0x4ba7cec6cd0467aa, 0x9ee088632d75fb97, 0x01c1bdb12784d006, 0xc272671ede44db18, 0x7448b07d7d794b5f,
    0x69e9116151d7f5c4, 0xc59aecfa52bd8f45, 0x324133eb7169a5b3, 0xbbb0f9b339196189, 0xcec24b3fe743f756,
    0x7cd32433eda7b4e2, 0x0ab093d692e9c064, 0xac2056b9dc47c4e8, 0xb464ac767647503f, 0x68d0f60339b81d71,
    0xd1504a048217fe33, 0xb719793f85f4ea20, 0x0264106442cb2479, 0xcc73fc28b6150e02, 0xe1eaef2db9ea69dd,
    0x305eae6259ca1e97, 0xeac14abbd04e5cf8, 0xcccea90b789677c1, 0x50b2e98a098b9cca, 0x68edfb8a80df7f25,
    0xb8a7dfd74d1c7f50, 0x59d978358e5aece8, 0x5204e3946a4846ac, 0x62268654b2e10246, 0xb09de9c1837c53f2,
    0x4ba7cec6cd0467aa, 0xa5d2f6bd8a6ed69a, 0xe6ebb58aa3e5beaf, 0x3d0282be5090d304, 0xbbd586104d34b562,
    0xc99ab525b164b482, 0x5482248db413d3e7, 0x28e22792c742ddc9, 0x60c7943b4a53a2f2, 0xc2f34db266b70fbf,
    0x7cd32433eda7b4e2, 0xd2a3772025e5cc9f, 0x497711e27bfdeb82, 0xb732e94ee4f4d58c, 0x1c79ad7bac5c9ecb,
    0xfc5529f5cacf5bf4, 0xb719793f85f4ea20, 0x1172579d91e56545, 0x1f7eaa43bbc509c4, 0x8aa2d9b0d761113f,
    0x5b68fbc615624c80, 0xf7a98938acbc4fef, 0xcc88bf47013adf52, 0xb3f3577eaa56bfb0, 0x9532ab3ba0be8abc,
    0xae045f9b58f4fcb6, 0x59d978358e5aece8, 0x2f76024f5079f57c, 0x971e3dd8d9f92299, 0x175947c2bbb18acd,
    0x4ba7cec6cd0467aa, 0x9ee088632d75fb97, 0xe907618c46031512, 0xf60a05f22e40f27c, 0x05c015bca0734d19,
    0x69e9116151d7f5c4, 0x88d9edf2b80e4419, 0x73ffa0271e428e51, 0xd66da7b34a7f5099, 0x826c77c151f57033,
    0x7cd32433eda7b4e2, 0x74fa833f9e06ec71, 0x6d33b3619d7f4439, 0x8cacc95bd4d1142b, 0xc6cdf70aeb33b683,
    0x120cd815fb9320aa, 0xb719793f85f4ea20, 0x197c3f4681e0e7f6, 0xac6770cfa1f1d317, 0x36ee325c6f6c8ade};

}  // namespace

TEST_CASE("refinements are those that were recorded") {
  std::int64_t triangles = 0;
  check_recorded(kRecorded, [&](std::uint64_t seed) { return digest_of_refinement(seed, triangles); });
  CHECK(triangles > 50'000);
}
