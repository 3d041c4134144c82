#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "adapt/session.hpp"
#include "support/adaptive_start.hpp"
#include "support/on_ranks.hpp"
#include "support/random_domain.hpp"
#include "support/recorded.hpp"
#include "support/value_digest.hpp"
#include "support/varied_domain.hpp"
#include "support/waves.hpp"
#include "temporary_folder.hpp"

// Adaptive meshes on ranks, which are threads here, to the last bit: what each rank has, what is known of the load, and
// of parts what the next generation depends on. Halfway the mesh is saved, and goes on on another number of ranks. That
// all this is right is for adaptive_ranks_property_test.

using namespace driftmesh;
using namespace driftmesh::testing;

namespace {

struct SessionCase {
  std::uint64_t seed;
  AdaptiveOptions options;
  std::string file;
  int generation = 0;

  /// Long lengths, but for a spot that moves.
  [[nodiscard]] double length_at(const Point& p) const {
    const double x = -0.8 + 0.35 * generation, y = 0.1 * static_cast<double>(seed % 7) - 0.3;
    const double fine = seed % 3 == 0 ? 0.008 : 0.03;
    return std::min(fine + 0.3 * std::hypot(p.x - x, p.y - y), seed % 2 == 0 ? 0.4 : 0.25);
  }
};

class MovingSpot final : public SizeField {
 public:
  explicit MovingSpot(const SessionCase& session) : session_(session) {}
  [[nodiscard]] double edge_length(const Point& p) const override { return session_.length_at(p); }

