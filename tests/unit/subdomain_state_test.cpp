#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/scratch_file.hpp"
#include "driftmesh/error.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/digest.hpp"
#include "migration/subdomain.hpp"
#include "property/cases.hpp"
#include "support/random_subdomains.hpp"
#include "support/same_state.hpp"
#include "temporary_folder.hpp"

// What a subdomain is, wherever it moves, sleeps and wakes: compared member by member, with each member holding
// something that it would not hold by itself.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Said = std::vector<SplitPoint<GlobalRootId>>;

Subdomain worked(RandomSubdomains& world, SubdomainId id, std::int64_t insertions) {
  Subdomain subdomain(id, world.context());
  Said said;
  subdomain.work(insertions, said);
  return subdomain;
}

std::vector<SubsegmentId> leaves_of(const Triangulation& mesh) {
  std::vector<SubsegmentId> leaves;
  for (const SubsegmentId s : ids_of(mesh.subsegments))
    if (mesh.subsegments[s].is_leaf()) leaves.push_back(s);
  return leaves;
}

/// Counters that no short refinement has, limits that nobody sets, segments that are called unsplittable.
template <class Random>
void fill(RefinerState& refiner, const Triangulation& mesh, Random& random) {
  for (std::int64_t RefineCounters::*const counter :
       {&RefineCounters::free_points, &RefineCounters::segment_points, &RefineCounters::deleted_points,
        &RefineCounters::encroaching, &RefineCounters::given_up})
    refiner.counters.*counter += 1'000'000 + static_cast<std::int64_t>(random() % 1'000'000);
  refiner.max_triangles = 5'000'000 + static_cast<std::int64_t>(random() % 1000);
  const std::vector<SubsegmentId> leaves = leaves_of(mesh);
  for (int k = 0; k < 3; ++k) refiner.unsplittable.insert(leaves[random() % leaves.size()]);
}

/// The state in the middle of refinement, with something in each member.
template <class Random>
SubdomainState filled(const Subdomain& subdomain, RandomSubdomains& world, Random& random) {
  SubdomainState state = unpack(subdomain.pack());
  SubdomainState::Body& body = state.body.value();
  CHECK(difference(body.part, subdomain.mesh()) == "");
  StateDifference lengths;
  lengths.compare("lengths", body.refiner.size, subdomain.lengths());
  CHECK(lengths.words() == "");
  fill(body.refiner, body.part.mesh, random);
  std::vector<TriangleId> alive;
  for (const TriangleId t : ids_of(body.part.mesh.triangles))
    if (body.part.mesh.triangles[t].alive()) alive.push_back(t);
  const auto any = [&] { return alive[random() % alive.size()]; };
  for (int k = 0; k < 3; ++k) {
    body.refiner.deferred.push_back(any());
    body.refiner.sweep.visit_again(any());
    body.refiner.skinny.add(any(), static_cast<int>(1 + random() % (SkinnyBuckets::kBuckets - 1)));
    body.refiner.made.push_back({static_cast<RootId>(random() % body.part.roots.size()), 1 + random() % 63});
    state.pending.push_back(world.split_of(state.id, 5));
  }
  body.forecast = 1e6 + static_cast<double>(random() % 1000) / 8;
  return state;
}

/// The segments that cannot be split, by what they are called in any numbering.
std::set<std::pair<GlobalRootId, dyadic::Path>> names_of(const SubdomainMesh& part, const auto& subsegments) {
  std::set<std::pair<GlobalRootId, dyadic::Path>> names;
  for (const SubsegmentId s : subsegments)
    names.insert({part.roots[part.mesh.subsegments[s].root], part.mesh.subsegments[s].path});
  return names;
}

/// A subdomain that has met its bounds, with counters, limit, forecast and segments as fill() makes them.
template <class Random>
SubdomainState finished(RandomSubdomains& world, SubdomainId id, Random& random) {
  Subdomain subdomain(id, world.context());
  Said said;
  while (subdomain.active()) subdomain.work(10'000, said);
  SubdomainState state = unpack(subdomain.pack());
  CHECK(difference(state.body.value().part, subdomain.mesh()) == "");
  fill(state.body.value().refiner, state.body->part.mesh, random);
  state.body->forecast = 1e6 + static_cast<double>(random() % 1000) / 8;
  return state;
}

}  // namespace

