#include "migration/packed_form.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "driftmesh/error.hpp"
#include "driftmesh/mesh.hpp"
#include "mesh/digest.hpp"
#include "mesh/triangulation_fault.hpp"
#include "migration/packed_bytes.hpp"
#include "migration/subdomain.hpp"
#include "property/cases.hpp"
#include "support/id_literals.hpp"
#include "support/random_subdomains.hpp"
#include "support/same_state.hpp"

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

std::string refusal_of(const Bytes& bytes, const SubdomainContext& context, Source source = Source::kUnknown) {
  try {
    static_cast<void>(Subdomain::unpack(bytes, context, source));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The same payload with a new header, so that the content is tested, not the checksum.
Bytes sealed_again(const Bytes& bytes) {
  SealedBytes sealed(bytes.size());
  sealed.append(bytes.data() + sizeof(PackedHeader), bytes.size() - sizeof(PackedHeader));
  return sealed.take();
}

Subdomain half_refined(RandomSubdomains& world, SubdomainId id) {
  Subdomain subdomain(id, world.context());
  std::vector<SplitPoint<GlobalRootId>> said;
  subdomain.tell(world.split_of(id, 4));
  subdomain.work(40, said);
  subdomain.tell(world.split_of(id, 4));
  return subdomain;
}

Subdomain asleep(RandomSubdomains& world, SubdomainId id) {
  Subdomain subdomain = half_refined(world, id);
  std::vector<SplitPoint<GlobalRootId>> said;
  while (subdomain.active()) subdomain.work(10'000, said);
  subdomain.sleep();
  return subdomain;
}

/// Reads all arrays by all handles, so that a sanitizer can detect errors.
void look_at_everything(Subdomain& subdomain) {
  if (!subdomain.started()) return;
  if (subdomain.dormant()) {
    Mesh piece;
    piece.points = subdomain.dormant_mesh().points();
    subdomain.dormant_mesh().visit_triangles([&](const std::array<VertexId, 3>& corner, std::uint16_t) {
      piece.triangles.push_back({to_int(corner[0]), to_int(corner[1]), to_int(corner[2])});
    });
    CHECK(mesh_digest(piece) != 1);
    for (const RootId r : first_ids<RootId>(3)) CHECK_NOTHROW(static_cast<void>(subdomain.dormant_mesh().holds(r, 37)));
    REQUIRE_NOTHROW(subdomain.wake());
  }
  const Triangulation& mesh = subdomain.mesh().mesh;
  CHECK(mesh_digest(mesh) != 1);
  CHECK(subdomain.remaining() >= 0);
  for (const Subsegment& s : mesh.subsegments) CHECK(mesh.subsegments.has(mesh.descend(s.root, s.path)));
}

void check_refusals(const Bytes& whole, const SubdomainContext& context) {
  REQUIRE(refusal_of(whole, context) == "");
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 20) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    REQUIRE(refusal_of(cut, context).find("the packed form of a subdomain") == 0);
    if (size < sizeof(PackedHeader)) continue;
    REQUIRE(refusal_of(sealed_again(cut), context).find("the packed form of subdomain") == 0);
  }
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  CHECK(refusal_of(longer, context).find("bytes instead of") != std::string::npos);
  CHECK(refusal_of(sealed_again(longer), context).find("left over") != std::string::npos);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    Bytes changed = whole;
    changed[i] ^= std::byte{4};
    for (const Source source : {Source::kUnknown, Source::kThisRun})
      REQUIRE(refusal_of(changed, context, source) != "");
  }
  Bytes later = whole;
  later[offsetof(PackedHeader, version)] = std::byte{9};
  CHECK(refusal_of(later, context).find("version 9") != std::string::npos);
}

}  // namespace

TEST_CASE("a subdomain that has not started packs to its number and its pending points") {
  RandomSubdomains world(3, 4, 500);
  Subdomain subdomain(2_sub, world.context());
  CHECK(subdomain.pack().size() < 80);
  subdomain.tell({world.split_of(2_sub, 3).root, 5});
  CHECK(subdomain.pack().size() < 92);
  const Subdomain again = Subdomain::unpack(subdomain.pack(), world.context());
  CHECK(again.id() == 2_sub);
  CHECK(again.backlog() == 1);
  CHECK(!again.started());
  CHECK(again.active());
}

TEST_CASE("a dormant subdomain packs to little more than its size asleep") {
  RandomSubdomains world(5, 1, 3000);
  const Subdomain subdomain = asleep(world, 0_sub);
  const auto triangles = static_cast<std::size_t>(subdomain.triangles());
  REQUIRE(triangles > 1000);
  CHECK(subdomain.pack().size() < 16 * triangles);
  CHECK(subdomain.pack().size() < subdomain.dormant_mesh().bytes() + 250);
}