 private:
  const SessionCase& session_;
};

void add(ValueDigest& digest, std::span<const double> values) {
  digest.add(std::uint64_t{values.size()});
  for (const double value : values) digest.add(value);
}

void add_piece(ValueDigest& digest, const DistributedPiece& piece) {
  for (const Point& p : piece.mesh.points)
    for (const double x : {p.x, p.y}) digest.add(x);
  for (const auto& triangle : piece.mesh.triangles) digest.add(triangle);
  for (const std::int64_t number : piece.mesh.numbers) digest.add(number);
  digest.add(piece.mesh.subdomains);
}

void add(ValueDigest& digest, const adapt::Session& session) {
  add_piece(digest, session.piece());
  for (const auto& [name, field] : session.fields()) add(digest, field.values);
  digest.add(session.stayed_points());
  digest.add(session.stayed_triangles());
  for (const auto& parents : session.parents()) digest.add(parents);
  for (const Rank holder : session.present().holders) digest.add(std::int64_t{to_int(holder)});
  for (const SubdomainId s : session.present().here) {
    const adapt::Part& part = session.present().parts[s];
    digest.add(part.asked);
    digest.add(part.density);
    if (part.made_for) add(digest, {part.made_for->begin(), part.made_for->end()});
  }
  const AdaptReport& report = session.report();
  for (const std::int32_t count :
       {report.kept, report.mended, report.remade, report.divided, report.joined, report.moved})
    digest.add(std::int64_t{count});
  digest.add(report.generation);
  digest.add(report.scale);
  digest.add(report.imbalance);
}

/// Notes the loads, and sends some parts elsewhere, or none at all.
adapt::Placing note_and_move(std::uint64_t seed, ValueDigest& digest, Ranks& ranks) {
  return
      [seed, &digest, &ranks, dice = std::mt19937_64(seed)](
          const adapt::Loads& loads, const adapt::Generation& generation, const Decomposition& decomposition) mutable {
        digest.add(std::uint64_t{decomposition.size()});
        for (const auto* values : {&loads.work, &loads.bytes}) add(digest, {values->begin(), values->end()});
        add(digest, {loads.speeds.begin(), loads.speeds.end()});
        digest.add(imbalance(loads, generation.holders));
        std::vector<Rank> own;
        if (seed % 4 == 3) return own;
        for (const SubdomainId s : ids_of(generation.holders)) {  // the same on all ranks
          const bool moves = dice() % 4 == 0;
          const auto to = static_cast<Rank>(dice() % static_cast<std::uint64_t>(ranks.ranks()));
          if (generation.is_here(s)) own.push_back(moves ? to : generation.holders[s]);
        }
        return own;
      };
}

/// What the caller tells of its own work: nothing, seconds of ranks or of parts, and not on all ranks.
void tell_time(adapt::Session& session, std::uint64_t seed, Ranks& ranks, int generation) {
  const auto rank = static_cast<double>(to_int(ranks.rank()));
  const bool one_is_silent = generation % 2 == 0 && ranks.rank() == Rank{1};
  if (seed % 3 == 0 && !one_is_silent) session.spent(0.5 + rank);
  if (seed % 3 == 1 && !one_is_silent) {
    std::vector<double> seconds;
    for (const SubdomainId s : session.present().here) seconds.push_back(1 + std::sin(1.0 + to_int(s)));
    session.spent(seconds);
  }
}

void go_on(adapt::Session& session, const SessionCase& how, const adapt::Means& means, ValueDigest& digest) {
  tell_time(session, how.seed, means.ranks, how.generation);
  const Mesh& mesh = session.piece().mesh;
  std::vector<double> lengths;
  for (const Point& p : mesh.points) lengths.push_back(how.length_at(p));
  if (how.generation == 3 && how.seed % 2 == 0) return session.adapt(MovingSpot(how), means, {});
  if (how.generation == 2 && how.seed % 2 == 1) {
    std::vector<double> errors;
    for (const auto& t : mesh.triangles)
      errors.push_back(
          mesh.points[static_cast<std::size_t>(t[0])].x > 0.5 ? 0 : 1 / lengths[static_cast<std::size_t>(t[0])]);
    lengths = session.lengths_from_error(errors, 100, 1 + static_cast<double>(how.seed % 3), means);
    add(digest, lengths);
  }
  if (how.seed % 5 == 0)  // which of the ranks asks for the shortest length at a common point matters
    for (double& length : lengths) length *= 1 + 0.1 * to_int(means.ranks.rank());
  session.adapt(lengths, means, {});
}

std::uint64_t digest_on_ranks(std::uint64_t seed, AdaptReport& sums) {
  const TemporaryFolder folder;
  SessionCase how{seed, {}, (folder.path() / "session.h5").string()};
  how.options.gradation = seed % 4 == 0 ? 0.0 : 0.3;
  if (seed % 6 == 0) how.options.most_triangles = 700;
  if (seed % 5 == 1) how.options.shortest = 0.05;
  if (seed % 7 == 0) how.options.longest = 0.2;
  MeshOptions options{.min_angle = seed % 3 == 0 ? 0.0 : 20.0, .triangles = 200, .threads = 1};
  options.subdomains.count = static_cast<std::int32_t>(6 + seed * 5 % 24);
  if (seed % 4 == 2) options.size = [](const Point& p) { return 0.15 + 0.05 * std::abs(p.x); };
  const job::LiveMesh live = first_generation(seed % 4 == 1 ? varied_domain() : random_domain(seed, 2), options);
  std::mt19937_64 dice(seed);
  ValueDigest all;
  const auto count_first = static_cast<std::int32_t>(2 + seed % 3),
             count_second = static_cast<std::int32_t>(1 + seed % 4);
  IdVector<SubdomainId, Rank> holders;
  for (std::size_t s = 0; s < live.plan.decomposition.size(); ++s)
    holders.push_back(static_cast<Rank>(dice() % static_cast<std::uint64_t>(count_first)));
  const auto visit_ranks = [&](std::int32_t count, const auto& work) {
    IdVector<Rank, ValueDigest> of_ranks(static_cast<std::size_t>(count));
    on_ranks(count, [&](Ranks& ranks) {
      ValueDigest& digest = of_ranks[ranks.rank()];
      const adapt::Means means{ranks, 1 + to_int(ranks.rank()) % 2, note_and_move(seed, digest, ranks)};
      work(means, digest);
    });
    for (const ValueDigest& digest : of_ranks) all.add(digest.value());
  };
  const auto generations = [&](adapt::Session& session, int from, int to, const adapt::Means& means,
                               ValueDigest& digest) {
    for (int g = from; g <= to; ++g) {
      session.keep_old(g % 2 == 1);
      SessionCase now = how;
      now.generation = g;
      go_on(session, now, means, digest);
      add(digest, session);
      if (g % 2 == 1) add_piece(digest, session.old_piece());
      if (means.ranks.rank() != Rank{0}) continue;
      sums.mended += session.report().mended;
      sums.kept += session.report().kept;
      sums.divided += session.report().divided;
      sums.joined += session.report().joined;
      sums.moved += session.report().moved;
    }
  };
  visit_ranks(count_first, [&](const adapt::Means& means, ValueDigest& digest) {
    adapt::Session session(
        start_on(means.ranks.rank(), live, holders), how.options, [](Mesh&) {}, means);
    const std::size_t points = session.piece().mesh.points.size(), triangles = session.piece().mesh.triangles.size();
    session.attach("points", waves(2 * points, 0.3), FieldPlace::kPoints, Transfer::kInterpolate, means);
    session.attach("conserved points", waves(points, 0.7), FieldPlace::kPoints, Transfer::kConserve, means);
    session.attach("triangles", waves(2 * triangles, 1.1), FieldPlace::kTriangles, Transfer::kConserve, means);
    session.attach("corners", waves(3 * triangles, 1.3), FieldPlace::kCorners, Transfer::kConserve, means);
    add(digest, session);
    generations(session, 1, 3, means, digest);
    session.save(how.file, {}, means);
  });
  visit_ranks(count_second, [&](const adapt::Means& means, ValueDigest& digest) {
    adapt::Session session(
        adapt::read_saved(how.file, means.ranks), [](Mesh&) {}, means);
    add(digest, session);
    generations(session, 4, 5, means, digest);
  });
  return all.value();
}

constexpr std::array<std::uint64_t, 16> kRecordedSessions{
    0x67e32a30e01bc20b, 0x5ed05b907e78f4bd, 0x88b3df819714383a, 0x7a155e134db75c4e,
    0x497662a484a7d629, 0x65a235d3d4604d53, 0xa41de8cd317aa56d, 0xd30e5caede9a62b2,
    0xf3fac3da1983affc, 0x77687da88acb612a, 0x85a78fdc398e3360, 0x3eb18ee6b7984959,
    0x14735826472b7fb5, 0xf11978fd8600ffde, 0x65796458a61f3bd5, 0x89b887a85cfa48c0};

}  // namespace

TEST_CASE("sessions on ranks are those that were recorded") {
  AdaptReport sums;
#ifdef __SANITIZE_ADDRESS__
  const std::span<const std::uint64_t> recorded = std::span(kRecordedSessions).first(5);
#else
  const std::span<const std::uint64_t> recorded = kRecordedSessions;
#endif
  check_recorded(recorded, [&](std::uint64_t seed) { return digest_on_ranks(seed, sums); });
  CHECK(sums.kept > 0);
  CHECK(sums.mended > 0);
  CHECK(sums.divided > 0);
  CHECK(sums.joined > 0);
  CHECK(sums.moved > 0);
}
