#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "mesh/digest.hpp"
#include "migration/subdomain.hpp"
#include "migration/work.hpp"
#include "support/error_text.hpp"
#include "support/random_subdomains.hpp"

// Subdomains that begin with a mesh, are told of points, and come back: what they do with it.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

using Splits = std::vector<SplitPoint<GlobalRootId>>;

/// The mesh of a subdomain that has met its bounds.
std::shared_ptr<const SubdomainMesh> finished_mesh(const SubdomainContext& context, SubdomainId id) {
  Subdomain subdomain(id, context);
  Splits said;
  while (subdomain.active()) subdomain.work(10'000, said);
  return std::make_shared<const SubdomainMesh>(subdomain.take_mesh());
}

TriangleId some_triangle(const Triangulation& mesh) {
  const auto all = ids_of(mesh.triangles);
  return *std::ranges::find_if(all, [&](TriangleId t) { return mesh.triangles[t].alive(); });
}

class HeldHere final : public HoldingOf<Subdomain> {
 public:
  Work& unpack(std::span<const std::byte> /*packed*/) override { throw Error("nothing comes"); }
};

}  // namespace

TEST_CASE("a mesh that a subdomain begins with has its segments done") {
  RandomSubdomains world(5, 3, 400);
  const SubdomainId id{1};
  IdVector<SubdomainId, Beginning> beginnings(world.size());
  beginnings[id].mesh = finished_mesh(world.context(), id);
  beginnings[id].told = {world.split_of(id, 8)};
  SubdomainContext context = world.context();
  context.beginnings = &beginnings;
  Subdomain subdomain(id, context);
  Splits said;
  subdomain.work(0, said);  // has begun, and done no more than take in what it was told
  const SubdomainState state = unpack(subdomain.pack());
  CHECK(to_int(state.body.value().refiner.next_segment) >= to_int(beginnings[id].mesh->mesh.subsegments.next_id()));
}

TEST_CASE("a subdomain that begins with points to take in waits for them once, wherever it goes") {
  RandomSubdomains world(6, 3, 400);
  const SubdomainId id{2};
  IdVector<SubdomainId, Beginning> beginnings(world.size());
  beginnings[id].mesh = finished_mesh(world.context(), id);
  beginnings[id].open = {some_triangle(beginnings[id].mesh->mesh)};
  beginnings[id].told = {world.split_of(id, 9), world.split_of(id, 10)};
  SubdomainContext context = world.context();
  context.beginnings = &beginnings;
  const Subdomain here(id, context);
  REQUIRE(here.backlog() == 2);
  const Subdomain there = Subdomain::unpack(here.pack(), context);
  CHECK(there.backlog() == 2);
  CHECK(there.pack() == here.pack());
}

TEST_CASE("lengths of a later generation go with a subdomain that moves while it is refined") {
  RandomSubdomains world(7, 2, 300);
  const SubdomainId id{0};
  const Decomposition& d = *world.context().decomposition;
  SubdomainContext context = world.context();
  context.bounds.size = nullptr;
  context.bounds.region_max_area.clear();
  const RadialField fine(d.points.front(), 0.2 * std::sqrt(context.bounds.plain.area), 0.05);
  IdVector<SubdomainId, Beginning> beginnings(world.size());
  beginnings[id].size = &fine;
  context.beginnings = &beginnings;
  const auto made = [&](bool moves) {
    Subdomain subdomain(id, context);
    Splits said;
    while (subdomain.active()) {
      subdomain.work(25, said);
      if (moves) subdomain = Subdomain::unpack(subdomain.pack(), context);
    }
    return subdomain.take_mesh();
  };
  const SubdomainMesh stayed = made(false);
  CHECK(stayed.mesh.live_triangles() > 2 * finished_mesh(world.context(), id)->mesh.live_triangles());
  CHECK(mesh_digest(made(true).mesh) == mesh_digest(stayed.mesh));
}

TEST_CASE("a subdomain is told of points on its own border alone") {
  RandomSubdomains world(8, 4, 300);
  const Decomposition& d = *world.context().decomposition;
  int refused = 0;
  for (const SubdomainId id : first_ids<SubdomainId>(world.size()))
    for (const GlobalRootId root : ids_of(d.roots)) {
      const auto own = d.roots_of(id);
      if (std::ranges::find(own, root) != own.end()) continue;
      Subdomain subdomain(id, world.context());
      subdomain.tell(Splits{{root, 1}});
      Splits said;
      const std::string words = error_text([&] { subdomain.work(1, said); });
      CHECK(mentions(words, "is told of a point on root " + to_string(root) + ", which is not on its border"));
      ++refused;
    }
  CHECK(refused > 10);
}

TEST_CASE("work that comes back takes the place of what was here") {
  RandomSubdomains world(9, 2, 300);
  HeldHere held;
  held.put(Subdomain(SubdomainId{1}, world.context()));
  Subdomain advanced(SubdomainId{1}, world.context());
  Splits said;
  advanced.work(30, said);
  const Bytes expected = advanced.pack();
  held.put(std::move(advanced));
  CHECK(held.find(SubdomainId{1})->pack() == expected);
  CHECK(held.all().size() == 1);
}
