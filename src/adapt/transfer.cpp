#include "adapt/transfer.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "adapt/field_transfer.hpp"
#include "adapt/interpolate.hpp"

namespace driftmesh::adapt {
namespace {

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
  lineage.visit_parts([&](const Lineage::Change& change) {
    if (stayed != nullptr) note(lineage, change, *stayed);
    for (const auto& transfer : transfers) transfer->begin(change);
    if (any_is_conserved)
      visit_overlaps(change, [&](const Overlaps& overlaps) {
        for (const auto& transfer : transfers) transfer->take(change, overlaps);
      });
    for (const auto& transfer : transfers) transfer->end(change);
  });
  std::vector<std::vector<double>> values;
  for (const auto& transfer : transfers) values.push_back(transfer->values());
  return values;
}

}  // namespace driftmesh::adapt
