#include "decompose/decompose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "base/formatted.hpp"
#include "decompose/bridges.hpp"
#include "decompose/cutter.hpp"
#include "decompose/pieces.hpp"
#include "decompose/smoothing.hpp"
#include "decompose/to_decomposition.hpp"
#include "decompose/work_samples.hpp"
#include "driftmesh/error.hpp"
#include "mesh/bound_forecast.hpp"
#include "mesh/forecast.hpp"
#include "mesh/size_bound.hpp"

namespace driftmesh {
namespace {

/// A decomposition with a larger load than this is made again by grouping smaller pieces.
constexpr double kFairLoad = 1.45;
/// The same for many subdomains whose work is sampled: samples scatter, and a single one matters little to the balance
/// of a run.
constexpr double kFairOfMany = 1.7;
constexpr std::int32_t kMany = 32;
/// Samples of work.
constexpr double kSamplesPerSubdomain = 60;

double total_work(const IdVector<PieceId, Piece>& pieces) {
  double work = 0;
  for (const Piece& p : pieces) work += p.work;
  return work;
}

/// Work in proportion to area becomes a number of triangles.
void scale_work(IdVector<PieceId, Piece>& pieces, double total) {
  const double sum = total_work(pieces);
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
    throw Error(formatted("{} must be from {} to {}, not {}", what, least, most, value));
}

void check_options(const DecomposeOptions& o) {
  check_range("the number of subdomains", o.subdomains, 1, kMaxSubdomains);
  check_range("the angle of separators in degrees", o.min_angle, 0, kMaxSeparatorAngle);
  check_range("the skew", o.skew, 0, kMaxSkew);
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
  domain.map.whole_segments = options.whole_segments;
  domain.pieces = find_pieces(domain.map, options.bounds);
  if (samples.empty() && !SizeBounds(options.bounds).any()) scale_work(domain.pieces, forecast);
  domain.samples = share_out(std::move(samples), domain.map, domain.pieces);
  return domain;
}

/// Ways to cut a domain evenly, each tried if those before leave a subdomain with too much work. Groups of smaller
/// pieces leave some choice. To divide a few heavy pieces and join light ones is fast; where bridges between many holes
/// leave few ways to cut, the whole domain is cut into smaller pieces.
struct Attempt {
  std::int32_t finer = 1;  ///< as many times the pieces as subdomains are wanted
  bool divides_heavy = false;
};
constexpr Attempt kAttempts[] = {{1, false}, {1, true}, {4, false}, {8, false}};

bool is_sampled(const Domain& domain) {
  return !std::ranges::all_of(domain.samples, &WorkSamples::empty);
}

/// Not what is uneven on purpose, or where work is sampled: it does not follow from the area that a subdomain gains.
bool may_smooth(const Domain& domain, const DecomposeOptions& options) {
  return options.skew == 0 && !is_sampled(domain);
}

Decomposition cut_domain(Domain domain, const DecomposeOptions& options, const Attempt& attempt) {
  const std::int32_t bundles = bundle_small_parts(domain.map, domain.pieces, options.subdomains);
  const std::int32_t parts = attempt.finer * (options.subdomains - bundles);
  allot_parts(domain.map, domain.pieces, parts);
  Cutter cutter(domain.map, domain.pieces, domain.samples, options, parts);
  const std::int32_t missing = cutter.run();
  if (missing > 0 && parts - missing + bundles < options.subdomains)
    throw Error("the domain could be cut into " + std::to_string(parts - missing + bundles) + " of " +
                std::to_string(options.subdomains) + " subdomains; ask for fewer, or allow smaller angles");
  if (attempt.divides_heavy) cutter.divide(kFairLoad * total_work(domain.pieces) / options.subdomains);
  const auto group_of = group_pieces(domain.map, domain.pieces, options.subdomains);
  if (may_smooth(domain, options))
    smooth(domain.map, domain.pieces, group_of, options.subdomains, options.min_angle * std::numbers::pi / 180);
  return to_decomposition(domain.map, domain.pieces, group_of, options.subdomains);
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
  const double fair = is_sampled(domain) && options.subdomains >= kMany ? kFairOfMany : kFairLoad;
  Decomposition best;
  double load = kNoBound;
  for (const Attempt& attempt : kAttempts) {
    Decomposition found = cut_domain(domain, options, attempt);
    const double of_found = largest_load(found);
    if (of_found >= load) continue;
    best = std::move(found);
    load = of_found;
    if (options.skew > 0 || load <= fair) break;
  }
  return best;
}

}  // namespace

Decomposition decompose(const Triangulation& mesh, const DecomposeOptions& options) {
  check_options(options);
  const bool by_place = SizeBounds(options.bounds).by_place();
  const bool counts = !by_place && options.forecast == 0;
  const double forecast = counts ? forecast_triangles(mesh, options.bounds) : options.forecast;
  WorkSamples samples = sample_work(mesh, options.bounds, forecast, kSamplesPerSubdomain * options.subdomains);
  const bool may_ignore_samples = !by_place && !samples.empty();
  try {
    return cut_evenly(prepare_domain(mesh, options, forecast, std::move(samples)), options);
  } catch (const Error&) {
    if (!may_ignore_samples) throw;  // otherwise the work may be where there is no room for cuts
  }
  return cut_evenly(prepare_domain(mesh, options, forecast, {}), options);
}

}  // namespace driftmesh
