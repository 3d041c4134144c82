#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapt/recast.hpp"
#include "driftmesh/error.hpp"
#include "mesh/triangulation_fault.hpp"
#include "property/cases.hpp"
#include "support/changed_decomposition.hpp"
#include "support/error_text.hpp"
#include "support/on_ranks.hpp"
#include "support/random_subdomains.hpp"
#include "support/refine_together.hpp"

// Meshes with fields that are brought over to changed decompositions, on many ranks, which are threads here.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

double wave(const Point& p, std::size_t k) {
  return std::sin(1e3 * p.x + 7 * static_cast<double>(k)) * std::cos(1e3 * p.y);
}

/// Values that depend on coordinates alone, each on those of its own place.
std::vector<double> wave_values(const adapt::Field& field, const Mesh& mesh) {
  std::vector<double> values;
  const auto add = [&](const Point& p, const Point& q) {
    for (std::size_t k = 0; k < field.components; ++k) values.push_back(wave(p, k) + 3 * wave(q, k + 1));
  };
  const auto corner = [&](const std::array<std::int32_t, 3>& t, std::size_t i) {
    return mesh.points[static_cast<std::size_t>(t[i % 3])];
  };
  if (field.place == FieldPlace::kPoints)
    for (const Point& p : mesh.points) add(p, p);
  else
    for (const auto& t : mesh.triangles)
      for (std::size_t i = 0; i < (field.place == FieldPlace::kCorners ? 3U : 1U); ++i)
        add(corner(t, i), corner(t, i + 1));
  return values;
}

/// A mesh of a decomposition in which two subdomains are one, and that decomposition with other roots.
struct RecastCase {
  RandomSubdomains world;
  Pslg pslg;
  Merged coarse;
  IdVector<SubdomainId, SubdomainMesh> parts;
  Broken change;

  RecastCase(std::uint64_t seed, int subdomains, std::uint64_t every)
      : world(seed, subdomains, 400),
        pslg(oracles::make_random_pslg(seed, oracles::make_random_shape(seed)).input),
        change{fine(), {}} {
    const std::vector<Interface> pairs = interfaces(fine());
    if (pairs.empty()) return;
    const Interface& pair = pairs[world.random()() % pairs.size()];
    coarse = merged(fine(), pair.first, pair.second);
    parts = refine_together(coarse.decomposition, world.context().bounds).parts;
    SplitPoints points;
    for (const SubdomainMesh& part : parts) points.merge(split_points(part));
    if (every > 0) change = broken(fine(), points, every, world.random());
  }
  [[nodiscard]] const Decomposition& fine() const { return *world.context().decomposition; }

  /// What a rank has; every third point and triangle has not stayed.
  [[nodiscard]] adapt::Holding holding(const IdVector<SubdomainId, Rank>& holders, Ranks& ranks) const {
    adapt::Parts own(parts.size());
    for (const SubdomainId s : ids_of(parts)) {
      if (holders[s] != ranks.rank()) continue;
      adapt::Lengths lengths;
      for (const Point& p : parts[s].mesh.points) lengths.push_back(2 + wave(p, 0));
      own[s] = {std::make_shared<const SubdomainMesh>(parts[s]), 100, 1.5,
                std::make_shared<const adapt::Lengths>(std::move(lengths))};
    }
    adapt::Holding all{adapt::assemble(coarse.decomposition, pslg, std::move(own), ranks), {}, {}};
    all.fields["points"] = {FieldPlace::kPoints, Transfer::kInterpolate, 2, {}};
    all.fields["triangles"] = {FieldPlace::kTriangles, Transfer::kConserve, 1, {}};
    all.fields["corners"] = {FieldPlace::kCorners, Transfer::kConserve, 2, {}};
    const Mesh& mesh = all.generation.piece.mesh;
    for (auto& named : all.fields) named.second.values = wave_values(named.second, mesh);
    const auto own_numbers = [](std::size_t count) {
      std::vector<std::int32_t> numbers;
      for (std::size_t i = 0; i < count; ++i) numbers.push_back(i % 3 == 0 ? -1 : static_cast<std::int32_t>(i));
      return numbers;
    };
    all.stayed.points = own_numbers(mesh.points.size());
    all.stayed.triangles = own_numbers(mesh.triangles.size());
    return all;
  }
};

/// How many points and triangles did not stay where they should have, of those that did. `stayed`: how many did.
std::size_t wrong_stays(const adapt::Holding& before, const adapt::Holding& after, std::size_t& stayed) {
  const Mesh &old = before.generation.piece.mesh, &now = after.generation.piece.mesh;
  std::size_t wrong = 0;
  const auto old_point = [&](std::int32_t v) { return old.points[static_cast<std::size_t>(v)]; };
  for (std::size_t v = 0; v < now.points.size(); ++v)
    if (const std::int32_t from = after.stayed.points[v]; from >= 0) {
      ++stayed;
      wrong += !(old_point(from) == now.points[v]);
    }
  for (std::size_t t = 0; t < now.triangles.size(); ++t)
    if (const std::int32_t from = after.stayed.triangles[t]; from >= 0) {
      ++stayed;
      for (std::size_t i = 0; i < 3; ++i)
        wrong += !(old_point(old.triangles[static_cast<std::size_t>(from)][i]) ==
                   now.points[static_cast<std::size_t>(now.triangles[t][i])]);
    }
  return wrong;
}

std::size_t stays(const adapt::Holding& holding) {
  const auto count = [](const auto& numbers) {
    return static_cast<std::size_t>(std::ranges::count_if(numbers, [](std::int32_t n) { return n >= 0; }));
  };
  return count(holding.stayed.points) + count(holding.stayed.triangles);
}

