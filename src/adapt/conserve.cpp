#include "adapt/conserve.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "adapt/interpolate.hpp"
#include "adapt/overlaps.hpp"
#include "adapt/sums_at_points.hpp"
#include "base/bytes.hpp"
#include "geometry/triangle_geometry.hpp"

namespace driftmesh::adapt {
namespace {

using Weights = std::array<double, 3>;

double area_of(const Triangulation& mesh, TriangleId t) {
  return signed_area(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
}

/// Points as combinations of the corners of a triangle, not only those inside.
class WeightsIn {
 public:
  WeightsIn(const Triangulation& mesh, TriangleId t)
      : a_(mesh.corner(t, 0)), b_(mesh.corner(t, 1)), c_(mesh.corner(t, 2)), all_(rounded_cross(a_, b_, c_)) {}
  [[nodiscard]] Weights at(const Point& p) const {
    const double at_b = rounded_cross(c_, a_, p) / all_, at_c = rounded_cross(a_, b_, p) / all_;
    return {1 - at_b - at_c, at_b, at_c};
  }

 private:
  const Point &a_, &b_, &c_;
  double all_;
};

/// What an overlap adds to integrals over the new triangle.
class Share {
 public:
  Share(const Overlap& overlap, std::span<const Point> polygon, const Lineage::Change& change, double correction)
      : size_(polygon.size()), in_old_(), in_new_(), areas_() {
    const WeightsIn old_triangle(change.old_mesh, overlap.old_triangle);
    const WeightsIn new_triangle(change.new_mesh, overlap.new_triangle);
    for (std::size_t i = 0; i < size_; ++i) {
      in_old_[i] = old_triangle.at(polygon[i]);
      in_new_[i] = new_triangle.at(polygon[i]);
      if (i >= 2) areas_[i] = correction * signed_area(polygon[0], polygon[i - 1], polygon[i]);
    }
  }

  /// The integrals of the function that is linear in the old triangle, with these values at its corners, times that of
  /// each corner of the new one: exact in each of the triangles around the first corner of the polygon.
  [[nodiscard]] Weights moments(const std::array<double, 3>& at_old) const {
    std::array<double, OverlapList::kMostCorners> value{};
    for (std::size_t i = 0; i < size_; ++i)
      value[i] = in_old_[i][0] * at_old[0] + in_old_[i][1] * at_old[1] + in_old_[i][2] * at_old[2];
    Weights moments{};
    for (std::size_t i = 2; i < size_; ++i) {
      const double all = value[0] + value[i - 1] + value[i];
      for (std::size_t k = 0; k < 3; ++k)
        moments[k] += areas_[i] / 12 *
                      ((all + value[0]) * in_new_[0][k] + (all + value[i - 1]) * in_new_[i - 1][k] +
                       (all + value[i]) * in_new_[i][k]);
    }
    return moments;
  }

 private:
  std::size_t size_;
  std::array<Weights, OverlapList::kMostCorners> in_old_, in_new_;  // the corners of the polygon
  std::array<double, OverlapList::kMostCorners> areas_;             // those of the triangle that ends at each
};

/// What the new triangles of a subdomain overlap of those that are gone.
struct Overlaps {
  OverlapList found;
  IdVector<TriangleId, double>
      correction{};  ///< an old triangle's area over the sum of its overlaps: 1 but for rounding

  /// Other triangles have no overlaps but for rounding. `room`: memory for them.
  Overlaps(const Lineage::Change& change, OverlapList room) : found(std::move(room)) {
    found.overlaps.clear();
    if (change.is_the_same) return;
    IdVector<TriangleId, bool> stays(change.old_mesh.triangles.size(), false);
    for (const TriangleId from : change.same)
      if (from != kNone) stays[from] = true;
    const auto is_new = [&](TriangleId t) { return change.same[t] == kNone; };
    find_overlaps(change.old_mesh, change.new_mesh, is_new, found);
    std::erase_if(found.overlaps, [&](const Overlap& o) { return stays[o.old_triangle]; });
    correction.assign(change.old_mesh.triangles.size(), 0);
    for (const Overlap& o : found.overlaps) correction[o.old_triangle] += o.area;
    for (const TriangleId t : ids_of(change.old_mesh.triangles))
      if (correction[t] > 0) correction[t] = area_of(change.old_mesh, t) / correction[t];
  }
};

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

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// One field on its way to the new mesh.
class OnItsWay {
 public:
  OnItsWay(const Lineage& lineage, const ConservedField& field) : lineage_(lineage), field_(field) {}
  virtual ~OnItsWay() = default;
  OnItsWay(const OnItsWay&) = delete;
  OnItsWay& operator=(const OnItsWay&) = delete;

  /// Takes what a subdomain has of the field; called for several subdomains at once.
  virtual void take(SubdomainId s, const Lineage::Change& change, const Overlaps& overlaps) = 0;
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

/// One value for each triangle, the mean of what it overlaps.
class AtTriangles final : public OnItsWay {
 public:
  AtTriangles(const Lineage& lineage, const ConservedField& field)
      : OnItsWay(lineage, field), values_(lineage.new_triangles() * components()) {
    lineage.visit_same_triangles([&](std::int32_t triangle, std::int32_t from, int /*turn*/) {
      for (std::size_t k = 0; k < components(); ++k) values_[place(triangle, k)] = old()[place(from, k)];
    });
  }

  void take(SubdomainId /*s*/, const Lineage::Change& change, const Overlaps& overlaps) override {
    if (change.is_the_same) return;
    for (const Overlap& o : overlaps.found.overlaps)
      for (std::size_t k = 0; k < components(); ++k) {
        const double from = old()[place(change.old_number[o.old_triangle], k)];
        values_[place(change.new_number[o.new_triangle], k)] += from * o.area * overlaps.correction[o.old_triangle];
      }
    for (const TriangleId t : ids_of(change.new_number))
      if (change.new_number[t] != kNone && change.same[t] == kNone)
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
class AtCorners final : public OnItsWay {
 public:
  AtCorners(const Lineage& lineage, const ConservedField& field)
      : OnItsWay(lineage, field), values_(3 * lineage.new_triangles() * components()) {
    lineage.visit_same_triangles([&](std::int32_t triangle, std::int32_t from, int turn) {
      for (int i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < components(); ++k)
          values_[place(triangle, i, k)] = old()[place(from, (i + turn) % 3, k)];
    });
  }

  void take(SubdomainId /*s*/, const Lineage::Change& change, const Overlaps& overlaps) override {
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

/// Values at points: interpolation, brought closer to the lumped projection (Farrell and others 2009) just as far as
/// conserves the integral, where that moves it in the right direction.
class AtPoints final : public OnItsWay {
 public:
  AtPoints(const Lineage& lineage, const ConservedField& field)
      : OnItsWay(lineage, field), sums_(lineage.after().parts.size()) {}

  void take(SubdomainId s, const Lineage::Change& change, const Overlaps& overlaps) override {
    Sums& sums = sums_[s];
    const std::size_t vertices = change.new_mesh.points.size();
    sums.moments.assign(vertices * components(), 0);
    sums.mass.assign(vertices, 0);
    sums.changed.assign(vertices, false);
    take_triangles(s, change, sums);
    take_overlaps(change, overlaps, sums);
  }

  [[nodiscard]] std::vector<double> values() override {
    SumsAtPoints sums(lineage().after().piece, width());
    for (const SubdomainId s : lineage().after().here) add(s, sums);
    const std::vector<double> sum = sums.take(lineage().ranks());
    std::vector<double> values = interpolated_at_points(lineage(), old(), components());
    correct(sum, values);
    return values;
  }

 private:
  /// The part of a subdomain, at its vertices.
  struct Sums {
    std::vector<double> moments;  ///< integrals of the field with the function of each point
    std::vector<double> mass;     ///< integrals of these functions
    std::vector<bool> changed;    ///< whether a triangle at the point does not stay
  };

  /// All masses, and moments with triangles that stay.
  void take_triangles(SubdomainId s, const Lineage::Change& change, Sums& sums) const {
    for (const TriangleId t : ids_of(change.new_mesh.triangles)) {
      if (!change.new_mesh.triangles[t].alive()) continue;
      const double third = area_of(change.new_mesh, t) / 3;
      const bool stays = change.is_the_same || change.same[t] != kNone;
      for (const VertexId v : change.new_mesh.triangles[t].vertex) {
        sums.mass[to_index(v)] += third;
        if (!stays) {
          sums.changed[to_index(v)] = true;
          continue;
        }
        const std::int32_t from = lineage().old_point_of(s, v);
        for (std::size_t k = 0; k < components(); ++k)
          sums.moments[to_index(v) * components() + k] += third * old()[to_index(from) * components() + k];
      }
    }
  }

  void take_overlaps(const Lineage::Change& change, const Overlaps& overlaps, Sums& sums) const {
    for (const Overlap& o : overlaps.found.overlaps) {
      const auto& from = change.old_mesh.triangles[o.old_triangle].vertex;
      const auto& to = change.new_mesh.triangles[o.new_triangle].vertex;
      const Share share(o, overlaps.found.polygon(o), change, overlaps.correction[o.old_triangle]);
      for (std::size_t k = 0; k < components(); ++k) {
        std::array<double, 3> at{};
        for (int i = 0; i < 3; ++i) at[i] = old()[to_index(change.old_place[from[i]]) * components() + k];
        const Weights more = share.moments(at);
        for (int i = 0; i < 3; ++i) sums.moments[to_index(to[i]) * components() + k] += more[i];
      }
    }
  }

  // At each point: the subdomains where it has changed, its mass, and the moment of each component.
  static constexpr std::size_t kChanged = 0, kMass = 1, kMoments = 2;
  [[nodiscard]] std::size_t width() const { return kMoments + components(); }

  void add(SubdomainId s, SumsAtPoints& all) const {
    const Sums& sums = sums_[s];
    const IdVector<VertexId, std::int32_t>& places = lineage().after().places[s];
    std::vector<double> own(width());
    for (const VertexId v : ids_of(places)) {
      if (places[v] == kNone) continue;
      own[kChanged] = sums.changed[to_index(v)] ? 1 : 0;
      own[kMass] = sums.mass[to_index(v)];
      std::copy_n(sums.moments.begin() + to_index(v) * components(), components(), own.begin() + kMoments);
      all.add(s, places[v], own);
    }
  }

  /// How far the values at the points of a subdomain, or of all, are from the lumped projection, as integrals.
  struct Steps {
    double missing = 0, upward = 0, downward = 0;
    void add(double step) {
      missing += step;
      (step > 0 ? upward : downward) += step;
    }
    void add(const Steps& more) {
      missing += more.missing;
      upward += more.upward;
      downward += more.downward;
    }
    /// The part of each step in the direction of what is missing that makes up for it.
    [[nodiscard]] double share() const {
      const double possible = missing > 0 ? upward : downward;
      return possible == 0 ? 0 : std::clamp(missing / possible, 0.0, 1.0);
    }
  };

  [[nodiscard]] double step_at(const std::vector<double>& sum, std::size_t i, std::size_t k, double value) const {
    const double* const at = &sum[i * width()];
    return at[kMoments + k] - at[kMass] * value;
  }

  /// Of each component, over all points that have changed, subdomain by subdomain. Collective.
  [[nodiscard]] std::vector<Steps> all_steps(const std::vector<double>& sum, const std::vector<double>& values) const {
    const Generation& after = lineage().after();
    ByteWriter own;
    for (const SubdomainId s : after.here) {
      std::vector<Steps> steps(components());
      for (const std::int32_t place : after.places[s]) {
        if (place == kNone || lineage().lowest_at(place) != s || sum[to_index(place) * width() + kChanged] == 0)
          continue;
        for (std::size_t k = 0; k < components(); ++k)
          steps[k].add(step_at(sum, to_index(place), k, values[to_index(place) * components() + k]));
      }
      own.value(s);
      own.array(steps);
    }
    IdVector<SubdomainId, std::vector<Steps>> of_each(after.parts.size());
    for (const Bytes& bytes : lineage().ranks().bytes_of_all(own.take()))
      for (ByteReader reader(bytes); !reader.at_end();) {
        const auto s = reader.value<SubdomainId>();
        reader.array(of_each.at(s));
      }
    std::vector<Steps> all(components());
    for (const std::vector<Steps>& steps : of_each)
      for (std::size_t k = 0; k < components(); ++k) all[k].add(steps.at(k));
    return all;
  }

  /// Moves values at points that have changed toward the lumped projection.
  void correct(const std::vector<double>& sum, std::vector<double>& values) const {
    const std::vector<Steps> all = all_steps(sum, values);
    for (std::size_t i = 0; i < lineage().new_points(); ++i) {
      const double* const at = &sum[i * width()];
      for (std::size_t k = 0; at[kChanged] > 0 && k < components(); ++k) {
        double& value = values[i * components() + k];
        const double step = step_at(sum, i, k, value);
        if ((step > 0) == (all[k].missing > 0)) value += all[k].share() * step / at[kMass];
      }
    }
  }

  IdVector<SubdomainId, Sums> sums_;
};

std::unique_ptr<OnItsWay> on_its_way(const Lineage& lineage, const ConservedField& field) {
  switch (field.place) {
    case FieldPlace::kTriangles:
      return std::make_unique<AtTriangles>(lineage, field);
    case FieldPlace::kCorners:
      return std::make_unique<AtCorners>(lineage, field);
    case FieldPlace::kPoints:
      break;
  }
  return std::make_unique<AtPoints>(lineage, field);
}

}  // namespace

std::vector<std::vector<double>> conserved(const Lineage& lineage, std::span<const ConservedField> fields) {
  std::vector<std::unique_ptr<OnItsWay>> under_way;
  for (const ConservedField& field : fields) under_way.push_back(on_its_way(lineage, field));
  SpareRoom spare;
  if (!fields.empty())
    lineage.visit_parts([&](SubdomainId s, const Lineage::Change& change) {
      Overlaps overlaps(change, spare.take());
      for (const auto& field : under_way) field->take(s, change, overlaps);
      spare.give(std::move(overlaps.found));
    });
  std::vector<std::vector<double>> values;
  for (const auto& field : under_way) values.push_back(field->values());
  return values;
}

}  // namespace driftmesh::adapt
