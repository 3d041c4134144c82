#include "decompose/decompose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "decompose/bridges.hpp"
#include "decompose/cutter.hpp"
#include "decompose/pieces.hpp"
#include "decompose/presplit.hpp"
#include "decompose/to_decomposition.hpp"
#include "decompose/work_samples.hpp"
#include "driftmesh/error.hpp"
#include "mesh/forecast.hpp"

namespace driftmesh {
namespace {

/// A decomposition with a larger load than this is made again by grouping smaller pieces.
constexpr double kFairLoad = 1.45;
/// Samples of work.
constexpr double kSamplesPerSubdomain = 60;

/// Work in proportion to area becomes a number of triangles.
void scale_work(IdVector<PieceId, Piece>& pieces, double total) {
  double sum = 0;
  for (const Piece& p : pieces) sum += p.work;
  for (Piece& p : pieces) p.work *= total / sum;
}

/// Samples of the work in each piece, which set the piece's work; none if there are none of all.
IdVector<PieceId, WorkSamples> share_out(WorkSamples all, const PlanarMap& map, IdVector<PieceId, Piece>& pieces) {
  IdVector<PieceId, WorkSamples> samples(pieces.size());
  if (all.empty()) return samples;
  for (const PieceId i : ids_of(pieces)) {
    samples[i] = take_inside(all, border_of(map, pieces[i].side));
    pieces[i].work = std::max(1.0, work_of(samples[i]));
  }
  return samples;
}

template <class Number>
void check_range(const std::string& what, Number value, std::int32_t least, std::int32_t most) {
  if (!(value >= least && value <= most))
    throw Error(what + " must be from " + std::to_string(least) + " to " + std::to_string(most) + ", not " +
                std::to_string(value));
}

void check_options(const DecomposeOptions& o) {
  check_range("the number of subdomains", o.subdomains, 1, kMaxSubdomains);
  check_range("the angle of separators in degrees", o.min_angle, 0, kMaxSeparatorAngle);
  check_range("the skew", o.skew, 0, kMaxSkew);
}

double area_of(const Triangulation& mesh) {
  double twice = 0;
  for (const Triangle& t : mesh.triangles) {
    if (!t.alive()) continue;
    const Point &a = mesh.points[t.vertex[0]], &b = mesh.points[t.vertex[1]], &c = mesh.points[t.vertex[2]];
    twice += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  return twice / 2;
}

/// The domain before the first cut.
struct Domain {
  PlanarMap map;
  IdVector<PieceId, Piece> pieces;
  IdVector<PieceId, WorkSamples> samples;
};

/// With work according to the samples, or in proportion to area if there are none.
Domain prepare_domain(const Triangulation& mesh, const DecomposeOptions& options, double forecast,
                      WorkSamples samples) {
  const double compact = std::sqrt(area_of(mesh) / options.subdomains);  // the width of a compact subdomain
  Domain domain;
  domain.map = connected_walls(mesh, compact / 4, options.min_angle * std::numbers::pi / 180);
  domain.pieces = find_pieces(domain.map, options.bounds);
  if (samples.empty() && !bounds_size(options.bounds)) scale_work(domain.pieces, forecast);
  domain.samples = share_out(std::move(samples), domain.map, domain.pieces);
  return domain;
}

/// Cuts into `finer` times as many pieces as subdomains are wanted, and groups them. Bridges leave few ways to cut a
/// domain with many holes into a few subdomains; groups of smaller pieces have more.
Decomposition cut_domain(Domain domain, const DecomposeOptions& options, std::int32_t finer) {
  const std::int32_t bundles = bundle_small_parts(domain.map, domain.pieces, options.subdomains);
  const std::int32_t parts = finer * (options.subdomains - bundles);
  allot_parts(domain.map, domain.pieces, parts);
  const std::int32_t missing = Cutter(domain.map, domain.pieces, domain.samples, options, parts).run();
  if (missing > 0 && parts - missing + bundles < options.subdomains)
    throw Error("the domain could be cut into " + std::to_string(parts - missing + bundles) + " of " +
                std::to_string(options.subdomains) + " subdomains; ask for fewer, or allow smaller angles");
  return to_decomposition(domain.map, domain.pieces, group_pieces(domain.map, domain.pieces, options.subdomains),
                          options.subdomains);
}

double largest_load(const Decomposition& d) {
  double work = 0, most = 0;
  for (const Decomposition::Subdomain& s : d.subdomains) {
    work += s.predicted;
    most = std::max(most, s.predicted);
  }
  return most * static_cast<double>(d.size()) / work;
}

Decomposition cut_evenly(const Domain& domain, const DecomposeOptions& options) {
  Decomposition result = cut_domain(domain, options, 1);
  if (options.skew > 0) return result;
  for (const std::int32_t finer : {4, 8}) {
    if (largest_load(result) <= kFairLoad) break;
    Decomposition grouped = cut_domain(domain, options, finer);
    if (largest_load(grouped) < largest_load(result)) result = std::move(grouped);
  }
  return result;
}

}  // namespace

Decomposition decompose(const Triangulation& mesh, const DecomposeOptions& options) {
  check_options(options);
  const bool counts = options.bounds.size == nullptr && options.forecast == 0;
  const double forecast = counts ? forecast_triangles(mesh, options.bounds) : options.forecast;
  WorkSamples samples = sample_work(mesh, options.bounds, forecast, kSamplesPerSubdomain * options.subdomains);
  const bool may_ignore_samples = options.bounds.size == nullptr && !samples.empty();
  try {
    return cut_evenly(prepare_domain(mesh, options, forecast, std::move(samples)), options);
  } catch (const Error&) {
    if (!may_ignore_samples) throw;  // otherwise the work may be where there is no room for cuts
  }
  return cut_evenly(prepare_domain(mesh, options, forecast, {}), options);
}

}  // namespace driftmesh
