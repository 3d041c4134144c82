#include "adapt/transfer.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "adapt/field_transfer.hpp"
#include "adapt/interpolate.hpp"

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

std::unique_ptr<FieldTransfer> transfer_of(const Lineage& lineage, const Field& field) {
  if (field.how == Transfer::kInterpolate) return std::make_unique<Interpolation>(lineage, field);
  switch (field.place) {
    case FieldPlace::kTriangles:
      return conserving_at_triangles(lineage, field);
    case FieldPlace::kCorners:
      return conserving_at_corners(lineage, field);
    case FieldPlace::kPoints:
      break;
  }
  return conserving_at_points(lineage, field);
}

void note(const Lineage& lineage, const Lineage::Change& change, Stayed& stayed) {
  lineage.visit_points(change, [&](std::int32_t point, const Lineage::Source& from) {
    if (from.stays) stayed.points[to_index(point)] = from.point[0];
  });
  visit_same_triangles(change, [&](std::int32_t triangle, std::int32_t old, int /*turn*/) {
    stayed.triangles[to_index(triangle)] = old;
  });
}

}  // namespace

std::vector<std::vector<double>> transferred(const Lineage& lineage, std::span<const Field* const> fields,
                                             Stayed* stayed) {
  std::vector<std::unique_ptr<FieldTransfer>> transfers;
  for (const Field* field : fields) transfers.push_back(transfer_of(lineage, *field));
  const bool any_is_conserved =
      std::any_of(fields.begin(), fields.end(), [](const Field* field) { return field->how == Transfer::kConserve; });
  if (stayed != nullptr) {
    stayed->points.assign(lineage.new_points(), -1);
    stayed->triangles.assign(lineage.new_triangles(), -1);
  }
  SpareRoom spare;
  lineage.visit_parts([&](const Lineage::Change& change) {
    if (stayed != nullptr) note(lineage, change, *stayed);
    for (const auto& transfer : transfers) transfer->begin(change);
    if (any_is_conserved) {
      Overlaps overlaps(change, spare.take());
      while (overlaps.next())
        for (const auto& transfer : transfers) transfer->take(change, overlaps);
      spare.give(std::move(overlaps.found));
    }
    for (const auto& transfer : transfers) transfer->end(change);
  });
  std::vector<std::vector<double>> values;
  for (const auto& transfer : transfers) values.push_back(transfer->values());
  return values;
}

}  // namespace driftmesh::adapt
