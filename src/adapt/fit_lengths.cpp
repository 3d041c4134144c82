#include "adapt/fit_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "adapt/demand.hpp"
#include "adapt/length_growth.hpp"
#include "adapt/of_all_parts.hpp"
#include "adapt/shared_points.hpp"
#include "base/formatted.hpp"
#include "base/in_turns.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::adapt {
namespace {

/// Calls work(s) for all subdomains here, on several threads.
void for_each_part(const Generation& present, std::int32_t threads, const std::function<void(SubdomainId)>& work) {
  in_turns(present.here.size(), to_index(threads), [&](std::size_t i) { work(present.here[i]); });
}

void require_lengths(const Generation& present, std::span<const double> lengths) {
  const std::size_t points = present.piece.mesh.points.size();
  if (lengths.size() != points)
    throw Error("adapt: there are " + std::to_string(lengths.size()) + " lengths for " + std::to_string(points) +
                " points; give one for each point of the present mesh");
  const auto wrong = std::ranges::find_if(lengths, [](double h) { return !(h > 0); });
  if (wrong != lengths.end())
    throw Error(
        formatted("adapt: the length at point {} (counted from 0) is {}; a length must be positive, or infinite for no "
                  "bound",
                  wrong - lengths.begin(), *wrong));
}

/// The least of what all ranks have at the points of their pieces.
void take_least(std::vector<double>& values, const DistributedPiece& piece, Ranks& ranks) {
  const std::vector<double> own = values;
  tell_at_shared_points(
      ranks, piece, [&](std::int32_t point, ByteWriter& writer) { writer.value(own[to_index(point)]); },
      [&](std::int32_t point, ByteReader& reader, Rank /*from*/) {
        double& value = values[to_index(point)];
        value = std::min(value, reader.value<double>());
      });
}

/// Whether it is true on a rank.
bool on_any(Ranks& ranks, bool own) {
  if (ranks.alone()) return own;
  const std::vector<Bytes> all = ranks.bytes_of_all({own ? std::byte{1} : std::byte{0}});
  return std::ranges::any_of(all, [](const Bytes& bytes) { return bytes.at(0) != std::byte{0}; });
}

/// Lengths at points while they are lowered. A vertex that several parts share has one of the same length in each.
class GrowthLimit {
 public:
  GrowthLimit(const Generation& present, LengthsOfParts& lengths, std::int32_t threads, Ranks& ranks)
      : present_(present),
        lengths_(lengths),
        threads_(threads),
        ranks_(ranks),
        border_(present.parts.size()),
        least_(present.piece.mesh.points.size(), std::numeric_limits<double>::infinity()) {
    for_each_part(present, threads, [&](SubdomainId s) {
      const Triangulation& mesh = present.parts[s].mesh->mesh;
      for (const VertexId v : ids_of(mesh.points))
        if (mesh.origin[v] != kFree && mesh.origin[v] != kDeleted) border_[s].push_back(v);
    });
  }

  /// All parts, then those of which the neighbors have lowered a vertex, until there are none on any rank.
  void apply(double gradation) {
    std::vector<SubdomainId> open = present_.here;
    do {
      limit_on_rank(gradation, open);
      take_least(least_, present_.piece, ranks_);
      open = lowered_to_least();
    } while (on_any(ranks_, !open.empty()));
  }

 private:
  void limit_on_rank(double gradation, std::vector<SubdomainId> open) {
    while (!open.empty()) {
      in_turns(open.size(), to_index(threads_),
               [&](std::size_t i) { limit_growth(present_.parts[open[i]].mesh->mesh, gradation, lengths_[open[i]]); });
      for (const SubdomainId s : open)
        for (const VertexId v : border_[s]) {
          double& least = least_[to_index(present_.places[s][v])];
          least = std::min(least, lengths_[s][v]);
        }
      open = lowered_to_least();
    }
  }

  /// The parts in which that changes something.
  std::vector<SubdomainId> lowered_to_least() {
    std::vector<SubdomainId> lowered;
    for (const SubdomainId s : present_.here)
      if (lower_to_least(s)) lowered.push_back(s);
    return lowered;
  }

  bool lower_to_least(SubdomainId s) {
    bool any = false;
    for (const VertexId v : border_[s]) {
      const double least = least_[to_index(present_.places[s][v])];
      if (!(least < lengths_[s][v])) continue;
      lengths_[s][v] = least;
      any = true;
    }
    return any;
  }

