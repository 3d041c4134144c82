#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adapt/session.hpp"
#include "driftmesh/error.hpp"
#include "driftmesh/id_vector.hpp"
#include "io/hdf5_bytes.hpp"
#include "oracles/random_pslg.hpp"
#include "support/adaptive_start.hpp"
#include "support/error_text.hpp"
#include "support/on_ranks.hpp"
#include "support/piece_of_whole.hpp"
#include "support/random.hpp"
#include "support/varied_domain.hpp"
#include "temporary_folder.hpp"

// Adaptive meshes on many ranks, which are threads here, against the same on one. A failure prints its seed.

using namespace driftmesh;
using testing::error_text;
using testing::first_generation;
using testing::mentions;
using testing::on_ranks;
using testing::Random;
using testing::start_on;
using testing::uniform;

namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int kSeeds = 2;
#else
constexpr int kSeeds = 3;
#endif

struct FieldCase {
  std::string name;
  FieldPlace place;
  Transfer how;
  std::size_t components;
};

const std::vector<FieldCase> kFields{{"interpolated", FieldPlace::kPoints, Transfer::kInterpolate, 1},
                                     {"points", FieldPlace::kPoints, Transfer::kConserve, 2},
                                     {"triangles", FieldPlace::kTriangles, Transfer::kConserve, 1},
                                     {"corners", FieldPlace::kCorners, Transfer::kConserve, 1}};

/// Any values, by place; without order, so that each bit counts.
std::vector<double> values_of(const FieldCase& field, const Mesh& mesh) {
  std::vector<double> values;
  const auto add = [&](const Point& p) {
    for (std::size_t k = 0; k < field.components; ++k)
      values.push_back(std::sin(1e3 * p.x + 7 * static_cast<double>(k)) * std::cos(1e3 * p.y));
  };
  if (field.place == FieldPlace::kPoints)
    for (const Point& p : mesh.points) add(p);
  else
    for (const auto& triangle : mesh.triangles)
      for (std::size_t i = 0; i < (field.place == FieldPlace::kCorners ? 3U : 1U); ++i)
        add(mesh.points[static_cast<std::size_t>(triangle[i])]);
  return values;
}

/// What a rank has of a generation.
struct Seen {
  DistributedPiece piece;
  std::map<std::string, std::vector<double>> fields;
  std::vector<std::int32_t> stayed_points, stayed_triangles;
  AdaptReport report;
};

Seen seen_by(adapt::Session& session) {
  Seen seen{session.piece(), {}, session.stayed_points(), session.stayed_triangles(), session.report()};
  for (const FieldCase& field : kFields) {
    const std::span<const double> values = session.field(field.name);
    seen.fields[field.name].assign(values.begin(), values.end());
  }
  return seen;
}

/// A ring that moves, in a box of this size.
struct Ring {
  Point center;
  double size, radius, speed;
  double fine = 0.03;
  [[nodiscard]] double length(const Point& p, int g) const {
    const double away = std::fabs(std::hypot(p.x - center.x, p.y - center.y) - radius - speed * g);
    return size * (away < fine * size ? fine : std::min(0.15, fine + 0.5 * (away / size - fine)));
  }
};

class RingField final : public SizeField {
 public:
  RingField(const Ring& ring, int g) : ring_(ring), g_(g) {}
  [[nodiscard]] double edge_length(const Point& p) const override { return ring_.length(p, g_); }

 private:
  const Ring& ring_;
  int g_;
};

/// Makes generation `g`: by lengths at points, from errors, or by a function.
void make_generation(int g, adapt::Session& session, const Ring& ring, const adapt::Means& means) {
  if (g % 3 == 0) return session.adapt(RingField(ring, g), means, {});
  const Mesh& mesh = session.piece().mesh;
  std::vector<double> lengths;
  for (const Point& p : mesh.points) lengths.push_back(ring.length(p, g));
  if (g == 4) {
    std::vector<double> errors;
    for (const auto& t : mesh.triangles) errors.push_back(1 / ring.length(mesh.points[t[0]], g));
    lengths = session.lengths_from_error(errors, 300 / ring.size, 2, means);
  }
  session.adapt(lengths, means, {});
}

constexpr int kGenerations = 5;