TEST_CASE("bytes that are truncated, extended, changed or foreign are rejected with a message") {
  RandomSubdomains world(11, 3, 300);
  for (const Bytes& whole : {half_refined(world, 1_sub).pack(), asleep(world, 1_sub).pack()})
    check_refusals(whole, world.context());
}

TEST_CASE("the packed form of another decomposition is rejected") {
  RandomSubdomains one(11, 5, 300), other(12, 3, 300);
  CHECK(refusal_of(half_refined(one, 1_sub).pack(), other.context()).find("not belong to this decomposition") !=
        std::string::npos);
  CHECK(refusal_of(Subdomain(4_sub, one.context()).pack(), other.context()).find("only 3") != std::string::npos);
}

TEST_CASE("damage with a correct checksum is rejected, or leaves a mesh whose indices are valid") {
  auto random = seeded_generator("damaged packed forms");
  int accepted = 0, refused = 0;
  for (std::int64_t i = case_count(20); i > 0; --i) {
    RandomSubdomains world(random() % 1000, 3, 200);
    const Bytes whole = (i % 2 == 0 ? half_refined(world, 0_sub) : asleep(world, 0_sub)).pack();
    for (int k = 0; k < 300; ++k) {
      Bytes changed = whole;
      for (auto flips = 1 + random() % 3; flips > 0; --flips) {
        const std::size_t at = sizeof(PackedHeader) + random() % (whole.size() - sizeof(PackedHeader));
        // Small numbers, since lengths and handles are small, and any others.
        changed[at] = static_cast<std::byte>(random() % 2 == 0 ? random() % 4 : random());
      }
      changed = sealed_again(changed);
      if (!refusal_of(changed, world.context()).empty()) {
        ++refused;
        continue;
      }
      ++accepted;
      Subdomain subdomain = Subdomain::unpack(changed, world.context());
      REQUIRE(subdomain.pack() == changed);
      look_at_everything(subdomain);
    }
  }
  MESSAGE(refused << " refused, " << accepted << " accepted");
  CHECK(refused > accepted);
  CHECK(accepted > 0);  // low bits of coordinates, forecasts and counters cannot be checked
}

TEST_CASE("bytes that say what cannot be are refused with the reason, however well packed") {
  RandomSubdomains world(21, 2, 400);
  const SubdomainState awake = unpack(half_refined(world, 0_sub).pack()), sleeper = unpack(asleep(world, 0_sub).pack());
  const auto refusal = [](SubdomainState state, const auto& break_it) -> std::string {
    break_it(state);
    try {
      static_cast<void>(unpack(pack(view_of(state))));
    } catch (const Error& error) {
      const std::string what = error.what();
      return what.substr(what.rfind(": ") + 2);
    }
    return "";
  };
  const auto nothing = [](SubdomainState&) {};
  REQUIRE(refusal(awake, nothing) == "");
  REQUIRE(refusal(sleeper, nothing) == "");
  CHECK(refusal(awake, [](auto& s) {
          constexpr dyadic::Path kTooDeep = dyadic::Path{1} << (dyadic::kMaxDepth + 1);
          s.pending.push_back({GlobalRootId{0}, kTooDeep});
        }) == "a split point has no valid place");
  CHECK(refusal(awake, [](auto& s) { std::swap(s.body->part.roots[RootId{0}], s.body->part.roots[RootId{1}]); }) ==
        "roots out of order");
  CHECK(refusal(awake, [](auto& s) { s.body->forecast = NAN; }) == "the forecast is not a number");
  CHECK(refusal(awake, [](auto& s) { s.body->refiner.size.clear(), s.body->refiner.size.push_back(1); }) ==
        "the size field is not known at each vertex");
  CHECK(refusal(awake, [](auto& s) { s.refined = true; }) == "it contradicts itself on being refined");
  CHECK(refusal(sleeper, [](auto& s) { s.refined = false; }) == "it is dormant but not refined");
  CHECK(refusal(sleeper, [](auto& s) { s.dormant->forecast = NAN; }) == "the forecast is not a number");
  const SubsegmentId behind = sleeper.dormant->mesh.skeleton().mesh.subsegments.next_id();
  CHECK(refusal(sleeper, [&](auto& s) { s.dormant->unsplittable = {behind}; }) ==
        "an unsplittable subsegment does not exist");
  const auto with_bytes = [](int which, const auto& change) {  // of the names, or of the trees
    return [which, change](SubdomainState& s) {
      int number = 0;
      DormantMesh::fields(s.dormant->mesh, [&](auto& field) {
        if constexpr (requires { field.push_back(std::byte{0}); })
          if (number++ == which) change(field);
      });
    };
  };
  const auto one_more = [](auto& bytes) { bytes.push_back(std::byte{0}); };
  CHECK(refusal(sleeper, with_bytes(0, one_more)) == "there are more names than there should be");
  CHECK(refusal(sleeper, with_bytes(1, one_more)) == "there are more trees than roots");
  CHECK(refusal(sleeper, with_bytes(0, [](auto& names) { names.back() = std::byte{4}; })) == "a root has no ends");
  CHECK(refusal(sleeper, with_bytes(1, [](auto& trees) { trees.assign(200, std::byte{255}); })) ==
        "a subsegment is cut too deep");
  const auto swap_points = [](SubdomainState& s) {
    DormantMesh::fields(s.dormant->mesh, [](auto& field) {
      if constexpr (requires { field[0].x; })
        if (field.size() > 1) std::swap(field[0], field[field.size() - 1]);
    });
  };
  CHECK(refusal(sleeper, swap_points) != "");  // its triangles lie the wrong way around
}

