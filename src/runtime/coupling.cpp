#include "runtime/coupling.hpp"

#include <sstream>
#include <string>

#include "driftmesh/error.hpp"
#include "geometry/midpoint.hpp"

namespace driftmesh {
namespace {

std::string needs_neighbor(const Decomposition& d, SubdomainId id, GlobalRootId border) {
  const Point m = midpoint(d.points[d.roots[border].a], d.points[d.roots[border].b]);
  std::ostringstream message;
  message << "the decoupled method does not suffice: subdomain " << to_string(id)
          << " needs another point on its border near (" << m.x << ", " << m.y
          << "), of which its neighbor would not know, since details there are finer than the bound "
          << "on size; ask for more triangles, a smaller angle or fewer subdomains, or use the coupled method";
  return message.str();
}

class Coupled : public Coupling {
 public:
  explicit Coupled(const Decomposition& decomposition) : decomposition_(decomposition) {}

  std::optional<SubdomainId> to_tell(SubdomainId from, const SplitPoint<GlobalRootId>& split) override {
    return decomposition_.roots[split.root].across_from(from);
  }
  [[nodiscard]] std::int32_t roots() const override { return static_cast<std::int32_t>(decomposition_.roots.size()); }

 private:
  const Decomposition& decomposition_;
};

class Decoupled : public Coupling {
 public:
  explicit Decoupled(const Decomposition& decomposition) : decomposition_(decomposition) {}

  std::optional<SubdomainId> to_tell(SubdomainId from, const SplitPoint<GlobalRootId>& split) override {
    throw Error(needs_neighbor(decomposition_, from, split.root));
  }
  [[nodiscard]] std::int32_t roots() const override { return 0; }

 private:
  const Decomposition& decomposition_;
};

}  // namespace

std::unique_ptr<Coupling> coupling_of(const RunPlan& plan) {
  if (plan.work.decoupled) return std::make_unique<Decoupled>(plan.decomposition);
  return std::make_unique<Coupled>(plan.decomposition);
}

}  // namespace driftmesh