/// All generations of a session, as this rank sees them. `moves`: parts move at random after each.
std::vector<Seen> generations(adapt::Start start, const AdaptiveOptions& options, const Ring& ring, Ranks& ranks,
                              std::int32_t threads, bool moves) {
  std::mt19937_64 dice(7);  // the same on all ranks
  const auto move_some = [&](const adapt::Loads& /*loads*/, const adapt::Generation& generation,
                             const Decomposition& /*decomposition*/) {
    IdVector<SubdomainId, Rank> holders = generation.holders;
    for (Rank& holder : holders)
      if (dice() % 3 == 0) holder = static_cast<Rank>(dice() % static_cast<std::uint64_t>(ranks.ranks()));
    std::vector<Rank> own;
    for (const SubdomainId s : generation.here) own.push_back(holders[s]);
    return own;
  };
  const adapt::Means means{ranks, threads, moves ? adapt::Placing(move_some) : nullptr};
  adapt::Session session(
      std::move(start), options, [](Mesh&) {}, means);
  for (const FieldCase& field : kFields)
    session.attach(field.name, values_of(field, session.piece().mesh), field.place, field.how, means);
  std::vector<Seen> all{seen_by(session)};
  for (int g = 1; g <= kGenerations; ++g) {
    make_generation(g, session, ring, means);
    all.push_back(seen_by(session));
  }
  return all;
}

/// A domain with a ring in it, and its first generation.
struct Case {
  Random random;
  job::LiveMesh live;
  Ring ring{};
  AdaptiveOptions options;

  /// `narrow`: a small ring that asks for most of all triangles.
  explicit Case(int seed, bool narrow = false) : random(seed) {
    const Pslg input =
        seed == 1 ? testing::varied_domain() : oracles::make_random_pslg(seed, oracles::make_random_shape(seed)).input;
    live = first_generation(input,
                            {.min_angle = 20, .triangles = 300, .threads = 1, .subdomains = {.count = 5 + 4 * seed}});
    const Box box = job::box_of(live.pslg);
    const double size = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
    ring = {testing::somewhere_in(random, box), size, uniform(random, 0, 0.5) * size,
            uniform(random, -0.05, 0.05) * size};
    options = {.gradation = 0.3, .most_triangles = seed % 2 == 0 && !narrow ? 800.0 : 0};
    if (narrow) ring = {live.pslg.points.front(), size, 0.05 * size, 0.01 * size, 0.002};
  }

  /// On which of so many ranks each subdomain is.
  IdVector<SubdomainId, Rank> deal(std::int32_t count) {
    IdVector<SubdomainId, Rank> holders;
    for (std::size_t s = 0; s < live.parts.size(); ++s)
      holders.push_back(static_cast<Rank>(random() % static_cast<std::uint64_t>(count)));
    return holders;
  }

  /// All generations by one rank.
  std::vector<Seen> alone() {
    OneRank one;
    return generations(start_on(Rank{0}, live, deal(1)), options, ring, one, 1, false);
  }
};

