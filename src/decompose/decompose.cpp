#include "decompose/decompose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <random>
#include <string>
#include <utility>

#include "decompose/bridges.hpp"
#include "decompose/cut_search.hpp"
#include "decompose/pieces.hpp"
#include "decompose/presplit.hpp"
#include "decompose/to_decomposition.hpp"
#include "decompose/work_samples.hpp"
#include "driftmesh/error.hpp"
#include "mesh/forecast.hpp"

namespace driftmesh {
namespace {

/// How thorough the search for a cut is. Efforts are tried in order until one finds a good cut; for most pieces the
/// first one does.
struct Effort {
  double angle;    ///< relative to the requested minimum
  double spacing;  ///< of stations, relative to the square root of the piece's area
  std::size_t max_stations;
  double clearance;
};
/// No cut makes an angle below half the requested one: below 30 degrees, refinement could split its two sides in turns.
constexpr Effort kEfforts[] = {{1, 1.0 / 11, 64, 0.2},     {1, 1.0 / 25, 128, 0.2},    {1, 1.0 / 60, 300, 0.1},
                               {0.9, 1.0 / 60, 300, 0.1},  {0.75, 1.0 / 60, 300, 0.1}, {0.6, 1.0 / 60, 300, 0.05},
                               {0.5, 1.0 / 100, 400, 0.02}};
/// If a cut leaves a finished subdomain with more work than this, relative to the mean, the next effort is tried,
/// unless it has a smaller angle.
constexpr double kGoodLoad = 1.38;
/// A decomposition with a larger load than this is made again by grouping smaller pieces.
constexpr double kFairLoad = 1.45;
/// Samples of work per subdomain, and the largest number that a search uses.
constexpr double kSamplesPerSubdomain = 60;
constexpr std::size_t kMostSamples = 250;

std::vector<Point> border_of(const PlanarMap& map, SideId side) {
  std::vector<Point> border;
  SideId h = side;
  do {
    border.push_back(map.at(map.start(h)));
    h = map.side(h).next;
  } while (h != side);
  return border;
}

double work_of(const WorkSamples& samples) {
  double work = 0;
  for (const WorkSample& s : samples) work += s.work;
  return work;
}

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

/// Cuts pieces until each is one subdomain.
class Cutter {
 public:
  Cutter(PlanarMap& map, IdVector<PieceId, Piece>& pieces, IdVector<PieceId, WorkSamples>& samples,
         const DecomposeOptions& options, std::int32_t parts)
      : map_(map),
        pieces_(pieces),
        samples_(samples),
        angle_(options.min_angle * std::numbers::pi / 180),
        skew_(options.skew),
        random_(options.seed) {
    double work = 0;
    for (const Piece& p : pieces)
      if (p.bundle == kNone) work += p.work;
    mean_ = work / parts;
  }

  /// Returns the number of parts that could not be made.
  std::int32_t run() {
    for (const PieceId i : ids_of(pieces_)) enqueue(i);
    while (!queue_.empty()) {
      const PieceId piece = queue_.top().second;
      queue_.pop();
      if (!cut(piece)) give_up(piece);
    }
    spend_spare_parts();
    return spare_;
  }

 private:
  void enqueue(PieceId piece) {
    if (pieces_[piece].parts >= 2) queue_.emplace(pieces_[piece].parts, piece);
  }

  void give_up(PieceId piece) {
    spare_ += pieces_[piece].parts - 1;
    pieces_[piece].parts = 1;
    solid_.resize(pieces_.size(), false);
    solid_[piece] = true;
  }

  /// The heaviest subdomains that can be cut take over the parts that a piece could not be cut into.
  void spend_spare_parts() {
    while (spare_ > 0) {
      solid_.resize(pieces_.size(), false);
      PieceId heaviest = kNone;
      for (const PieceId i : ids_of(pieces_))
        if (pieces_[i].parts == 1 && !solid_[i] && (heaviest == kNone || pieces_[i].work > pieces_[heaviest].work))
          heaviest = i;
      if (heaviest == kNone) return;
      pieces_[heaviest].parts = 2;
      --spare_;
      if (!cut(heaviest)) give_up(heaviest);
    }
  }

  Cut search(const Piece& piece, const WorkSamples& samples) {
    const PieceSize size = measure_piece(map_, piece.side);
    CutGoal goal;
    goal.parts = piece.parts;
    goal.load = skew_ > 0 ? 1 : piece.work / piece.parts / mean_;
    goal.bias = random_bias();
    Cut best;
    for (const Effort& effort : kEfforts) {
      if (best && effort.angle < 1) break;
      const double spacing =
          std::max(std::sqrt(size.area) * effort.spacing, size.length / static_cast<double>(4 * effort.max_stations));
      goal.angle = angle_ * effort.angle;
      goal.clearance = effort.clearance;
      goal.max_stations = effort.max_stations;
      read_outline(map_, piece.side, spacing, goal.angle, outline_);
      set_samples(outline_, thinned(samples, kMostSamples));
      const Cut cut = search_.find(map_, outline_, goal);
      if (!cut || (best && best.cost <= cut.cost)) continue;
      best = cut;
      chosen_[0] = outline_.stations[cut.first];
      chosen_[1] = outline_.stations[cut.second];
      if (is_good(cut, goal)) break;
    }
    return best;
  }