TEST_CASE("packed state comes back member by member") {
  auto random = seeded_generator("packed members");
  bool regions = false, sizes = false, free_slots = false;
  for (std::int64_t i = 0; more_cases(i, 30, regions && sizes && free_slots); ++i) {
    const std::uint64_t seed = random() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 3, 400);
    const auto id = static_cast<SubdomainId>(random() % world.size());
    const SubdomainState state = filled(worked(world, id, 60), world, random);
    const Bytes bytes = pack(view_of(state));
    CHECK(difference(unpack(bytes, Source::kThisRun), state) == "");
    CHECK(difference(unpack(bytes), state) == "");
    // The subdomain that is made of it has all of it, too.
    const Subdomain subdomain = Subdomain::unpack(bytes, world.context());
    CHECK(difference(unpack(subdomain.pack()), state) == "");
    CHECK(subdomain.forecast() == state.body->forecast);
    CHECK(subdomain.backlog() == 3);
    CHECK(subdomain.pack_small() == subdomain.pack());  // what has work cannot be packed asleep
    CHECK(subdomain.triangles() == static_cast<std::int64_t>(state.body->part.mesh.live_triangles()));
    CHECK(subdomain.remaining() == doctest::Approx(state.body->forecast - static_cast<double>(subdomain.triangles())));
    StateDifference counters;
    counters.compare("counters", subdomain.counters(), state.body->refiner.counters);
    CHECK(counters.words() == "");
    regions |= !state.body->part.mesh.region.empty();
    sizes |= !state.body->refiner.size.empty();
    free_slots |= !state.body->part.mesh.free_triangles.empty();
  }
  CHECK(regions);
  CHECK(sizes);
  CHECK(free_slots);
}

TEST_CASE("a subdomain that sleeps, moves and wakes keeps each member of its state") {
  auto random = seeded_generator("members of sleepers");
  const TemporaryFolder folder;
  ScratchFile scratch(folder.path().string());
  for (std::int64_t i = case_count(30); i > 0; --i) {
    const std::uint64_t seed = random() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 3, 400);
    SubdomainContext context = world.context();
    if (i % 2 == 0) context.scratch = &scratch;
    const auto id = static_cast<SubdomainId>(random() % world.size());
    const SubdomainState before = finished(world, id, random);
    const SubdomainState::Body& body = before.body.value();

    Subdomain subdomain = Subdomain::unpack(pack(view_of(before)), context);
    const std::uint64_t packed_awake = subdomain.packed_bytes();
    const Bytes small = subdomain.pack_small();
    subdomain.sleep();
    REQUIRE(subdomain.dormant());
    CHECK(small == subdomain.pack());
    CHECK(subdomain.triangles() == static_cast<std::int64_t>(body.part.mesh.live_triangles()));
    CHECK(subdomain.packed_bytes() == packed_awake);
    CHECK(subdomain.forecast() == body.forecast);
    StateDifference asleep;
    asleep.compare("counters", subdomain.counters(), body.refiner.counters);
    CHECK(asleep.words() == "");

    const SubdomainState dormant = unpack(subdomain.pack());
    REQUIRE(dormant.dormant.has_value());
    CHECK(dormant.refined);
    const SubdomainMesh shown = subdomain.woken();
    CHECK(mesh_digest(shown.mesh) == mesh_digest(body.part.mesh));
    CHECK(std::ranges::is_sorted(dormant.dormant->unsplittable));
    CHECK(names_of(shown, dormant.dormant->unsplittable) == names_of(body.part, body.refiner.unsplittable));
    CHECK(dormant.dormant->max_triangles == body.refiner.max_triangles);
    CHECK(dormant.dormant->forecast == body.forecast);
    CHECK(difference(unpack(pack(view_of(dormant))), dormant) == "");

    if (random() % 2 == 0) subdomain = Subdomain::unpack(subdomain.pack(), context, Source::kThisRun);
    CHECK(difference(unpack(subdomain.pack()), dormant) == "");
    subdomain.wake();
    CHECK(!subdomain.dormant());
    const SubdomainState after = unpack(subdomain.pack());
    REQUIRE(after.body.has_value());
    CHECK(after.refined);
    CHECK(difference(after.body->part, shown) == "");
    RefinerState expected = RefinerState::at_rest(after.body->part.mesh, context.bounds);
    expected.unsplittable.insert(dormant.dormant->unsplittable.begin(), dormant.dormant->unsplittable.end());
    expected.max_triangles = body.refiner.max_triangles;
    expected.counters = body.refiner.counters;
    CHECK(difference(after.body->refiner, expected) == "");
    CHECK(after.body->forecast == body.forecast);
    // Nothing of its sleep is left.
    CHECK(subdomain.take_mesh().mesh.triangles.size() == after.body->part.mesh.triangles.size());
  }
}

