#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "adapt/field_transfer.hpp"
#include "adapt/interpolate.hpp"
#include "adapt/sums_at_points.hpp"
#include "base/bytes.hpp"

namespace driftmesh::adapt {
namespace {

/// Values at points: interpolation, brought closer to the lumped projection (Farrell and others 2009) just as far as
/// conserves the integral, where that moves it in the right direction.
class AtPoints final : public FieldTransfer {
 public:
  AtPoints(const Lineage& lineage, const Field& field)
      : FieldTransfer(lineage, field),
        between_(lineage, field),
        sums_(lineage.after(), kMoments + field.components),
        of_subdomain_(lineage.after().parts.size()) {}

  void begin(const Lineage::Change& change) override {
    between_.begin(change);
    Sums& sums = of_subdomain_[change.subdomain];
    const std::size_t vertices = change.new_mesh.points.size();
    sums.moments.assign(vertices * components(), 0);
    sums.mass.assign(vertices, 0);
    sums.changed.assign(vertices, false);
    take_triangles(change, sums);
  }

  void take(const Lineage::Change& change, const Overlaps& overlaps) override {
    std::vector<double>& moments = of_subdomain_[change.subdomain].moments;
    const auto& from = change.old_mesh.triangles[overlaps.old_triangle].vertex;
    for (const Overlap& o : overlaps.list) {
      const auto& to = change.new_mesh.triangles[o.new_triangle].vertex;
      const Share share(overlaps, o, change);
      for (std::size_t k = 0; k < components(); ++k) {
        std::array<double, 3> at{};
        for (int i = 0; i < 3; ++i) at[i] = old()[to_index(change.old_place[from[i]]) * components() + k];
        const Weights more = share.moments(at);
        for (int i = 0; i < 3; ++i) moments[to_index(to[i]) * components() + k] += more[i];
      }
    }
  }

  void end(const Lineage::Change& change) override {
    const Sums sums = std::move(of_subdomain_[change.subdomain]);
    std::vector<double> own(width());
    for (const VertexId v : ids_of(change.new_place)) {
      if (change.new_place[v] == kNone) continue;
      own[kChanged] = sums.changed[to_index(v)] ? 1 : 0;
      own[kMass] = sums.mass[to_index(v)];
      std::copy_n(sums.moments.begin() + to_index(v) * components(), components(), own.begin() + kMoments);
      sums_.add(change.subdomain, change.new_place[v], own);
    }
  }

  [[nodiscard]] std::vector<double> values() override {
    const std::vector<double> sum = sums_.take(lineage().ranks());
    std::vector<double> values = between_.values();
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
  void take_triangles(const Lineage::Change& change, Sums& sums) const {
    for (const TriangleId t : ids_of(change.new_mesh.triangles)) {
      if (!change.new_mesh.triangles[t].alive()) continue;
      const double third = area_of(change.new_mesh, t) / 3;
      const bool stays = change.stays(t);
      for (const VertexId v : change.new_mesh.triangles[t].vertex) {
        sums.mass[to_index(v)] += third;
        if (!stays) {
          sums.changed[to_index(v)] = true;
          continue;
        }
        const std::int32_t from = change.old_point_of(v);
        for (std::size_t k = 0; k < components(); ++k)
          sums.moments[to_index(v) * components() + k] += third * old()[to_index(from) * components() + k];
      }
    }
  }

  // At each point: the subdomains where it has changed, its mass, and the moment of each component.
  static constexpr std::size_t kChanged = 0, kMass = 1, kMoments = 2;
  [[nodiscard]] std::size_t width() const { return kMoments + components(); }

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

  Interpolation between_;
  SumsAtPoints sums_;
  IdVector<SubdomainId, Sums> of_subdomain_;  // between begin() and end()
};

}  // namespace

std::unique_ptr<FieldTransfer> conserving_at_points(const Lineage& lineage, const Field& field) {
  return std::make_unique<AtPoints>(lineage, field);
}

}  // namespace driftmesh::adapt