  /// 1 without skew; else from 1 / (1 + skew) to 1 + skew.
  double random_bias() {
    if (skew_ == 0) return 1;
    constexpr double kUnit = 0x1p-64;
    const double bias = 1 + skew_ * kUnit * static_cast<double>(random_());
    return random_() % 2 == 0 ? bias : 1 / bias;
  }

  [[nodiscard]] bool is_good(const Cut& cut, const CutGoal& goal) const {
    return skew_ > 0 || heaviest_single(cut, goal) <= kGoodLoad;
  }

  static double heaviest_single(const Cut& cut, const CutGoal& goal) {
    const std::int32_t rest = goal.parts - cut.parts_between;
    double load = 0;
    if (cut.parts_between == 1) load = goal.load * cut.share_between * goal.parts;
    if (rest == 1) load = std::max(load, goal.load * (1 - cut.share_between) * goal.parts);
    return load;
  }

  bool cut(PieceId index) {
    const Piece piece = pieces_[index];
    const Cut found = search(piece, samples_[index]);
    if (!found) return false;
    const SideId first = realize(map_, chosen_[0]);
    const SideId second = realize(map_, chosen_[1]);
    const SideId separator = map_.connect(first, second, PlanarMap::Kind::kSeparator);
    Piece rest, between;
    rest.side = separator;
    between.side = PlanarMap::twin(separator);
    between.area = measure_piece(map_, between.side).area;
    rest.area = piece.area - between.area;
    between.work = piece.work * found.share_between;
    rest.work = piece.work - between.work;
    between.parts = found.parts_between;
    rest.parts = piece.parts - found.parts_between;
    pieces_[index] = rest;
    const PieceId added = pieces_.next_id();
    pieces_.push_back(between);
    samples_.emplace_back();
    if (!samples_[index].empty()) share_samples(index, added);
    enqueue(index);
    enqueue(added);
    return true;
  }

  /// The search uses some of the samples; the work of each side, and its number of parts, follow from all of them.
  void share_samples(PieceId rest, PieceId between) {
    samples_[between] = take_inside(samples_[rest], border_of(map_, pieces_[between].side));
    const double work = pieces_[rest].work + pieces_[between].work;
    if (samples_[between].empty() || samples_[rest].empty()) return;
    pieces_[between].work = work_of(samples_[between]);
    pieces_[rest].work = work - pieces_[between].work;
    if (skew_ > 0) return;
    const std::int32_t parts = pieces_[rest].parts + pieces_[between].parts;
    const auto due = static_cast<std::int32_t>(std::lround(parts * pieces_[between].work / work));
    pieces_[between].parts = std::clamp(due, 1, parts - 1);
    pieces_[rest].parts = parts - pieces_[between].parts;
  }

  PlanarMap& map_;
  IdVector<PieceId, Piece>& pieces_;
  IdVector<PieceId, WorkSamples>& samples_;  // of each piece, all empty where work is in proportion to area
  double angle_;
  double mean_ = 0;
  double skew_;
  std::mt19937_64 random_;
  std::priority_queue<std::pair<std::int32_t, PieceId>> queue_;
  IdVector<PieceId, bool> solid_;  // pieces for which no cut was found
  std::int32_t spare_ = 0;
  Outline outline_;
  Outline::Station chosen_[2];
  CutSearch search_;
};

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
Domain prepare_domain(const Triangulation& mesh, const DecomposeOptions& options, WorkSamples samples) {
  const double compact = std::sqrt(area_of(mesh) / options.subdomains);  // the width of a compact subdomain
  Domain domain;
  domain.map = connected_walls(mesh, compact / 4, options.min_angle * std::numbers::pi / 180);
  domain.pieces = find_pieces(domain.map, options.bounds);
  if (samples.empty() && !bounds_size(options.bounds))
    scale_work(domain.pieces, forecast_triangles(mesh, options.bounds));
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
  WorkSamples samples = sample_work(mesh, options.bounds, kSamplesPerSubdomain * options.subdomains);
  const bool may_ignore_samples = options.bounds.size == nullptr && !samples.empty();
  try {
    return cut_evenly(prepare_domain(mesh, options, std::move(samples)), options);
  } catch (const Error&) {
    if (!may_ignore_samples) throw;  // otherwise the work may be where there is no room for cuts
  }
  return cut_evenly(prepare_domain(mesh, options, {}), options);
}

}  // namespace driftmesh