void check_as_whole(const Seen& seen, const Seen& last, const Seen& whole, const Seen& whole_last) {
  const testing::PieceOfWhole place(seen.piece, whole.piece.mesh), before(last.piece, whole_last.piece.mesh);
  CHECK(place.differences() == 0);
  CHECK(seen.piece.total_triangles == whole.piece.total_triangles);
  for (const FieldCase& field : kFields) {
    CAPTURE(field.name);
    CHECK((place.part_of(whole.fields.at(field.name), field.place) == seen.fields.at(field.name)));
  }
  CHECK(seen.report.generation == whole.report.generation);
  CHECK(seen.report.kept == whole.report.kept);
  CHECK(seen.report.mended == whole.report.mended);
  CHECK(seen.report.remade == whole.report.remade);
  CHECK(seen.report.divided == whole.report.divided);
  CHECK(seen.report.joined == whole.report.joined);
  CHECK(seen.report.scale == whole.report.scale);
  const bool some_came = seen.report.moved > 0;
  std::size_t wrong = 0;
  const auto number = [](std::int32_t old, const auto& of) {
    return old < 0 ? std::int64_t{-1} : of(static_cast<std::size_t>(old));
  };
  for (std::size_t i = 0; i < seen.stayed_points.size(); ++i)
    wrong += !(some_came && seen.stayed_points[i] < 0) &&
             number(seen.stayed_points[i], [&](std::size_t old) { return before.point(old); }) !=
                 whole.stayed_points.at(static_cast<std::size_t>(place.point(i)));
  for (std::size_t t = 0; t < seen.stayed_triangles.size(); ++t)
    wrong += !(some_came && seen.stayed_triangles[t] < 0) &&
             number(seen.stayed_triangles[t], [&](std::size_t old) { return before.triangle(old); }) !=
                 whole.stayed_triangles.at(static_cast<std::size_t>(place.triangle(t)));
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("generations and fields do not depend on the number of ranks") {
  std::int64_t mended = 0, remade = 0, moved = 0, divided = 0, joined = 0;
  for (int seed = 1; seed <= kSeeds + 1; ++seed) {
    CAPTURE(seed);
    Case given(seed, seed > kSeeds);
    const std::vector<Seen> alone = given.alone();
    for (const Seen& seen : alone) {
      mended += seen.report.mended;
      remade += seen.report.remade;
      divided += seen.report.divided;
      joined += seen.report.joined;
    }
    for (const std::int32_t count : {1, 2, 3, 8}) {
      CAPTURE(count);
      const bool moves = (count + seed) % 2 == 0;
      const IdVector<SubdomainId, Rank> holders = given.deal(count);
      IdVector<Rank, std::vector<Seen>> on_each(static_cast<std::size_t>(count));
      on_ranks(count, [&](Ranks& ranks) {
        on_each[ranks.rank()] = generations(start_on(ranks.rank(), given.live, holders), given.options, given.ring,
                                            ranks, 1 + to_int(ranks.rank()) % 2, moves);
      });
      for (const Rank r : ids_of(on_each))
        for (std::size_t g = 0; g < alone.size(); ++g) {
          CAPTURE(to_int(r));
          CAPTURE(g);
          const std::size_t last = g == 0 ? 0 : g - 1;
          check_as_whole(on_each[r][g], on_each[r][last], alone[g], alone[last]);
          moved += on_each[r][g].report.moved;
        }
    }
  }
  CHECK(mended > 0);
  CHECK(remade > 0);
  CHECK(moved > 0);
  CHECK(divided > 0);
  CHECK(joined > 0);
}

TEST_CASE("a session that was saved goes on on any number of ranks as it would have") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "flow.h5").string();
  const auto finish = [](Mesh&) {};
  for (int seed = 1; seed <= 2; ++seed) {
    CAPTURE(seed);
    Case given(seed, seed == 2);
    const std::vector<Seen> alone = given.alone();
    constexpr int kSaved = 2;
    for (const auto& [writers, readers] : {std::pair(1, 3), std::pair(3, 2), std::pair(4, 1)}) {
      CAPTURE(writers);
      CAPTURE(readers);
      const IdVector<SubdomainId, Rank> holders = given.deal(writers);
      on_ranks(writers, [&](Ranks& ranks) {
        const adapt::Means means{ranks, 1, {}};
        adapt::Session session(start_on(ranks.rank(), given.live, holders), given.options, finish, means);
        for (const FieldCase& field : kFields)
          session.attach(field.name, values_of(field, session.piece().mesh), field.place, field.how, means);
        for (int g = 1; g <= kSaved; ++g) make_generation(g, session, given.ring, means);
        session.save(path, {}, means);
      });
      IdVector<Rank, std::vector<Seen>> on_each(static_cast<std::size_t>(readers));
      on_ranks(readers, [&](Ranks& ranks) {
        const adapt::Means means{ranks, 1, {}};
        adapt::Session session(adapt::read_saved(path, ranks), finish, means);
        std::vector<Seen>& seen = on_each[ranks.rank()];
        seen.push_back(seen_by(session));
        for (int g = kSaved + 1; g <= kGenerations; ++g) {
          make_generation(g, session, given.ring, means);
          seen.push_back(seen_by(session));
        }
      });
      for (const Rank r : ids_of(on_each))
        for (std::size_t i = 0; i < on_each[r].size(); ++i) {
          CAPTURE(to_int(r));
          CAPTURE(i);
          const Seen &now = on_each[r][i], &whole = alone[kSaved + i];
          if (i > 0) {
            check_as_whole(now, on_each[r][i - 1], whole, alone[kSaved + i - 1]);
            continue;
          }
          CHECK(testing::PieceOfWhole(now.piece, whole.piece.mesh).differences() == 0);  // nothing is known to stay
          CHECK(now.report.generation == kSaved);
        }
    }
  }
}

