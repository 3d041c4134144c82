#include "decompose/cut_finder.hpp"

#include <algorithm>
#include <cmath>

namespace driftmesh {
namespace {

/// How thorough the search for a cut is. Efforts are tried in order until one finds a good cut; for most pieces the
/// first one does.
struct Effort {
  double angle;    ///< relative to the requested minimum
  double spacing;  ///< distance of stations, relative to the square root of the piece's area
  std::size_t max_stations;
  double clearance;
};
/// No cut makes an angle below half the requested one: below 30 degrees, refinement could split its two sides in turns.
constexpr Effort kEfforts[] = {{1, 1.0 / 9, 64, 0.2},      {1, 1.0 / 25, 128, 0.2},    {1, 1.0 / 60, 300, 0.1},
                               {0.9, 1.0 / 60, 300, 0.1},  {0.75, 1.0 / 60, 300, 0.1}, {0.6, 1.0 / 60, 300, 0.05},
                               {0.5, 1.0 / 100, 400, 0.02}};
/// If a cut leaves a finished subdomain with more work than this, relative to the mean, the next effort is tried,
/// unless it has a smaller angle.
constexpr double kGoodLoad = 1.38;
/// The largest number of samples that a search uses.
constexpr std::size_t kMostSamples = 250;

/// The largest load of a finished subdomain.
double heaviest_single(const Cut& cut, const CutGoal& goal) {
  const std::int32_t rest = goal.parts - cut.parts_between;
  double load = 0;
  if (cut.parts_between == 1) load = goal.load * cut.share_between * goal.parts;
  if (rest == 1) load = std::max(load, goal.load * (1 - cut.share_between) * goal.parts);
  return load;
}

}  // namespace

FoundCut CutFinder::find(const Piece& piece, const WorkSamples& samples, const Fairness& fairness) {
  if (samples.size() == 1) return {};  // all the work would be on one side
  read_loop(map_, piece.side, outline_.loop);
  const PieceSize size = measure(outline_.loop);
  const WorkSamples some = thinned(samples, kMostSamples);
  CutGoal goal;
  goal.parts = piece.parts;
  goal.load = fairness.load;
  goal.bias = fairness.bias;
  FoundCut best;
  for (const Effort& effort : kEfforts) {
    if (best && effort.angle < 1) break;
    const double spacing =
        std::max(std::sqrt(size.area) * effort.spacing, size.length / static_cast<double>(4 * effort.max_stations));
    goal.clearance = effort.clearance;
    goal.max_stations = effort.max_stations;
    place_stations(map_, spacing, angle_ * effort.angle, outline_);
    set_samples(outline_, some);
    const Cut cut = search_.find(outline_, goal);
    if (!cut || (best && best.cut.cost <= cut.cost)) continue;
    best.cut = cut;
    best.first = outline_.stations[cut.first];
    best.second = outline_.stations[cut.second];
    if (fairness.uneven || heaviest_single(cut, goal) <= kGoodLoad) break;
  }
  return best;
}

std::optional<Fork> CutFinder::find_fork(const Piece& piece) {
  constexpr double kSpacing = 1.0 / 15;
  read_loop(map_, piece.side, outline_.loop);
  place_stations(map_, kSpacing * std::sqrt(piece.area), angle_, outline_);
  return driftmesh::find_fork(outline_, angle_);
}

}  // namespace driftmesh
