#include "adapt/conserve.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "adapt/conserving_transfer.hpp"

namespace driftmesh::adapt {
namespace {

/// Memory that goes from one subdomain to the next: fresh pages would take as long as what is put into them. For
/// several threads.
class SpareRoom {
 public:
  [[nodiscard]] OverlapList take() {
    const std::lock_guard lock(mutex_);
    if (rooms_.empty()) return {};
    OverlapList room = std::move(rooms_.back());
    rooms_.pop_back();
    return room;
  }
  void give(OverlapList room) {
    const std::lock_guard lock(mutex_);
    rooms_.push_back(std::move(room));
  }

 private:
  std::mutex mutex_;
  std::vector<OverlapList> rooms_;
};

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// One value for each triangle, the mean of what it overlaps.
class AtTriangles final : public ConservingTransfer {
 public:
  AtTriangles(const Lineage& lineage, const ConservedField& field)
      : ConservingTransfer(lineage, field), values_(lineage.new_triangles() * components()) {
    lineage.visit_same_triangles([&](std::int32_t triangle, std::int32_t from, int /*turn*/) {
      for (std::size_t k = 0; k < components(); ++k) values_[place(triangle, k)] = old()[place(from, k)];
    });
  }

  void take(SubdomainId /*s*/, const Lineage::Change& change, const Overlaps& overlaps) override {
    for (const Overlap& o : overlaps.found.overlaps)
      for (std::size_t k = 0; k < components(); ++k) {
        const double from = old()[place(change.old_number[o.old_triangle], k)];
        values_[place(change.new_number[o.new_triangle], k)] += from * o.area * overlaps.correction[o.old_triangle];
      }
  }

  void end(const Lineage::Change& change) override {
    if (change.is_the_same) return;
    for (const TriangleId t : ids_of(change.new_number))
      if (change.new_number[t] != kNone && change.same[t] == kNone)
        for (std::size_t k = 0; k < components(); ++k)
          values_[place(change.new_number[t], k)] /= area_of(change.new_mesh, t);
  }

  [[nodiscard]] std::vector<double> values() override { return std::move(values_); }

 private:
  [[nodiscard]] std::size_t place(std::int32_t triangle, std::size_t k) const {
    return to_index(triangle) * components() + k;
  }
  std::vector<double> values_;
};

/// Three values for each triangle: the L2 projection, brought closer to its mean where it would exceed what it
/// overlaps.
class AtCorners final : public ConservingTransfer {
 public:
  AtCorners(const Lineage& lineage, const ConservedField& field)
      : ConservingTransfer(lineage, field), values_(3 * lineage.new_triangles() * components()) {
    lineage.visit_same_triangles([&](std::int32_t triangle, std::int32_t from, int turn) {
      for (int i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < components(); ++k)
          values_[place(triangle, i, k)] = old()[place(from, (i + turn) % 3, k)];
    });
  }

  void take(SubdomainId /*s*/, const Lineage::Change& change, const Overlaps& overlaps) override {
    const std::vector<Overlap>& list = overlaps.found.overlaps;
    for (std::size_t first = 0, end = 0; first < list.size(); first = end) {
      while (end < list.size() && list[end].new_triangle == list[first].new_triangle) ++end;
      for (std::size_t k = 0; k < components(); ++k) project(change, overlaps, first, end, k);
    }
  }

  [[nodiscard]] std::vector<double> values() override { return std::move(values_); }

 private:
  [[nodiscard]] std::size_t place(std::int32_t triangle, int corner, std::size_t k) const {
    return (3 * to_index(triangle) + static_cast<std::size_t>(corner)) * components() + k;
  }

  /// The component of the triangle whose overlaps are those from `first` to `end`.
  void project(const Lineage::Change& change, const Overlaps& overlaps, std::size_t first, std::size_t end,
               std::size_t k) {
    const TriangleId t = overlaps.found.overlaps[first].new_triangle;
    Weights moments{};  // integrals with the function of each corner
    Range range;
    for (std::size_t j = first; j < end; ++j) {
      const Overlap& o = overlaps.found.overlaps[j];
      std::array<double, 3> at{};
      for (int i = 0; i < 3; ++i) {
        at[i] = old()[place(change.old_number[o.old_triangle], i, k)];
        range.add(at[i]);
      }
      const Weights more = Share(o, overlaps.found.polygon(o), change, overlaps.correction[o.old_triangle]).moments(at);
      for (int i = 0; i < 3; ++i) moments[i] += more[i];
    }
    const double all = moments[0] + moments[1] + moments[2], area = area_of(change.new_mesh, t);
    const double mean = all / area;
    std::array<double, 3> off_mean{};
    double share = 1;  // the part of the differences from the mean that is kept
    for (int i = 0; i < 3; ++i) {
      off_mean[i] = 12 / area * (moments[i] - all / 4) - mean;
      const double room = off_mean[i] > 0 ? range.most - mean : range.least - mean;
      if (off_mean[i] != 0) share = std::min(share, std::max(0.0, room / off_mean[i]));
    }
    for (int i = 0; i < 3; ++i) values_[place(change.new_number[t], i, k)] = mean + share * off_mean[i];
  }

  std::vector<double> values_;
};

std::unique_ptr<ConservingTransfer> transfer_of(const Lineage& lineage, const ConservedField& field) {
  switch (field.place) {
    case FieldPlace::kTriangles:
      return std::make_unique<AtTriangles>(lineage, field);
    case FieldPlace::kCorners:
      return std::make_unique<AtCorners>(lineage, field);
    case FieldPlace::kPoints:
      break;
  }
  return conserving_at_points(lineage, field);
}

}  // namespace

std::vector<std::vector<double>> conserved(const Lineage& lineage, std::span<const ConservedField> fields) {
  std::vector<std::unique_ptr<ConservingTransfer>> transfers;
  for (const ConservedField& field : fields) transfers.push_back(transfer_of(lineage, field));
  SpareRoom spare;
  if (!fields.empty())
    lineage.visit_parts([&](SubdomainId s, const Lineage::Change& change) {
      for (const auto& transfer : transfers) transfer->begin(s, change);
      Overlaps overlaps(change, spare.take());
      while (overlaps.next())
        for (const auto& transfer : transfers) transfer->take(s, change, overlaps);
      for (const auto& transfer : transfers) transfer->end(change);
      spare.give(std::move(overlaps.found));
    });
  std::vector<std::vector<double>> values;
  for (const auto& transfer : transfers) values.push_back(transfer->values());
  return values;
}

}  // namespace driftmesh::adapt