TEST_CASE("where ranks say different things of a point that they share, what its owner says counts") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "shared.h5").string();
  Case given(1);
  constexpr std::int32_t kRanks = 3;
  const IdVector<SubdomainId, Rank> holders = given.deal(kRanks);
  using AtPlaces = std::map<std::pair<double, double>, double>;
  IdVector<Rank, AtPlaces> said(kRanks), kept(kRanks);
  IdVector<Rank, std::size_t> shared(kRanks, 0);
  const auto at = [](const Point& p) { return std::pair(p.x, p.y); };
  on_ranks(kRanks, [&](Ranks& ranks) {
    const adapt::Means means{ranks, 1, {}};
    adapt::Session session(
        start_on(ranks.rank(), given.live, holders), given.options, [](Mesh&) {}, means);
    const DistributedPiece& piece = session.piece();
    const std::vector<double> own(piece.mesh.points.size(), 1.0 + to_int(ranks.rank()));
    session.attach("who", own, FieldPlace::kPoints, Transfer::kInterpolate, means);
    for (std::size_t i = 0; i < own.size(); ++i)
      if (piece.owners[i] == ranks.rank()) said[ranks.rank()][at(piece.mesh.points[i])] = own[i];
    for (const DistributedPiece::Neighbor& neighbor : piece.neighbors) shared[ranks.rank()] += neighbor.shared.size();
    session.save(path, {}, means);
    std::ranges::copy(own, session.field("who").begin());
    session.adapt(RingField(given.ring, 1), means, {});
    for (std::size_t i = 0; i < session.stayed_points().size(); ++i)
      if (session.stayed_points()[i] >= 0)
        kept[ranks.rank()][at(session.piece().mesh.points[i])] = session.field("who")[i];
  });
  AtPlaces all;
  for (const AtPlaces& of_rank : said) all.insert(of_rank.begin(), of_rank.end());
  std::size_t all_kept = 0;
  for (const Rank r : ids_of(kept)) {
    CHECK(shared[r] > 5);
    all_kept += kept[r].size();
    std::size_t wrong = 0;
    for (const auto& [place, value] : kept[r]) wrong += value != all.at(place);
    CHECK(wrong == 0);
  }
  CHECK(all_kept > 20);
  OneRank alone;
  adapt::Session saved(adapt::read_saved(path, alone), [](Mesh&) {}, {alone, 1, {}});
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < saved.piece().mesh.points.size(); ++i)
    wrong += saved.field("who")[i] != all.at(at(saved.piece().mesh.points[i]));
  CHECK(wrong == 0);
}

TEST_CASE("subdomains that are divided at once get numbers by which ones they were, whoever has them") {
  Pslg square;
  square.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 1}, {3, 0, 1}};
  const job::LiveMesh live = first_generation(square, {.triangles = 600, .threads = 1, .subdomains = {.count = 12}});
  // In some subdomains, by their order, lengths are short.
  std::vector<Point> fine;
  for (const SubdomainId s : ids_of(live.plan.decomposition.subdomains))
    if (to_int(s) % 4 == 1) fine.push_back(live.plan.decomposition.subdomains[s].centroid);
  const auto generation = [&](const IdVector<SubdomainId, Rank>& holders, Ranks& ranks) {
    const adapt::Means means{ranks, 1, {}};
    adapt::Session session(
        start_on(ranks.rank(), live, holders), {.gradation = 0}, [](Mesh&) {}, means);
    std::vector<double> lengths;
    for (const Point& p : session.piece().mesh.points) {
      const auto is_near = [&](const Point& q) { return std::hypot(p.x - q.x, p.y - q.y) < 0.06; };
      lengths.push_back(std::ranges::any_of(fine, is_near) ? 0.006 : 0.1);
    }
    session.adapt(lengths, means, {});
    return std::pair(session.piece(), session.report().divided);
  };
  OneRank one;
  const auto [whole, divided] = generation(IdVector<SubdomainId, Rank>(live.parts.size(), Rank{0}), one);
  CHECK(divided >= 3);
  constexpr std::int32_t kRanks = 3;
  IdVector<SubdomainId, Rank> holders;  // the last ones are on the first rank
  for (std::size_t s = 0; s < live.parts.size(); ++s)
    holders.push_back(static_cast<Rank>(kRanks - 1 - static_cast<std::int32_t>(s * kRanks / live.parts.size())));
  IdVector<Rank, std::size_t> differences(kRanks, 1);
  on_ranks(kRanks, [&, &whole = whole](Ranks& ranks) {
    const auto piece = generation(holders, ranks).first;
    differences[ranks.rank()] = testing::PieceOfWhole(piece, whole.mesh).differences();
  });
  for (const std::size_t of_rank : differences) CHECK(of_rank == 0);
}

