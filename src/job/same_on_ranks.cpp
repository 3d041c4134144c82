#include "job/same_on_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include "base/bytes.hpp"
#include "base/formatted.hpp"
#include "base/key_error.hpp"
#include "geometry/midpoint.hpp"
#include "job/failure.hpp"
#include "job/keys.hpp"
#include "job/value.hpp"

namespace driftmesh::job {
namespace {

/// The bytes of every rank on every rank.
std::vector<Bytes> of_all(Team& team, const Bytes& own) {
  ByteWriter all;
  for (const Bytes& bytes : team.gather(own)) all.array(bytes);
  const Bytes joined = team.broadcast(all.take());
  std::vector<Bytes> of_ranks;
  for (ByteReader reader(joined); !reader.at_end();) reader.array(of_ranks.emplace_back());
  return of_ranks;
}

// ---- Settings ----

Bytes bytes_of(const std::vector<RankSetting>& settings) {
  ByteWriter writer;
  for (const RankSetting& setting : settings) writer.text(setting.value);
  return writer.take();
}

std::vector<std::string> values_in(const Bytes& bytes) {
  std::vector<std::string> values;
  for (ByteReader reader(bytes); !reader.at_end();) values.push_back(reader.text());
  return values;
}

/// "rank 1", "ranks 1, 2 and 4", or "ranks 1, 2, 3 and 61 others".
std::string ranks_words(const std::vector<Rank>& ranks) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> words;
  for (const Rank r : ranks) words.push_back(to_string(r));
  if (words.size() == 1) return "rank " + words.front();
  if (words.size() > kMost) {
    words.resize(kMost - 1);
    words.push_back(std::to_string(ranks.size() - words.size()) + " others");
  }
  const std::string last = std::exchange(words.back(), "");
  words.pop_back();
  return formatted("ranks {} and {}", joined(words, ", "), last);
}

void compare(const std::vector<RankSetting>& own, const std::vector<Bytes>& of_ranks) {
  std::vector<std::vector<std::string>> values;
  std::transform(of_ranks.begin(), of_ranks.end(), std::back_inserter(values), values_in);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const std::string& of_first = values.front().at(k);
    std::vector<Rank> others;
    for (const Rank r : first_ids<Rank>(values.size()))
      if (values[to_index(r)].at(k) != of_first) others.push_back(r);
    if (others.empty()) continue;
    throw Keyed<Error>(
        KeyText::of("{} differs between ranks: {} on rank 0, {} on rank {}{}; give the same on each rank", own[k].name,
                    of_first, values[to_index(others.front())][k], to_string(others.front()),
                    others.size() == 1 ? "" : " (not as on rank 0: " + ranks_words(others) + ")"));
  }
}

// ---- Sizes ----

/// Where fields are compared: each inside or on the border of the domain.
std::vector<Point> points_on_interfaces(const Decomposition& d) {
  std::vector<Point> points;
  for (const Decomposition::Root& root : d.roots) {
    if (!root.is_interface()) continue;
    const Point &a = d.points[root.a], &b = d.points[root.b];
    points.insert(points.end(), {a, midpoint(a, b), b});
  }
  return points;
}

bool same_length(double a, double b) {
  constexpr double kTolerance = 1e-6;  // more than other processors' last bits, less than anyone could mean
  return a == b || std::abs(a - b) <= kTolerance * std::max(std::abs(a), std::abs(b));
}

struct Difference {
  std::uint64_t place = 0;
  double length = 0;
};

/// The first place where `own` differs from what rank 0 has; nothing if there is none.
Bytes first_difference(const std::vector<double>& of_first, const std::vector<double>& own) {
  ByteWriter writer;
  const auto differs = std::ranges::mismatch(of_first, own, same_length);
  if (differs.in2 != own.end())
    writer.value(Difference{static_cast<std::uint64_t>(differs.in2 - own.begin()), *differs.in2});
  return writer.take();
}

// ---- Points ----

Bytes own_presplit(const RunPlan& plan, Rank rank) {
  ByteWriter writer;
  const Decomposition& d = plan.decomposition;
  for (const GlobalRootId r : ids_of(d.roots)) {
    if (!d.roots[r].is_interface() || plan.owners[d.roots[r].left] != rank) continue;
    writer.value(r);
    writer.array(presplit_paths(d, r, plan.bounds));
  }
  return writer.take();
}

}  // namespace

std::vector<RankSetting> settings_of(const Request& request) {
  std::vector<RankSetting> settings;
  for (const Key& key : keys()) settings.push_back({KeyText::key(key.name), text_of(key.load(request))});
  return settings;
}

void require_same(Team& team, const std::vector<RankSetting>& own) {
  if (team.alone()) return;
  compare(own, of_all(team, bytes_of(own)));
}

void require_same_size(Team& team, const Decomposition& decomposition, const SizeField& size) {
  if (team.alone()) return;
  const std::vector<Point> points = points_on_interfaces(decomposition);
  std::vector<double> own;
  agree(team, [&] {
    for (const Point& p : points) own.push_back(size.edge_length(p));
  });
  ByteWriter writer;
  if (team.leads()) writer.array(own);
  const Bytes bytes = team.broadcast(writer.take());
  std::vector<double> of_first;
  ByteReader(bytes).array(of_first);
  const std::vector<Bytes> differences = of_all(team, first_difference(of_first, own));
  for (const Rank r : first_ids<Rank>(differences.size())) {
    if (differences[to_index(r)].empty()) continue;
    const auto [k, length] = ByteReader(differences[to_index(r)]).value<Difference>();
    throw Error(
        formatted("the size field differs between ranks: at ({}, {}) it is {} on rank 0 and {} on rank {}; "
                  "give the same on each rank, such as one made of the values of all ranks",
                  shortest_text(points[k].x), shortest_text(points[k].y), shortest_text(of_first[k]),
                  shortest_text(length), to_string(r)));
  }
}

PresplitPaths share_presplit(Team& team, const RunPlan& plan) {
  Bytes own;
  agree(team, [&] { own = own_presplit(plan, team.rank()); });
  PresplitPaths paths;
  for (const Bytes& bytes : of_all(team, own))
    for (ByteReader reader(bytes); !reader.at_end();) {
      const auto root = reader.value<GlobalRootId>();
      reader.array(paths[root]);
    }
  return paths;
}

}  // namespace driftmesh::job
