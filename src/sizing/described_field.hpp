#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "driftmesh/size_field.hpp"
#include "sizing/make_size_field.hpp"

namespace driftmesh {

/// Sizes that a caller describes, and that are compiled for a domain once it is known, like those of a request. Several
/// threads may ask at once.
class DescribedField final : public SizeField {
 public:
  /// What is asked for, without a domain.
  explicit DescribedField(SizingOptions asked) : asked_(std::move(asked)) {}
  [[nodiscard]] const SizingOptions& asked() const { return asked_; }
  /// Throws InputError if what is asked for depends on a domain.
  [[nodiscard]] double edge_length(const Point& p) const override;

 private:
  SizingOptions asked_;
  mutable std::once_flag is_made_;
  mutable std::unique_ptr<const SizeField> by_itself_;
};

}  // namespace driftmesh
