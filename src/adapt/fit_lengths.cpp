#include "adapt/fit_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "adapt/demand.hpp"
#include "adapt/length_growth.hpp"
#include "base/in_turns.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::adapt {
namespace {

/// Calls work(s) for all subdomains, on several threads.
void for_each_part(const Generation& present, std::int32_t threads, const std::function<void(SubdomainId)>& work) {
  in_turns(present.parts.size(), to_index(threads), [&](std::size_t s) { work(static_cast<SubdomainId>(s)); });
}

void require_lengths(const Generation& present, std::span<const double> lengths) {
  const std::size_t points = present.piece.mesh.points.size();
  if (lengths.size() != points)
    throw Error("adapt: there are " + std::to_string(lengths.size()) + " lengths for " + std::to_string(points) +
                " points; give one for each point of the present mesh");
  const auto wrong = std::ranges::find_if(lengths, [](double h) { return !(h > 0); });
  if (wrong != lengths.end())
    throw Error("adapt: the length at point " + std::to_string(wrong - lengths.begin()) + " (counted from 0) is " +
                std::to_string(*wrong) + "; a length must be positive, or infinite for no bound");
}

/// Lengths at points while they are lowered. A vertex that several parts share has one of the same length in each.
class GrowthLimit {
 public:
  GrowthLimit(const Generation& present, LengthsOfParts& lengths, std::int32_t threads)
      : present_(present),
        lengths_(lengths),
        threads_(threads),
        border_(present.parts.size()),
        least_(present.piece.mesh.points.size(), std::numeric_limits<double>::infinity()) {
    for_each_part(present, threads, [&](SubdomainId s) {
      const Triangulation& mesh = present.parts[s].mesh->mesh;
      for (const VertexId v : ids_of(mesh.points))
        if (mesh.origin[v] != kFree && mesh.origin[v] != kDeleted) border_[s].push_back(v);
    });
  }

  /// All parts, then those of which the neighbors have lowered a vertex, until there are none.
  void apply(double gradation) {
    std::vector<SubdomainId> open;
    for (const SubdomainId s : ids_of(present_.parts)) open.push_back(s);
    while (!open.empty()) {
      in_turns(open.size(), to_index(threads_),
               [&](std::size_t i) { limit_growth(present_.parts[open[i]].mesh->mesh, gradation, lengths_[open[i]]); });
      for (const SubdomainId s : open)
        for (const VertexId v : border_[s]) {
          double& least = least_[to_index(present_.places[s][v])];
          least = std::min(least, lengths_[s][v]);
        }
      open.clear();
      for (const SubdomainId s : ids_of(present_.parts))
        if (lower_to_least(s)) open.push_back(s);
    }
  }

 private:
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
  IdVector<SubdomainId, std::vector<VertexId>> border_;
  std::vector<double> least_;  // the least of all copies, at points
};

double triangles_asked(const Generation& present, const QualityBounds& bounds, const LengthsOfParts& lengths,
                       std::int32_t threads) {
  IdVector<SubdomainId, double> asked(present.parts.size());
  for_each_part(present, threads, [&](SubdomainId s) {
    asked[s] = demand_of(present.parts[s].mesh->mesh, bounds, lengths[s]).triangles;
  });
  double all = 0;  // in the order of numbers
  for (const double of_one : asked) all += of_one;
  return all;
}

/// The triangles of the present mesh for each that was asked for: angles and borders need some more, and lengths that
/// grow are taken where they are least.
double made_for_each_asked(const Generation& present) {
  constexpr double kMost = 1.5;  // more is not to be had from lengths
  double asked = 0;
  for (const Part& part : present.parts) asked += part.asked;
  const auto made = static_cast<double>(present.piece.mesh.triangles.size());
  return asked > 0 ? std::clamp(made / asked, 1.0, kMost) : 1;
}

/// Calls set(factor), which sets wanted.lengths by that factor, until they ask for no more triangles than options
/// allow.
void scale_to_fit(const Generation& present, const QualityBounds& bounds, const AdaptiveOptions& options,
                  std::int32_t threads, Wanted& wanted, const std::function<void(double)>& set) {
  constexpr int kMostTries = 8;  // limits on growth ask for more triangles again
  const double made = made_for_each_asked(present);
  set(1);
  for (int i = 0; options.most_triangles > 0 && i < kMostTries; ++i) {
    const double asked = made * triangles_asked(present, bounds, wanted.lengths, threads);
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
                   std::span<const double> lengths, std::int32_t threads) {
  require_lengths(present, lengths);
  Wanted wanted;
  wanted.lengths.resize(present.parts.size());
  scale_to_fit(present, bounds, options, threads, wanted, [&](double factor) {
    for_each_part(present, threads, [&](SubdomainId s) {
      const IdVector<VertexId, std::int32_t>& places = present.places[s];
      wanted.lengths[s].resize(places.size(), std::numeric_limits<double>::infinity());
      for (const VertexId v : ids_of(places))
        if (places[v] != kNone)
          wanted.lengths[s][v] = factor * std::clamp(lengths[to_index(places[v])], options.shortest, options.longest);
    });
    if (options.gradation > 0) GrowthLimit(present, wanted.lengths, threads).apply(options.gradation);
  });
  return wanted;
}

Wanted fit_field(const Generation& present, const QualityBounds& bounds, const AdaptiveOptions& options,
                 FittedField& field, std::int32_t threads) {
  Wanted wanted;
  wanted.between = &field;
  wanted.lengths.resize(present.parts.size());
  LengthsOfParts unscaled(present.parts.size());
  for_each_part(present, threads, [&](SubdomainId s) {
    const Triangulation& mesh = present.parts[s].mesh->mesh;
    for (const VertexId v : ids_of(mesh.points))
      unscaled[s].push_back(mesh.origin[v] == kDeleted ? std::numeric_limits<double>::infinity()
                                                       : field.edge_length(mesh.points[v]));
  });
  scale_to_fit(present, bounds, options, threads, wanted, [&](double factor) {
    field.scale(factor);
    for (const SubdomainId s : ids_of(unscaled)) {
      wanted.lengths[s] = unscaled[s];
      for (double& length : wanted.lengths[s]) length *= factor;
    }
  });
  return wanted;
}

}  // namespace driftmesh::adapt
