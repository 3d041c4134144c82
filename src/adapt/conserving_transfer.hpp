#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "adapt/conserve.hpp"
#include "adapt/overlap_integrals.hpp"

namespace driftmesh::adapt {

/// One field on its way to the new mesh.
class ConservingTransfer {
 public:
  ConservingTransfer(const Lineage& lineage, const ConservedField& field) : lineage_(lineage), field_(field) {}
  virtual ~ConservingTransfer() = default;
  ConservingTransfer(const ConservingTransfer&) = delete;
  ConservingTransfer& operator=(const ConservingTransfer&) = delete;

  // What a subdomain has of the field, by one thread at a time; that of several subdomains at once.
  virtual void begin(SubdomainId /*s*/, const Lineage::Change& /*change*/) {}
  /// Called for all overlaps, some at a time, those of a new triangle at once.
  virtual void take(SubdomainId s, const Lineage::Change& change, const Overlaps& overlaps) = 0;
  virtual void end(const Lineage::Change& /*change*/) {}

  /// The values on the new mesh, once all subdomains have been taken.
  [[nodiscard]] virtual std::vector<double> values() = 0;

 protected:
  [[nodiscard]] std::size_t components() const { return field_.components; }
  [[nodiscard]] const std::vector<double>& old() const { return field_.old; }
  [[nodiscard]] const Lineage& lineage() const { return lineage_; }

 private:
  const Lineage& lineage_;
  const ConservedField& field_;
};

/// That of values at points.
[[nodiscard]] std::unique_ptr<ConservingTransfer> conserving_at_points(const Lineage& lineage,
                                                                       const ConservedField& field);

}  // namespace driftmesh::adapt