TEST_CASE("a file that is no saved session, or a damaged one, is refused by name") {
  const std::string kNone = "no error";
  const TemporaryFolder folder;
  const auto named = [&](const char* name) { return (folder.path() / name).string(); };
  const auto load_error = [&](const std::string& path) {
    OneRank one;
    return error_text([&] { (void)adapt::read_saved(path, one); });
  };
  OneRank one;
  const adapt::Means means{one, 1, {}};
  Case given(1);
  adapt::Session session(
      start_on(Rank{0}, given.live, given.deal(1)), given.options, [](Mesh&) {}, means);
  const std::string path = named("flow.h5");
  session.save(path, {}, means);
  CHECK(load_error(path) == kNone);

  (void)create_hdf5_bytes(named("later.h5"), "later.h5", 3, {{"session", 8}});
  CHECK(mentions(load_error(named("later.h5")), {"later.h5", "of version 3, but this driftmesh reads version 2"}));
  std::ofstream(named("text.h5")) << "none";
  CHECK(mentions(load_error(named("text.h5")), {"text.h5", "is not an HDF5 file"}));
  CHECK(mentions(load_error(named("none.h5")), "none.h5"));

  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::size_t found = 0;
  for (int part = 1; part <= 20; ++part) {
    std::string damaged = bytes;
    damaged[bytes.size() * static_cast<std::size_t>(part) / 21] ^= 0x10;
    std::ofstream(named("damaged.h5"), std::ios::binary) << damaged;
    found += load_error(named("damaged.h5")) == kNone ? 0 : 1;
    std::ofstream(named("short.h5"), std::ios::binary)
        << bytes.substr(0, bytes.size() * static_cast<std::size_t>(part) / 21);
    CHECK(mentions(load_error(named("short.h5")), "short.h5"));
  }
  CHECK(found >= 19);  // HDF5's own tables have bytes that do not matter

  const std::string kept = named("kept.h5");
  std::ofstream(kept) << "what was there";
  std::filesystem::create_directory(named("folder"));
  CHECK(error_text([&] { session.save(named("folder"), {}, means); }) != kNone);
  CHECK(error_text([&] { session.save(named("nowhere/flow.h5"), {}, means); }) != kNone);
  on_ranks(2, [&](Ranks& ranks) {  // one rank fails while it writes
    const adapt::Means both{ranks, 1, {}};
    adapt::Session shared(
        start_on(ranks.rank(), given.live, IdVector<SubdomainId, Rank>(given.live.parts.size(), Rank{0})),
        given.options, [](Mesh&) {}, both);
    CHECK(error_text([&] { shared.save(ranks.rank() == Rank{0} ? kept : kept + "x", {}, both); }) != kNone);
  });
  std::ifstream again(kept);
  CHECK(std::string((std::istreambuf_iterator<char>(again)), {}) == "what was there");
}

