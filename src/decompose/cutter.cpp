#include "decompose/cutter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <queue>

namespace driftmesh {
Cutter::Cutter(PlanarMap& map, IdVector<PieceId, Piece>& pieces, IdVector<PieceId, WorkSamples>& samples,
               const DecomposeOptions& options, std::int32_t parts)
    : map_(map),
      pieces_(pieces),
      samples_(samples),
      skew_(options.skew),
      random_(options.seed),
      finder_(map, options.min_angle * std::numbers::pi / 180) {
  double work = 0;
  for (const Piece& p : pieces)
    if (p.bundle == kNone) work += p.work;
  mean_ = work / parts;
}

std::int32_t Cutter::run() {
  for (const PieceId i : ids_of(pieces_)) enqueue(i);
  while (!queue_.empty()) {
    std::vector<PieceId> next = std::move(queue_.extract(queue_.begin()).mapped());
    std::sort(next.begin(), next.end(), std::greater<>());
    cut_all(next);
  }
  spend_spare_parts();
  return spare_;
}

void Cutter::enqueue(PieceId piece) {
  if (pieces_[piece].parts >= 2) queue_[pieces_[piece].parts].push_back(piece);
}

void Cutter::cut_all(std::span<const PieceId> pieces) {
  for (const PieceId piece : pieces)
    if (!cut(piece, find(piece, random_bias()))) give_up(piece);
}

void Cutter::give_up(PieceId piece) {
  spare_ += pieces_[piece].parts - 1;
  pieces_[piece].parts = 1;
}

/// The heaviest subdomains that can be cut in two take over the parts that a piece could not be cut into.
void Cutter::spend_spare_parts() {
  if (spare_ == 0) return;
  const auto lighter = [this](PieceId one, PieceId other) {
    const double work = pieces_[one].work, of_other = pieces_[other].work;
    return work != of_other ? work < of_other : one > other;
  };
  std::priority_queue heaviest(lighter, std::vector<PieceId>());
  for (const PieceId i : ids_of(pieces_))
    if (pieces_[i].parts == 1) heaviest.push(i);
  while (spare_ > 0 && !heaviest.empty()) {
    const PieceId piece = heaviest.top();
    heaviest.pop();
    pieces_[piece].parts = 2;
    --spare_;
    const PieceId added = pieces_.next_id();
    if (cut(piece, find(piece, random_bias()))) {
      heaviest.push(piece);
      heaviest.push(added);
    } else {
      give_up(piece);
    }
  }
}

void Cutter::divide(double work) {
  std::vector<PieceId> heavy;
  for (const PieceId i : ids_of(pieces_))
    if (pieces_[i].parts == 1 && pieces_[i].work > work) heavy.push_back(i);
  for (const PieceId piece : heavy) {
    pieces_[piece].parts = 2;
    const FoundCut found = find(piece, random_bias());
    const bool fair =
        found && std::max(found.cut.share_between, 1 - found.cut.share_between) * pieces_[piece].work <= work;
    if (!fair && cut_in_three(piece)) continue;
    if (!cut(piece, found)) pieces_[piece].parts = 1;
  }
}

/// Where work is in proportion to area.
bool Cutter::cut_in_three(PieceId index) {
  if (!samples_[index].empty()) return false;
  const Piece piece = pieces_[index];
  const std::optional<Fork> fork = finder_.find_fork(piece);
  if (!fork) return false;
  std::array<SideId, 3> ends;
  std::ranges::transform(fork->ends, ends.begin(), [this](const auto& station) { return realize(map_, station); });
  const SideId bent = map_.connect(ends[0], ends[1], PlanarMap::Kind::kSeparator);
  const SideId from_center = map_.split(bent, map_.add_point(fork->center, kNone));
  const SideId third = map_.connect(from_center, ends[2], PlanarMap::Kind::kSeparator);
  for (const SideId side : {PlanarMap::twin(bent), PlanarMap::twin(third)}) {
    pieces_.push_back(part_of(piece, side));
    samples_.emplace_back();
  }
  pieces_[index] = part_of(piece, third);
  return true;
}

/// The piece left of `side`, once it is cut off, as one subdomain.
Piece Cutter::part_of(const Piece& whole, SideId side) {
  read_loop(map_, side, loop_);
  const double area = area_inside(loop_);
  return {side, 1, kNone, area, whole.work * area / whole.area};
}

FoundCut Cutter::find(PieceId piece, double bias) {
  const Piece& p = pieces_[piece];
  return finder_.find(p, samples_[piece], {skew_ > 0 ? 1 : p.work / p.parts / mean_, bias, skew_ > 0});
}

/// 1 without skew; else from 1 / (1 + skew) to 1 + skew.
double Cutter::random_bias() {
  if (skew_ == 0) return 1;
  constexpr double kUnit = 0x1p-64;
  const double bias = 1 + skew_ * kUnit * static_cast<double>(random_());
  return random_() % 2 == 0 ? bias : 1 / bias;
}

bool Cutter::cut(PieceId index, const FoundCut& found) {
  if (!found) return false;
  const Piece piece = pieces_[index];
  const SideId first = realize(map_, found.first);
  const SideId second = realize(map_, found.second);
  const SideId separator = map_.connect(first, second, PlanarMap::Kind::kSeparator);
  Piece rest, between;
  rest.side = separator;
  between.side = PlanarMap::twin(separator);
  read_loop(map_, between.side, loop_);
  between.area = area_inside(loop_);
  rest.area = piece.area - between.area;
  between.work = piece.work * found.cut.share_between;
  rest.work = piece.work - between.work;
  between.parts = found.cut.parts_between;
  rest.parts = piece.parts - found.cut.parts_between;
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
void Cutter::share_samples(PieceId rest, PieceId between) {
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

}  // namespace driftmesh