TEST_CASE("a packed form that does not fit the decomposition is refused, and one that does is not") {
  auto random = seeded_generator("misfits");
  int labels = 0, dormant_labels = 0, borders = 0;
  for (std::int64_t i = 0; more_cases(i, 40, std::min({labels, dormant_labels, borders}) > 0); ++i) {
    const std::uint64_t seed = random() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 4, 200);
    const Decomposition& d = *world.context().decomposition;
    const auto id = static_cast<SubdomainId>(random() % world.size());
    const SubdomainState sound = finished(world, id, random);
    const auto refusal = [&](const SubdomainState& state) {
      try {
        static_cast<void>(Subdomain::unpack(pack(view_of(state)), world.context(), Source::kThisRun));
      } catch (const Error& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    CHECK(refusal(sound) == "");
    std::uint16_t left = 0, right = 0;
    for (const GlobalRootId r : d.roots_of(id)) {
      left = std::max(left, d.roots[r].left_region);
      right = std::max(right, d.roots[r].right_region);
    }
    const auto& regions = sound.body->part.mesh.region;
    // Which side of a root a region is on does not matter.
    Decomposition mirrored = d;
    for (Decomposition::Root& root : mirrored.roots) std::swap(root.left_region, root.right_region);
    SubdomainContext other = world.context();
    other.decomposition = &mirrored;
    CHECK_NOTHROW(static_cast<void>(Subdomain::unpack(pack(view_of(sound)), other, Source::kThisRun)));

    SubdomainState state = sound;
    state.pending.push_back({static_cast<GlobalRootId>(d.roots.size()), 1});
    CHECK(refusal(state).find("waits for a root") != std::string::npos);
    if (!sound.body->part.points.empty()) {
      state = sound;
      state.body->part.points[VertexId{0}] = static_cast<GlobalPointId>(d.points.size());
      CHECK(refusal(state).find("unknown point") != std::string::npos);
    }
    for (std::size_t k = 0; k + 1 < sound.body->part.roots.size(); ++k) {
      const auto here = static_cast<RootId>(k);
      const GlobalRootId between{to_int(sound.body->part.roots[here]) + 1};
      if (between >= sound.body->part.roots[static_cast<RootId>(k + 1)]) continue;
      state = sound;
      state.body->part.roots[here] = between;
      CHECK(refusal(state).find("its border differs") != std::string::npos);
      ++borders;
      break;
    }
    if (regions.empty()) continue;
    state = sound;
    state.body->part.mesh.region[TriangleId{0}] = static_cast<std::uint16_t>(std::max(left, right) + 1);
    if (!state.body->part.mesh.triangles[TriangleId{0}].alive()) continue;
    CHECK(refusal(state).find("unknown region") != std::string::npos);
    ++labels;
    SubdomainState asleep{.id = id, .refined = true, .pending = {}, .body = {}, .dormant = {}};
    asleep.dormant.emplace().mesh = DormantMesh(state.body->part);
    CHECK(refusal(asleep).find("unknown region") != std::string::npos);
    ++dormant_labels;
  }
  CHECK(labels > 0);
  CHECK(dormant_labels > 0);
  CHECK(borders > 0);
}

TEST_CASE("what remains is what the forecast lacks, or the points that wait, or nothing") {
  auto random = seeded_generator("what remains");
  for (std::int64_t i = case_count(20); i > 0; --i) {
    const std::uint64_t seed = random() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 3, 200);
    const auto id = static_cast<SubdomainId>(random() % world.size());
    SubdomainState state = finished(world, id, random);
    state.body->refiner.unsplittable.clear();
    const auto triangles = static_cast<double>(state.body->part.mesh.live_triangles());
    for (const double forecast : {0.0, triangles + 1000.5}) {
      state.body->forecast = forecast;
      Subdomain subdomain = Subdomain::unpack(pack(view_of(state)), world.context());
      CHECK(subdomain.remaining() == 0);
      const std::uint64_t packed = subdomain.packed_bytes();
      for (int tries = 0; tries < 200 && subdomain.backlog() < 3; ++tries) subdomain.tell(world.split_of(id, 9));
      REQUIRE(subdomain.backlog() == 3);
      CHECK(subdomain.remaining() == (forecast == 0 ? 4 : 1000.5));
      CHECK(subdomain.packed_bytes() == packed + 3 * sizeof(SplitPoint<GlobalRootId>));
      // What it does in small slices is what it does in one.
      Subdomain twin = Subdomain::unpack(subdomain.pack(), world.context());
      Said said, by_twin;
      while (subdomain.active()) subdomain.work(1, said);
      twin.work(1'000'000, by_twin);
      CHECK(subdomain.pack() == twin.pack());
      CHECK(said == by_twin);
    }
  }
}