TEST_CASE("wrong use on one rank is one clear error on all, and changes nothing") {
  const job::LiveMesh live = first_generation(testing::varied_domain(), {.triangles = 400, .threads = 1});
  IdVector<SubdomainId, Rank> holders;
  for (std::size_t s = 0; s < live.parts.size(); ++s) holders.push_back(static_cast<Rank>(s % 3));
  on_ranks(3, [&](Ranks& ranks) {
    const adapt::Means means{ranks, 1, {}};
    adapt::Session session(
        start_on(ranks.rank(), live, holders), {}, [](Mesh&) {}, means);
    adapt::Session other(
        start_on(ranks.rank(), live, holders), {}, [](Mesh&) {}, means);
    const bool odd = ranks.rank() == Rank{1};
    const std::size_t points = session.piece().mesh.points.size();
    const auto adapted_by = [&](const std::vector<double>& lengths) {
      return error_text([&] { session.adapt(lengths, means, {}); });
    };
    CHECK(mentions(adapted_by(std::vector<double>(odd ? 3 : points, 0.1)), {"rank 1", "there are 3 lengths for"}));
    for (const double wrong : {0.0, std::nan("")}) {
      std::vector<double> lengths(points, 0.1);
      if (odd) lengths[5] = wrong;
      CHECK(mentions(adapted_by(lengths), {"rank 1", "the length at point 5"}));
    }
    const auto attached = [&](const std::string& name, std::size_t count, Transfer how = Transfer::kInterpolate) {
      return error_text(
          [&] { session.attach(name, std::vector<double>(count, 1.0), FieldPlace::kPoints, how, means); });
    };
    CHECK(mentions(attached("u", odd ? points + 1 : points), {"rank 1", "'u'", "the same number for each"}));
    CHECK(mentions(attached("u", odd ? 2 * points : points), {"'u'", "rank 0", "rank 1", "values"}));
    const auto shaped = [&](std::size_t each, const std::vector<std::int64_t>& shape) {
      return error_text([&] {
        session.attach("w", std::vector<double>(each * points), FieldPlace::kPoints, Transfer::kInterpolate, means,
                       shape);
      });
    };
    CHECK(mentions(shaped(4, odd ? std::vector<std::int64_t>{4, 1} : std::vector<std::int64_t>{2, 2}),
                   {"'w'", "shape (2, 2) at each place on rank 0", "(4, 1) on rank 1"}));
    CHECK(mentions(shaped(4, {2, 3}), {"'w'", "4 values", "no shape (2, 3)"}));
    CHECK(shaped(4, {4, 1}) == "no error");
    CHECK(session.shape("w") == std::vector<std::int64_t>{4, 1});
    CHECK(shaped(4, {}) == "no error");
    CHECK(session.shape("w") == std::vector<std::int64_t>{4});
    CHECK(shaped(1, {}) == "no error");
    CHECK(session.shape("w").empty());
    session.detach("w", means);
    CHECK(mentions(error_text([&] { static_cast<void>(session.shape("w")); }), "no field 'w'"));
    REQUIRE(session.piece().ranks > 1);
    const auto& owners = session.piece().owners;
    const Rank own = session.piece().rank;
    const auto first_of = [&](bool mine) {
      return std::ranges::find_if(owners, [&](Rank owner) { return (owner == own) == mine; }) - owners.begin();
    };
    std::vector<double> values(points, 1);
    if (odd) values[static_cast<std::size_t>(first_of(true))] = std::nan("");
    session.attach("w", values, FieldPlace::kPoints, Transfer::kConserve, means);
    const std::string refused = error_text([&] { session.adapt(std::vector<double>(points, 0.1), means, {}); });
    CHECK(mentions(refused, "rank 1: field 'w' is nan at point "));
    CHECK((!odd || mentions(refused, " at point " + std::to_string(first_of(true)) + " (")));
    session.detach("w", means);
    CHECK(mentions(attached(odd ? "v" : "u", points), {"the same call", "'u'", "'v'"}));
    CHECK(mentions(attached("u", points, odd ? Transfer::kConserve : Transfer::kInterpolate), "conserving"));
    CHECK(mentions(error_text([&] { (void)session.field("u"); }), "no field 'u'"));
    CHECK(mentions(error_text([&] {
                     if (odd)
                       session.attach("u", std::vector<double>(points), FieldPlace::kPoints, Transfer::kConserve,
                                      means);
                     else
                       session.adapt(std::vector<double>(points, 0.1), means, {});
                   }),
                   {"rank 0 calls adapt", "rank 1 calls attach"}));
    CHECK(mentions(error_text([&] { (odd ? other : session).adapt(std::vector<double>(points, 0.1), means, {}); }),
                   "another adaptive mesh"));
    adapt::Hooks hooks;
    hooks.check = [&](std::int64_t) {
      if (odd) throw LimitError("enough");
    };
    CHECK(mentions(error_text([&] { session.adapt(std::vector<double>(points, 0.02), means, hooks); }), "enough"));
    CHECK(session.report().generation == 0);
    CHECK(session.piece().mesh.points.size() == points);
    values.assign(points, 1);
    if (odd) values[static_cast<std::size_t>(first_of(false))] = std::nan("");  // that of the owner counts
    session.attach("w", values, FieldPlace::kPoints, Transfer::kConserve, means);
    session.adapt(std::vector<double>(points, 0.1), means, {});
    CHECK(session.report().generation == 1);
    CHECK(std::ranges::none_of(session.field("w"), [](double value) { return std::isnan(value); }));
  });
}
