#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "adapt/generation.hpp"
#include "adapt/loads.hpp"
#include "adapt/mend.hpp"
#include "adapt/parcel.hpp"
#include "adapt/saved.hpp"
#include "distributed/parts_file.hpp"
#include "distributed/ranks.hpp"
#include "support/adaptive_start.hpp"
#include "support/error_text.hpp"
#include "temporary_folder.hpp"

// What parts of an adaptive mesh take along and cost, and what is read of them.

using namespace driftmesh;
using namespace driftmesh::adapt;
using namespace driftmesh::testing;

namespace {

/// A square in four parts, all in this process.
struct FourParts {
  FourParts() : live(made()) {
    Parts parts(live.plan.decomposition.size());
    for (auto& [s, mesh] : live.parts) parts[s] = first_part(std::move(mesh), live.plan.bounds, {});
    OneRank alone;
    generation = assemble(live.plan.decomposition, live.pslg, std::move(parts), alone);
  }
  static job::LiveMesh made() {
    Pslg square;
    square.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    square.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
    return first_generation(square, {.max_area = 0.01, .subdomains = {.count = 4}});
  }

  job::LiveMesh live;
  Generation generation;
};

Generation four_parts() {
  return FourParts().generation;
}

/// Data of all kinds, each value another one.
adapt::Fields numbered_fields(const Generation& generation) {
  adapt::Fields fields;
  fields["a"] = {FieldPlace::kPoints, Transfer::kInterpolate, 2, {}};
  fields["b"] = {FieldPlace::kTriangles, Transfer::kInterpolate, 1, {}};
  fields["c"] = {FieldPlace::kCorners, Transfer::kInterpolate, 2, {}};
  fields = without_values(fields, generation.piece);
  for (auto& named : fields)
    for (std::size_t k = 0; k < named.second.values.size(); ++k) named.second.values[k] = 1 + static_cast<double>(k);
  return fields;
}

}  // namespace

TEST_CASE("data of parts are all data") {
  const Generation generation = four_parts();
  const adapt::Fields fields = numbered_fields(generation);
  CHECK(fields.at("a").values.size() == 2 * generation.piece.mesh.points.size());
  CHECK(fields.at("b").values.size() == generation.piece.mesh.triangles.size());
  CHECK(fields.at("c").values.size() == 6 * generation.piece.mesh.triangles.size());
  adapt::Fields put_together = without_values(fields, generation.piece);
  for (const SubdomainId s : generation.here)
    set_values_on(generation, s, unpack_parcel(pack(generation, s, fields), Source::kUnknown).values, put_together);
  for (const auto& [name, field] : fields) CHECK(put_together.at(name).values == field.values);
}

TEST_CASE("data that do not fit a part are refused, whatever is wrong with them") {
  const Generation generation = four_parts();
  const SubdomainId s = generation.here[1];
  adapt::Fields fields = numbered_fields(generation);
  const ValuesOnPart values = values_on(generation, s, fields);
  const auto refusal = [&](const auto& change) {
    ValuesOnPart changed = values;
    change(changed);
    return error_text([&] { set_values_on(generation, s, changed, fields); });
  };
  CHECK(refusal([](ValuesOnPart&) {}) == "no error");
  CHECK(refusal([](ValuesOnPart& v) { v.pop_back(); }) == "a part has other fields than the rank");
  CHECK(refusal([](ValuesOnPart& v) { v.emplace_back(); }) == "a part has other fields than the rank");
  CHECK(refusal([](ValuesOnPart& v) { v[0].pop_back(); }) == "field 'a' lacks values on a part");
  CHECK(refusal([](ValuesOnPart& v) { v[1].pop_back(); }) == "field 'b' lacks values on a part");
  CHECK(refusal([](ValuesOnPart& v) { v[2].push_back(0); }) == "field 'c' has too many values on a part");
}

TEST_CASE("times of parts make work, one for each part of the rank") {
  const Generation generation = four_parts();
  OneRank alone;
  Descendants same;
  for (const SubdomainId s : ids_of(generation.parts)) {
    same.whole.push_back(s);
    same.whole_of.push_back(s);
  }
  const auto loads = [&](std::vector<double> seconds) {
    return loads_of(generation, generation, same, {}, {.on_rank = {}, .on_parts = std::move(seconds)}, alone);
  };
  const Loads told = loads({1, 1, 1, 5});
  double all = 0;
  for (const double work : told.work) all += work;
  CHECK(all == doctest::Approx(static_cast<double>(generation.piece.mesh.triangles.size())));
  CHECK(told.work[SubdomainId{3}] == doctest::Approx(5 * all / 8));
  for (const std::vector<double>& wrong : {std::vector<double>{1, 1, 1}, {1, 1, 1, 1, 1}})
    CHECK(mentions(error_text([&] { static_cast<void>(loads(wrong)); }), "numbers of seconds for 4 subdomains"));
}