TEST_CASE("a subdomain of a later generation begins with its mesh, its lengths and the points that it lacks") {
  auto random = seeded_generator("beginnings");
  for (std::int64_t i = case_count(20); i > 0; --i) {
    const std::uint64_t seed = random() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 3, 200);
    const auto id = static_cast<SubdomainId>(random() % world.size());
    const SubdomainState::Body body = finished(world, id, random).body.value();
    const auto mesh = std::make_shared<const SubdomainMesh>(body.part);
    const auto triangles = static_cast<std::int64_t>(mesh->mesh.live_triangles());
    const RadialField huge({0, 0}, 1e9, 1);  // asks for nothing
    Beginning::Lengths lengths;
    for (const Point& p : mesh->mesh.points) lengths.push_back(huge.edge_length(p) / 2);  // those of another time
    IdVector<SubdomainId, Beginning> beginnings(world.size());
    SubdomainContext context = world.context();
    context.beginnings = &beginnings;
    const SplitPoint<GlobalRootId> split = world.split_of(id, 12);
    beginnings[id] = {.size = &huge, .mesh = mesh, .lengths = &lengths, .open = {}, .told = {split}};
    Subdomain told(id, context);
    CHECK(told.refined());
    CHECK(told.triangles() == triangles);
    CHECK(told.backlog() == 1);
    CHECK(told.active());
    Said said;
    told.work(1000, said);
    CHECK(told.forecast() == static_cast<double>(triangles));
    for (const VertexId v : ids_of(mesh->mesh.points))
      if (mesh->mesh.origin[v] != kDeleted && told.mesh().mesh.points[v] == mesh->mesh.points[v])
        CHECK((told.lengths()[v] == lengths[v] || told.lengths()[v] == huge.edge_length(mesh->mesh.points[v])));
    CHECK(told.lengths()[VertexId{0}] == lengths[VertexId{0}]);
    CHECK(told.lengths().size() >= told.mesh().mesh.points.size());
    for (const VertexId v : ids_of(told.mesh().mesh.points))
      if (!mesh->mesh.points.has(v)) CHECK(told.lengths()[v] == huge.edge_length(told.mesh().mesh.points[v]));

    // The largest triangle alone is open, and misses its bound.
    std::vector<std::pair<double, TriangleId>> areas;
    for (const TriangleId t : ids_of(mesh->mesh.triangles))
      if (mesh->mesh.triangles[t].alive())
        areas.emplace_back(signed_area(mesh->mesh.corner(t, 0), mesh->mesh.corner(t, 1), mesh->mesh.corner(t, 2)), t);
    std::ranges::sort(areas, std::greater<>());
    if (areas.size() < 2 || areas[0].first < 1.001 * areas[1].first) continue;
    context.bounds.size = nullptr;
    context.bounds.region_max_area.clear();
    context.bounds.plain.area = (areas[0].first + areas[1].first) / 2;
    beginnings[id] = {.size = nullptr, .mesh = mesh, .lengths = nullptr, .open = {areas[0].second}, .told = {}};
    Subdomain open(id, context);
    CHECK(!open.refined());
    CHECK(open.active());
    while (open.active()) open.work(1000, said);
    CHECK(open.triangles() > triangles);
    const Triangulation& after = open.mesh().mesh;
    for (const TriangleId t : ids_of(after.triangles))
      if (after.triangles[t].alive())
        CHECK(signed_area(after.corner(t, 0), after.corner(t, 1), after.corner(t, 2)) <= context.bounds.plain.area);
  }
}

