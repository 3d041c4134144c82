#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "adapt/field_transfer.hpp"

namespace driftmesh::adapt {
namespace {

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// One value for each triangle, the mean of what it overlaps.
class AtTriangles final : public FieldTransfer {
 public:
  AtTriangles(const Lineage& lineage, const Field& field)
      : FieldTransfer(lineage, field), values_(lineage.new_triangles() * components()) {}

  void begin(const Lineage::Change& change) override {
    visit_same_triangles(change, [&](std::int32_t triangle, std::int32_t from, int /*turn*/) {
      for (std::size_t k = 0; k < components(); ++k) values_[place(triangle, k)] = old()[place(from, k)];
    });
  }

  void take(const Lineage::Change& change, const Overlaps& overlaps) override {
    for (const Overlap& o : overlaps.found.overlaps)
      for (std::size_t k = 0; k < components(); ++k) {
        const double from = old()[place(change.old_number[o.old_triangle], k)];
        values_[place(change.new_number[o.new_triangle], k)] += from * o.area * overlaps.correction[o.old_triangle];
      }
  }

  void end(const Lineage::Change& change) override {
    for (const TriangleId t : ids_of(change.new_number))
      if (change.new_number[t] != kNone && !change.stays(t))
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
class AtCorners final : public FieldTransfer {
 public:
  AtCorners(const Lineage& lineage, const Field& field)
      : FieldTransfer(lineage, field), values_(3 * lineage.new_triangles() * components()) {}

  void begin(const Lineage::Change& change) override {
    visit_same_triangles(change, [&](std::int32_t triangle, std::int32_t from, int turn) {
      for (int i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < components(); ++k)
          values_[place(triangle, i, k)] = old()[place(from, (i + turn) % 3, k)];
    });
  }

  void take(const Lineage::Change& change, const Overlaps& overlaps) override {
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

}  // namespace

std::unique_ptr<FieldTransfer> conserving_at_triangles(const Lineage& lineage, const Field& field) {
  return std::make_unique<AtTriangles>(lineage, field);
}

std::unique_ptr<FieldTransfer> conserving_at_corners(const Lineage& lineage, const Field& field) {
  return std::make_unique<AtCorners>(lineage, field);
}

}  // namespace driftmesh::adapt