/// What is wrong with what one rank has; empty: nothing.
std::string recast_fault(const RecastCase& given, const adapt::Holding& before, const adapt::Holding& after,
                         std::size_t& kept) {
  const adapt::Generation &old = before.generation, &now = after.generation;
  if (now.piece.total_points != old.piece.total_points || now.piece.total_triangles != old.piece.total_triangles)
    return "other numbers of points or triangles";
  for (const auto& [name, field] : after.fields) {
    const adapt::Field& last = before.fields.at(name);
    if (field.place != last.place || field.how != last.how || field.components != last.components) return name;
    if (field.values != wave_values(field, now.piece.mesh)) return "values of " + name;
  }
  std::size_t stayed = 0;
  if (wrong_stays(before, after, stayed) > 0) return "something that stayed is not where it was";
  if (stayed != stays(before)) return "less stayed, or more";
  IdVector<SubdomainId, double> asked(old.parts.size(), 0);
  for (const SubdomainId s : now.here) {
    const SubdomainId p = given.coarse.parent[s];
    const adapt::Part& part = now.parts[s];
    const bool renamed =
        std::ranges::any_of(old.parts[p].mesh->roots, [&](GlobalRootId r) { return given.change.renamed.contains(r); });
    const bool stays_whole = std::ranges::count(given.coarse.parent, p) == 1 && !renamed;
    if ((part.mesh == old.parts[p].mesh) != stays_whole) return "a mesh is the same, or is not";
    kept += stays_whole;
    if (std::string fault = triangulation_fault(part.mesh->mesh); !fault.empty()) return fault;
    asked[p] += part.asked;
    if (part.density != 1.5) return "density";
    if (part.made_for->size() != part.mesh->mesh.points.size()) return "number of lengths";
    for (const VertexId v : ids_of(*part.made_for))
      if ((*part.made_for)[v] != 2 + wave(part.mesh->mesh.points[v], 0)) return "a length";
  }
  for (const SubdomainId p : old.here)
    if (std::fabs(asked[p] - 100) > 1e-9) return "triangles asked for";
  return "";
}

}  // namespace

TEST_CASE("a changed decomposition takes over meshes and fields bit for bit, on any number of ranks") {
  auto seeds = seeded_generator("changed decompositions");
  std::size_t kept = 0, chains = 0, divided = 0;
  for (std::int64_t i = 0; more_cases(i, 12, divided > 0 && chains > 0 && kept > 0); ++i) {
    const std::uint64_t seed = seeds() % 100'000;
    CAPTURE(seed);
    RecastCase given(seed, static_cast<int>(3 + seed % 8), seed % 4 == 0 ? 0 : 5 * (seed % 4));
    if (given.parts.empty()) continue;
    ++divided;
    chains += given.change.renamed.size();
    for (const std::int32_t count : {1, 2, 5}) {
      CAPTURE(count);
      auto& random = given.world.random();
      const auto deal = [&](std::size_t subdomains) {
        IdVector<SubdomainId, Rank> holders;
        for (std::size_t s = 0; s < subdomains; ++s)
          holders.push_back(static_cast<Rank>(random() % static_cast<std::uint64_t>(count)));
        return holders;
      };
      const auto first = deal(given.parts.size()), second = deal(given.fine().size());
      IdVector<Rank, std::string> faults(static_cast<std::size_t>(count)), moved_faults = faults;
      IdVector<Rank, std::size_t> kept_there(faults.size(), 0);
      on_ranks(count, [&](Ranks& ranks) {
        const Rank r = ranks.rank();
        const Decomposition& now = given.change.decomposition;
        const auto assemble = [&](adapt::Parts parts) {
          return adapt::assemble(now, given.pslg, std::move(parts), ranks);
        };
        const adapt::Holding before = given.holding(first, ranks);
        const adapt::Holding after =
            adapt::recast(before, given.change.renamed, now, given.coarse.parent, assemble, ranks);
        faults[r] = recast_fault(given, before, after, kept_there[r]);
        const adapt::Holding moved = adapt::moved(after, second, assemble, ranks);
        for (const auto& [name, field] : moved.fields)
          if (field.values != wave_values(field, moved.generation.piece.mesh)) moved_faults[r] = name;
      });
      for (const Rank r : ids_of(faults)) {
        CAPTURE(to_int(r));
        CHECK(faults[r] == "");
        CHECK(moved_faults[r] == "");
        kept += kept_there[r];
      }
    }
  }
  MESSAGE(divided << " divided, " << chains << " chains, " << kept << " parts kept");
  CHECK(divided > 0);
  CHECK(chains > 0);
  CHECK(kept > 0);
}

TEST_CASE("ranks that cannot take over a mesh fail together") {
  RecastCase given(3, 4, 0);
  REQUIRE_FALSE(given.parts.empty());
  Decomposition now = given.fine();
  for (Point& p : now.points) p.x += 1;
  IdVector<SubdomainId, Rank> holders(given.parts.size(), Rank{0});
  IdVector<Rank, std::string> texts(2);
  on_ranks(2, [&](Ranks& ranks) {
    const adapt::Holding before = given.holding(holders, ranks);
    texts[ranks.rank()] = error_text([&] {
      (void)adapt::recast(
          before, {}, now, given.coarse.parent,
          [&](adapt::Parts parts) { return adapt::assemble(now, given.pslg, std::move(parts), ranks); }, ranks);
    });
  });
  for (const std::string& text : texts) CHECK(mentions(text, {"rank 0", "has other ends"}));
}
