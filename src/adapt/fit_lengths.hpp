#pragma once

#include <cstdint>
#include <span>

#include "adapt/generation.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/adaptive.hpp"
#include "driftmesh/size_field.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh::adapt {

/// What the next generation is to meet, besides other bounds.
struct Wanted {
  LengthsOfParts lengths;              ///< at the vertices of all present parts
  const SizeField* between = nullptr;  ///< sizes in the whole domain; null: lengths are linear on the present triangles
  /// Sizes in parts that are here, instead of all that, where a mesh is as it should be but for subdomains that are
  /// made anew: interfaces keep what points they have. Empty: none. Each for one thread at a time.
  IdVector<SubdomainId, const SizeField*> inside{};
  double scale = 1;  ///< factor that made lengths fit, for AdaptiveOptions::most_triangles
};

/// The lengths that a caller asks for at points, as options want them; where ranks ask for different ones at a point
/// that they share, the shortest. Throws Error, on all ranks, unless there is a positive one for each point of the
/// piece.
[[nodiscard]] Wanted fit_lengths(const Generation& present, const QualityBounds& bounds, const AdaptiveOptions& options,
                                 std::span<const double> lengths, std::int32_t threads, Ranks& ranks);

/// A size field of a caller, as options want it.
class FittedField final : public SizeField {
 public:
  /// The field must outlive it.
  FittedField(const SizeField& field, const AdaptiveOptions& options) : field_(field), options_(options) {}
  void scale(double factor) { scale_ = factor; }

  [[nodiscard]] double edge_length(const Point& p) const override { return fitted(field_.edge_length(p)); }
  [[nodiscard]] bool falls_below(const std::array<Point, 3>& triangle, double length) const override {
    return length > scale_ * options_.shortest && field_.falls_below(triangle, length / scale_);
  }
  [[nodiscard]] double least() const override { return fitted(field_.least()); }
  [[nodiscard]] double least_between(const std::array<Point, 3>& triangle, double at_corners) const override;

 private:
  [[nodiscard]] double fitted(double length) const;

  const SizeField& field_;
  const AdaptiveOptions& options_;
  double scale_ = 1;
};

/// The same for a size field, which is set to the scale that fits. It is asked by this many threads.
[[nodiscard]] Wanted fit_field(const Generation& present, const QualityBounds& bounds, const AdaptiveOptions& options,
                               FittedField& field, std::int32_t threads, Ranks& ranks);

}  // namespace driftmesh::adapt
