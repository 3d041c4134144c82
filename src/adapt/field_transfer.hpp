#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "adapt/lineage.hpp"
#include "adapt/overlap_integrals.hpp"
#include "adapt/transfer.hpp"

namespace driftmesh::adapt {

/// One field on its way to the new mesh. What it is made with outlives it.
class FieldTransfer {
 public:
  FieldTransfer(const Lineage& lineage, const Field& field) : lineage_(lineage), field_(field) {}
  virtual ~FieldTransfer() = default;
  FieldTransfer(const FieldTransfer&) = delete;
  FieldTransfer& operator=(const FieldTransfer&) = delete;

  // What a subdomain has of the field, by one thread at a time; that of several subdomains at once.
  virtual void begin(const Lineage::Change& /*change*/) {}
  /// Called for each old triangle that is gone, if the field is conserved.
  virtual void take(const Lineage::Change& /*change*/, const Overlaps& /*overlaps*/) {}
  virtual void end(const Lineage::Change& /*change*/) {}

  /// The values on the new mesh, once all subdomains have been taken. Collective.
  [[nodiscard]] virtual std::vector<double> values() = 0;

 protected:
  [[nodiscard]] std::size_t components() const { return field_.components; }
  [[nodiscard]] const std::vector<double>& old() const { return field_.values; }
  [[nodiscard]] const Lineage& lineage() const { return lineage_; }

 private:
  const Lineage& lineage_;
  const Field& field_;
};

[[nodiscard]] std::unique_ptr<FieldTransfer> conserving_at_triangles(const Lineage& lineage, const Field& field);
[[nodiscard]] std::unique_ptr<FieldTransfer> conserving_at_corners(const Lineage& lineage, const Field& field);
[[nodiscard]] std::unique_ptr<FieldTransfer> conserving_at_points(const Lineage& lineage, const Field& field);

}  // namespace driftmesh::adapt
