#pragma once

#include <span>

#include "migration/subdomain.hpp"
#include "migration/work.hpp"

namespace driftmesh {

/// The subdomains that one rank holds.
class Subdomains final : public HoldingOf<Subdomain> {
 public:
  /// `context` must outlive the object.
  explicit Subdomains(const SubdomainContext& context) : context_(&context) {}

  /// Makes one that nobody has worked on yet.
  void make(SubdomainId id) { put(Subdomain(id, *context_)); }
  Work& unpack(std::span<const std::byte> packed) override {
    return put(Subdomain::unpack(packed, *context_, Source::kThisRun));
  }

 private:
  const SubdomainContext* context_;
};

}  // namespace driftmesh
