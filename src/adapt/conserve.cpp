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
    for (std::size_t k = 0; k < components(); ++k) {
      const double density = old()[place(change.old_number[overlaps.old_triangle], k)] * overlaps.correction;
      for (const Overlap& o : overlaps.list) values_[place(change.new_number[o.new_triangle], k)] += density * o.area;
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
      : FieldTransfer(lineage, field),
        values_(3 * lineage.new_triangles() * components()),
        ranges_(lineage.after().parts.size()) {}

  void begin(const Lineage::Change& change) override {
    ranges_[change.subdomain].resize(change.new_number.size() * components());
    visit_same_triangles(change, [&](std::int32_t triangle, std::int32_t from, int turn) {
      for (int i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < components(); ++k)
          values_[place(triangle, i, k)] = old()[place(from, (i + turn) % 3, k)];
    });
  }

  /// Sums up integrals with the function of each corner where the values will be.
  void take(const Lineage::Change& change, const Overlaps& overlaps) override {
    for (const Overlap& o : overlaps.list) {
      const Share share(overlaps, o, change);
      for (std::size_t k = 0; k < components(); ++k) {
        Range& range = range_of(change, o.new_triangle, k);
        std::array<double, 3> at{};
        for (int i = 0; i < 3; ++i) {
          at[i] = old()[place(change.old_number[overlaps.old_triangle], i, k)];
          range.add(at[i]);
        }
        const Weights more = share.moments(at);
        for (int i = 0; i < 3; ++i) values_[place(change.new_number[o.new_triangle], i, k)] += more[i];
      }
    }
  }

  void end(const Lineage::Change& change) override {
    for (const TriangleId t : ids_of(change.new_number))
      if (change.new_number[t] != kNone && !change.stays(t))
        for (std::size_t k = 0; k < components(); ++k) project(change, t, k);
    ranges_[change.subdomain] = {};
  }

  [[nodiscard]] std::vector<double> values() override { return std::move(values_); }

 private:
  [[nodiscard]] std::size_t place(std::int32_t triangle, int corner, std::size_t k) const {
    return (3 * to_index(triangle) + static_cast<std::size_t>(corner)) * components() + k;
  }
  [[nodiscard]] Range& range_of(const Lineage::Change& change, TriangleId t, std::size_t k) {
    return ranges_[change.subdomain][to_index(t) * components() + k];
  }

  /// Makes values of the integrals of a component in a new triangle.
  void project(const Lineage::Change& change, TriangleId t, std::size_t k) {
    Weights moments{};
    for (int i = 0; i < 3; ++i) moments[i] = values_[place(change.new_number[t], i, k)];
    const Range& range = range_of(change, t, k);
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
  IdVector<SubdomainId, std::vector<Range>> ranges_;  // what each new triangle overlaps, between begin() and end()
};

}  // namespace

std::unique_ptr<FieldTransfer> conserving_at_triangles(const Lineage& lineage, const Field& field) {
  return std::make_unique<AtTriangles>(lineage, field);
}

std::unique_ptr<FieldTransfer> conserving_at_corners(const Lineage& lineage, const Field& field) {
  return std::make_unique<AtCorners>(lineage, field);
}

}  // namespace driftmesh::adapt