  const Generation& present_;
  LengthsOfParts& lengths_;
  std::int32_t threads_;
  Ranks& ranks_;
  IdVector<SubdomainId, std::vector<VertexId>> border_;
  std::vector<double> least_;  // the least of all copies, at points
};

double triangles_asked(const Generation& present, const QualityBounds& bounds, const LengthsOfParts& lengths,
                       std::int32_t threads, Ranks& ranks) {
  IdVector<SubdomainId, double> asked(present.parts.size());
  for_each_part(present, threads, [&](SubdomainId s) {
    asked[s] = demand_of(present.parts[s].mesh->mesh, bounds, lengths[s]).triangles;
  });
  double all = 0;
  for (const double of_one : of_all_parts(ranks, present, [&](SubdomainId s) { return asked[s]; })) all += of_one;
  return all;
}

/// The triangles of the present mesh for each that was asked for: angles and borders need some more, and lengths that
/// grow are taken where they are least.
double made_for_each_asked(const Generation& present, Ranks& ranks) {
  constexpr double kMost = 4;  // more comes from the outline, and longer lengths would not help
  double asked = 0;
  for (const double of_one : of_all_parts(ranks, present, [&](SubdomainId s) { return present.parts[s].asked; }))
    asked += of_one;
  const auto made = static_cast<double>(present.piece.total_triangles);
  return asked > 0 ? std::clamp(made / asked, 1.0, kMost) : 1;
}

/// Calls set(factor), which sets wanted.lengths by that factor, until they ask for no more triangles than options
/// allow.
void scale_to_fit(const Generation& present, const QualityBounds& bounds, const AdaptiveOptions& options,
                  std::int32_t threads, Ranks& ranks, Wanted& wanted, const std::function<void(double)>& set) {
  constexpr int kMostTries = 8;  // limits on growth ask for more triangles again
  const double made = made_for_each_asked(present, ranks);
  set(1);
  for (int i = 0; options.most_triangles > 0 && i < kMostTries; ++i) {
    const double asked = made * triangles_asked(present, bounds, wanted.lengths, threads, ranks);
    if (!(asked > options.most_triangles)) break;
    wanted.scale *= std::sqrt(asked / options.most_triangles) * 1.001;
    set(wanted.scale);
  }
}

}  // namespace

double FittedField::fitted(double length) const {
  return scale_ * std::clamp(length, options_.shortest, options_.longest);
}

double FittedField::least_between(const std::array<Point, 3>& triangle, double at_corners) const {
  const double least = scale_ * field_.least_between(triangle, at_corners / scale_);
  return std::max(least, scale_ * options_.shortest);
}

Wanted fit_lengths(const Generation& present, const QualityBounds& bounds, const AdaptiveOptions& options,
                   std::span<const double> lengths, std::int32_t threads, Ranks& ranks) {
  ranks.agree([&] { require_lengths(present, lengths); });
  std::vector<double> least(lengths.begin(), lengths.end());
  take_least(least, present.piece, ranks);
  Wanted wanted;
  wanted.lengths.resize(present.parts.size());
  scale_to_fit(present, bounds, options, threads, ranks, wanted, [&](double factor) {
    for_each_part(present, threads, [&](SubdomainId s) {
      const IdVector<VertexId, std::int32_t>& places = present.places[s];
      wanted.lengths[s].resize(places.size(), std::numeric_limits<double>::infinity());
      for (const VertexId v : ids_of(places))
        if (places[v] != kNone)
          wanted.lengths[s][v] = factor * std::clamp(least[to_index(places[v])], options.shortest, options.longest);
    });
    if (options.gradation > 0) GrowthLimit(present, wanted.lengths, threads, ranks).apply(options.gradation);
  });
  return wanted;
}

Wanted fit_field(const Generation& present, const QualityBounds& bounds, const AdaptiveOptions& options,
                 FittedField& field, std::int32_t threads, Ranks& ranks) {
  Wanted wanted;
  wanted.between = &field;
  wanted.lengths.resize(present.parts.size());
  LengthsOfParts unscaled(present.parts.size());
  ranks.agree([&] {
    for_each_part(present, threads, [&](SubdomainId s) {
      const Triangulation& mesh = present.parts[s].mesh->mesh;
      for (const VertexId v : ids_of(mesh.points))
        unscaled[s].push_back(mesh.origin[v] == kDeleted ? std::numeric_limits<double>::infinity()
                                                         : field.edge_length(mesh.points[v]));
    });
  });
  scale_to_fit(present, bounds, options, threads, ranks, wanted, [&](double factor) {
    field.scale(factor);
    for (const SubdomainId s : ids_of(unscaled)) {
      wanted.lengths[s] = unscaled[s];
      for (double& length : wanted.lengths[s]) length *= factor;
    }
  });
  return wanted;
}

}  // namespace driftmesh::adapt
