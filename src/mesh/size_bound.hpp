#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "driftmesh/size_field.hpp"
#include "geometry/triangle_geometry.hpp"
#include "mesh/bounds.hpp"

namespace driftmesh {

/// A kind of bound on the sizes of triangles, such as areas by region: what it asks for by region, and by place.
/// Whoever refines, forecasts, cuts or presplits asks all kinds together (SizeBounds) and knows none of them.
/// size_bound.cpp has them all; CONTRIBUTING.md says how to add one.
class SizeBound {
 public:
  virtual ~SizeBound() = default;
  SizeBound() = default;
  SizeBound(const SizeBound&) = delete;
  SizeBound& operator=(const SizeBound&) = delete;

  /// The number of region labels (see triangulate) that it tells apart; 1: it asks for the same in all regions.
  [[nodiscard]] virtual std::size_t regions() const { return 1; }
  /// Twice the area of the largest triangle that it allows anywhere in the region with this label.
  [[nodiscard]] virtual double twice_area(std::uint16_t /*region*/) const { return kNoBound; }
  /// The edge lengths that it asks for by place, if it does; null otherwise.
  [[nodiscard]] virtual const SizeField* lengths() const { return nullptr; }
};

using SizeKinds = std::vector<std::shared_ptr<const SizeBound>>;

/// All bounds on the sizes of triangles that apply together: the smallest counts. Cheap to copy. Areas are twice those
/// of triangles.
class SizeBounds {
 public:
  /// Those of the bounds that are given, without a word, since they are a part of them. The size field must outlive it.
  /// Throws Error for what is not a number.
  SizeBounds(const QualityBounds& bounds);
  explicit SizeBounds(SizeKinds kinds);

  /// The same for triangles with `factor` times the area; no mesh made for them has to allow a time step.
  [[nodiscard]] SizeBounds coarser(double factor) const;

  /// Whether there is any bound.
  [[nodiscard]] bool any() const { return by_place() || least_twice_area() < kNoBound; }

  // ---- The time step: its floor comes last, above all bounds on sizes ----

  /// The time step that a finished mesh is to allow; null: none.
  [[nodiscard]] const TimeStep* step() const { return step_; }
  /// Whether a triangle that is larger than the bounds stays as it is for the sake of the time step.
  [[nodiscard]] bool spares(const CornerPoints& corners, double twice_area) const {
    return floor_ != nullptr && twice_area <= twice_area_of_edge(stretch_ * floor_->floor(corners));
  }
  /// Whether deleting vertices for its sake may leave a triangle that is larger than the bounds.
  [[nodiscard]] bool spares_thinned(const CornerPoints& corners, double twice_area) const {
    return floor_ != nullptr && twice_area <= twice_area_of_edge(TimeStep::kThinned * floor_->floor(corners));
  }

  // ---- By region ----

  /// The number of region labels that are told apart, at least 1.
  [[nodiscard]] std::size_t regions() const { return by_region_.size() - 1; }
  /// The bound that holds all over the region with this label; kNoBound if there is none.
  [[nodiscard]] double twice_area(std::size_t region) const { return by_region_[std::min(region, regions())]; }
  [[nodiscard]] double least_twice_area() const;

  // ---- By place: only asked if lengths depend on it. See SizeField for what these mean. ----

  [[nodiscard]] bool by_place() const { return !fields_.empty(); }
  [[nodiscard]] double length_at(const Point& p) const {
    return stretch_ * least_of([&](const SizeField& f) { return f.edge_length(p); });
  }
  /// The least length anywhere; 0: unknown.
  [[nodiscard]] double least_length() const {
    return stretch_ * least_of([](const SizeField& f) { return f.least(); });
  }
  [[nodiscard]] double least_between(const CornerPoints& corners, double at_corners) const {
    return stretch_ * least_of([&](const SizeField& f) { return f.least_between(corners, at_corners / stretch_); });
  }
  [[nodiscard]] bool falls_below(const CornerPoints& corners, double length) const {
    return std::ranges::any_of(fields_, [&](const SizeField* f) { return f->falls_below(corners, length / stretch_); });
  }

 private:
  template <class Length>
  [[nodiscard]] double least_of(const Length& length) const {
    double least = kNoBound;
    for (const SizeField* field : fields_) least = std::min(least, length(*field));
    return least;
  }

  SizeKinds kinds_;
  std::vector<const SizeField*> fields_;  // theirs
  std::vector<double> by_region_;         // the last is that of all labels that no kind names
  double stretch_ = 1;                    // factor on lengths
  const TimeStep* step_ = nullptr;
  const TimeStep* floor_ = nullptr;
};

}  // namespace driftmesh