TEST_CASE("a part that has just been made has as many triangles for each asked one as it has") {
  const Generation generation = four_parts();
  for (const Part& part : generation.parts) {
    CHECK(part.asked > 10);
    CHECK(part.density * part.asked == doctest::Approx(static_cast<double>(part.mesh->mesh.live_triangles())));
  }
}

TEST_CASE("the size of a parcel is known before it is packed") {
  const Generation generation = four_parts();
  adapt::Fields fields;
  for (const SubdomainId s : generation.here)
    CHECK(packed_size(generation, s, fields) == pack(generation, s, fields).size());
  const Mesh& mesh = generation.piece.mesh;
  fields["u"] = make_field(mesh, "u", std::vector<double>(2 * mesh.points.size(), 1), FieldPlace::kPoints,
                           Transfer::kInterpolate);
  fields["v"] =
      make_field(mesh, "v", std::vector<double>(mesh.triangles.size(), 1), FieldPlace::kTriangles, Transfer::kConserve);
  fields["w"] = make_field(mesh, "w", std::vector<double>(3 * mesh.triangles.size(), 1), FieldPlace::kCorners,
                           Transfer::kConserve);
  for (const SubdomainId s : generation.here)
    CHECK(packed_size(generation, s, fields) == pack(generation, s, fields).size());
}

TEST_CASE("a saved session is refused that has other parts than it says, or comes from another machine") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "mesh.h5";
  const FourParts four;
  const Generation& generation = four.generation;
  OneRank alone;
  SavedHead head;
  head.plan = four.live.plan;
  head.plan.policy.reset();
  head.pslg = four.live.pslg;
  head.shares = 4;
  const auto refusal = [&] { return error_text<InputError>([&] { static_cast<void>(read_saved(path, alone)); }); };
  const auto parcel = [&](SubdomainId s) { return pack(generation, s, {}); };
  const auto save_by = [&](const std::function<Bytes(SubdomainId)>& packed) {
    save(path, head, {generation.here, [&](SubdomainId s) { return packed(s).size(); }, packed}, alone);
  };
  save_by(parcel);
  REQUIRE(refusal() == "no error");

  const Bytes sound = PartsFile(path, kAdaptiveMeshFile).head(kAdaptiveMeshFile.head);
  const auto write = [&](const Bytes& bytes, std::size_t count) {
    std::map<SubdomainId, std::uint64_t> sizes;
    for (const SubdomainId s : generation.here)
      if (to_index(s) < count) sizes[s] = parcel(s).size();
    write_parts(path, kAdaptiveMeshFile, {{kAdaptiveMeshFile.head, bytes}}, count, sizes, parcel, alone);
  };
  write(sound, 4);
  REQUIRE(refusal() == "no error");
  write(sound, 3);
  CHECK(mentions(refusal(), "it has another number of subdomains"));
  Bytes foreign = sound;
  foreign.front() ^= std::byte{8};  // how large something is in memory there
  write(foreign, 4);
  CHECK(mentions(refusal(), "it was saved by another build of driftmesh, or on another kind of machine"));

  const auto swapped = [&](SubdomainId s) { return parcel(SubdomainId{3 - to_int(s)}); };
  save_by(swapped);
  CHECK(mentions(refusal(), "subdomain 0 is another one"));

  const auto parcel_with_fields = [&](SubdomainId s) {
    return pack(generation, s, without_values(head.fields, generation.piece));
  };
  head.fields["u"].components = 4;
  head.shapes["u"] = {2, 2};
  save_by(parcel_with_fields);
  CHECK(read_saved(path, alone).head.shapes == head.shapes);
  for (const std::vector<std::int64_t>& wrong : {std::vector<std::int64_t>{}, {3}, {2, 4}, {-2, -2}, {0}, {2, 2, 0}}) {
    head.shapes["u"] = wrong;
    save_by(parcel_with_fields);
    CHECK(mentions(refusal(), "field 'u' has 4 values at each place, which have no shape"));
  }
  head.shapes = {{"v", {2, 2}}};
  save_by(parcel_with_fields);
  CHECK(mentions(refusal(), "it has a shape of a field 'v' that it does not have"));
}

TEST_CASE("vertices that a bound on areas needs stay, however much lengths grow") {
  const FourParts four;
  for (const SubdomainId s : four.generation.here) {
    const SubdomainMesh& part = *four.generation.parts[s].mesh;
    Lengths short_ones, long_ones;
    for (std::size_t v = 0; v < part.mesh.points.size(); ++v) {
      short_ones.push_back(0.01);
      long_ones.push_back(100);
    }
    const auto left = [&](const QualityBounds& bounds) {
      return mend(part, short_ones, long_ones, bounds, {}).mesh->mesh.live_triangles();
    };
    QualityBounds tight = four.live.plan.bounds;
    tight.plain.area /= 10;
    CHECK(left(tight) == part.mesh.live_triangles());
    QualityBounds none;
    none.min_angle = 20;
    CHECK(left(none) < part.mesh.live_triangles() / 2);
  }
}