TEST_CASE("what has work does not sleep, and what sleeps is not lost") {
  RandomSubdomains world(17, 2, 500);
  Subdomain subdomain = worked(world, SubdomainId{0}, 20);
  REQUIRE(subdomain.active());
  subdomain.sleep();
  CHECK(!subdomain.dormant());
  Said said;
  while (subdomain.active()) subdomain.work(10'000, said);
  subdomain.sleep();
  CHECK(subdomain.dormant());
  CHECK(subdomain.take_mesh().mesh.live_triangles() > 20);
}

TEST_CASE("a neighbor's point for which there is no room is an error, asleep and awake, here and elsewhere") {
  auto random = seeded_generator("no room");
  for (std::int64_t i = case_count(20); i > 0; --i) {
    const std::uint64_t seed = random() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 3, 300);
    const auto id = static_cast<SubdomainId>(random() % world.size());
    SubdomainState state = finished(world, id, random);
    // One of its own segments, as if coordinates had no room for the midpoint.
    const SubdomainMesh& part = state.body->part;
    const std::vector<SubsegmentId> leaves = leaves_of(part.mesh);
    const SubsegmentId full = leaves[random() % leaves.size()];
    state.body->refiner.unsplittable = {full};
    const Subsegment& segment = part.mesh.subsegments[full];
    const SplitPoint<GlobalRootId> beyond{part.roots[segment.root], segment.path};
    for (const int way : {0, 1, 2, 3}) {
      CAPTURE(way);
      Subdomain subdomain = Subdomain::unpack(pack(view_of(state)), world.context());
      if (way >= 1) subdomain.sleep();
      if (way == 2) subdomain.wake();
      if (way == 3) subdomain = Subdomain::unpack(subdomain.pack(), world.context());
      REQUIRE(!subdomain.active());
      subdomain.tell(beyond);
      REQUIRE(subdomain.active());
      Said said;
      const std::string words = [&] {
        try {
          subdomain.work(1000, said);
        } catch (const Error& error) {
          return std::string(error.what());
        }
        return std::string();
      }();
      CHECK(words.find("cannot be split") != std::string::npos);
    }
  }
}

TEST_CASE("a slice says what it did") {
  auto random = seeded_generator("slices");
  int begun = 0, woken = 0, on_borders = 0;
  for (std::int64_t i = case_count(30); i > 0; --i) {
    const std::uint64_t seed = random() % 100'000;
    CAPTURE(seed);
    RandomSubdomains world(seed, 4, 400);
    const auto id = static_cast<SubdomainId>(random() % world.size());
    Subdomain subdomain(id, world.context());
    WorkState state = subdomain.state();
    CHECK((state.active && !state.started && !state.refined && state.triangles == 0));
    CHECK(state.predicted == world.context().decomposition->subdomains[id].predicted);
    CHECK(state.forecast == state.predicted);
    Said said;
    std::int64_t points = 0, presplit = 0, triangles = 0, before = 0;
    for (int slice = 0; subdomain.active() || slice < 2; ++slice) {
      if (!subdomain.active()) {
        subdomain.sleep();
        before = subdomain.triangles();
        SplitPoint<GlobalRootId> split = world.split_of(id, 6);
        for (int tries = 0; tries < 50 && !subdomain.active(); ++tries) subdomain.tell(split = world.split_of(id, 6));
        if (!subdomain.active()) break;
        CHECK(subdomain.state().backlog == 1);
        CHECK(subdomain.state().refined);
      }
      const bool first = !subdomain.started(), asleep = subdomain.dormant();
      const SliceWork done = subdomain.work(50, said);
      CHECK(done.begun == first);
      CHECK((done.prepared > 0) == first);
      CHECK(done.woken == (asleep ? before : 0));
      begun += done.begun;
      woken += asleep;
      points += done.points;
      triangles += done.triangles + done.prepared;
      const std::int64_t made = subdomain.counters().free_points + subdomain.counters().segment_points;
      if (first) presplit = made - points;  // they come with the first triangulation
      CHECK((presplit == 0 || world.context().presplit));
      CHECK(points + presplit == made);
      CHECK(triangles == subdomain.triangles());
      CHECK(triangles == static_cast<std::int64_t>(subdomain.mesh().mesh.live_triangles()));
      state = subdomain.state();
      CHECK(state.started);
      CHECK(state.backlog == 0);
      CHECK(state.active == (state.remaining > 0));
      CHECK(state.active == !state.refined);
      CHECK(state.packed_bytes > 40 * static_cast<std::uint64_t>(triangles));
      CHECK(state.predicted == world.context().decomposition->subdomains[id].predicted);
    }
    on_borders += static_cast<int>(said.size());
    for (const SplitPoint<GlobalRootId>& split : said)
      CHECK(world.context().decomposition->roots[split.root].is_interface());
  }
  CHECK(begun > 0);
  CHECK(woken > 0);
  CHECK(on_borders > 0);
}

TEST_CASE("what rests is shown, and sleeps where it should") {
  RandomSubdomains world(4, 2, 300);
  for (const bool sleep : {false, true}) {
    SubdomainContext context = world.context();
    int shown = 0;
    context.sleep = sleep;
    context.finished = [&](const Subdomain& subdomain) { shown += !subdomain.dormant(); };
    Subdomain subdomain(SubdomainId{1}, context);
    Said said;
    while (subdomain.active()) subdomain.work(1000, said);
    CHECK(subdomain.rest() == (sleep ? subdomain.triangles() : 0));
    CHECK(subdomain.dormant() == sleep);
    CHECK(shown == 1);
  }
}