TEST_CASE("every invariant of a triangulation is checked") {
  RandomSubdomains world(21, 2, 400);
  const Triangulation sound = half_refined(world, 0_sub).mesh().mesh;
  REQUIRE(triangulation_fault(sound) == "");
  const auto fault = [&](auto&& break_it) {
    Triangulation mesh = sound;
    break_it(mesh);
    return triangulation_fault(mesh);
  };
  const auto inner = [](const Triangulation& mesh) {  // a leaf with two sides or one, and an inner node
    SubsegmentId s{0};
    while (mesh.subsegments[s].is_leaf()) s = after(s);
    return s;
  };
  const auto first = [](const auto& array, const auto& is_such) {
    const auto ids = ids_of(array);
    return *std::find_if(ids.begin(), ids.end(), [&](auto i) { return is_such(array[i]); });
  };
  const TriangleId live =
      first(sound.triangles, [](const Triangle& t) { return t.alive() && !is_constrained(t.neighbor[0]); });
  const TriangleId other = triangle_of(sound.triangles[live].neighbor[0]);
  const VertexId free = first(sound.origin, [](VertexOrigin o) { return o == kFree; });
  const VertexId vertex{0};
  CHECK(fault([&](Triangulation& m) { m.points[free].x = NAN; }) == "a coordinate is out of range");
  CHECK(fault([&](Triangulation& m) { m.points[free].x = 1e90; }) == "a coordinate is out of range");
  CHECK(fault([](Triangulation& m) { m.origin.push_back(kFree); }) == "the numbers of points and origins differ");
  CHECK(fault([&](Triangulation& m) { m.origin[vertex] = -1'000'000; }) != "");
  CHECK(fault([&](Triangulation& m) { m.free_vertices.push_back(vertex); }) == "the list of free vertices is wrong");
  CHECK(fault([](Triangulation& m) { m.free_triangles.push_back(TriangleId{0}); }) ==
        "the list of free triangles is wrong");
  CHECK(fault([&](Triangulation& m) { m.triangles[live].vertex[1] = kNone; }) != "");
  CHECK(fault([&](Triangulation& m) { m.triangles[live].vertex[2] = VertexId{1'000'000}; }) != "");
  CHECK(fault([&](Triangulation& m) { m.triangles[live].neighbor[0] = half_edge(m.triangles.next_id(), 0); }) != "");
  CHECK(fault([&](Triangulation& m) { m.triangles[live].neighbor[0] = half_edge(other, 3); }) != "");
  CHECK(fault([&](Triangulation& m) { m.triangles[live].neighbor[0] = constrained(SubsegmentId{1'000'000}); }) != "");
  CHECK(fault([&](Triangulation& m) { std::swap(m.triangles[live].vertex[0], m.triangles[live].vertex[1]); }) ==
        "a triangle is not counterclockwise");
  CHECK(fault([&](Triangulation& m) { std::swap(m.triangles[live].neighbor[1], m.triangles[other].neighbor[1]); }) !=
        "");
  CHECK(fault([&](Triangulation& m) {
          Triangle& t = m.triangles[live];  // rotated, but not its neighbors' references to it
          t = {{t.vertex[1], t.vertex[2], t.vertex[0]}, {t.neighbor[1], t.neighbor[2], t.neighbor[0]}};
        }) != "");
  CHECK(fault([&](Triangulation& m) { m.subsegments[inner(m)].path = 0; }) != "");
  CHECK(fault([&](Triangulation& m) { m.subsegments[inner(m)].child = SubsegmentId{0}; }) ==
        "the halves of a subsegment do not fit it");
  CHECK(fault([&](Triangulation& m) { m.subsegments[inner(m)].child = kNone; }) != "");
  CHECK(fault([](Triangulation& m) { m.roots[RootId{0}].tree = SubsegmentId{1}; }) != "");
  CHECK(fault([](Triangulation& m) { m.subsegments.push_back(m.subsegments.back()); }) != "");
  CHECK(fault([](Triangulation& m) { m.region.resize(3, 0); }) != "");
}
