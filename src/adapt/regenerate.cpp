#include "adapt/regenerate.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "adapt/agree.hpp"
#include "base/in_turns.hpp"
#include "mesh/size_bound.hpp"
#include "migration/subdomain.hpp"
#include "runtime/plan_run.hpp"
#include "runtime/threads/refinement_in_rounds.hpp"

namespace driftmesh::adapt {
namespace {

/// What a subdomain has on one of its roots, or wants there.
class Side {
 public:
  Side(const SubdomainMesh& part, GlobalRootId root) : part_(part) {
    const auto place = std::ranges::lower_bound(part.roots, root);
    root_ = static_cast<RootId>(place - part.roots.begin());
  }
  [[nodiscard]] std::vector<dyadic::Path> has() const { return points_on(part_.mesh, root_); }
  [[nodiscard]] std::vector<dyadic::Path> wants(const Lengths& lengths, double twice_area) const {
    return points_wanted(part_.mesh, root_, lengths, twice_area);
  }

 private:
  const SubdomainMesh& part_;
  RootId root_{};
};

/// The points that interfaces get before refinement. If both sides are made anew, these are the ones that lengths along
/// the interface ask for; if one of them is kept, these and what it has.
class Agreement {
 public:
  Agreement(const RunPlan& plan, const Parts& present, const Wanted& wanted, const IdVector<SubdomainId, Fate>& fates)
      : decomposition_(plan.decomposition), present_(present), wanted_(wanted), fates_(fates), told_(present.size()) {
    QualityBounds bounds = plan.bounds;
    bounds.size = wanted.between;
    const SizeBounds sizes = bounds;
    for (const GlobalRootId r : ids_of(decomposition_.roots)) {
      const Decomposition::Root& root = decomposition_.roots[r];
      if (root.is_interface() && (is_remade(root.left) || is_remade(root.right))) agree_on(r, bounds, sizes);
    }
  }

  [[nodiscard]] PresplitPaths take_paths() { return std::move(paths_); }
  [[nodiscard]] std::vector<SplitPoint<GlobalRootId>> take_told(SubdomainId s) { return std::move(told_[s]); }

 private:
  [[nodiscard]] bool is_remade(SubdomainId s) const { return fates_[s] == Fate::kRemake; }

  void agree_on(GlobalRootId r, const QualityBounds& bounds, const SizeBounds& sizes) {
    const Decomposition::Root& root = decomposition_.roots[r];
    const Side left(*present_[root.left].mesh, r);
    std::vector<dyadic::Path> points;
    if (wanted_.between != nullptr) {
      points = presplit_paths(decomposition_, r, bounds);
      std::ranges::sort(points);
    } else {
      points = left.wants(wanted_.lengths[root.left],
                          std::min(sizes.twice_area(root.left_region), sizes.twice_area(root.right_region)));
    }
    const bool one_is_kept = !is_remade(root.left) || !is_remade(root.right);
    if (one_is_kept) {
      const std::vector<dyadic::Path> has = left.has();  // as the right side has
      const SubdomainId kept = is_remade(root.left) ? root.right : root.left;
      for (const dyadic::Path path : without(points, has)) told_[kept].push_back({r, path});
      points = united(points, has);
    }
    if (!points.empty()) paths_[r] = std::move(points);
  }

  const Decomposition& decomposition_;
  const Parts& present_;
  const Wanted& wanted_;
  const IdVector<SubdomainId, Fate>& fates_;
  PresplitPaths paths_;
  IdVector<SubdomainId, std::vector<SplitPoint<GlobalRootId>>> told_;
};

/// Gives subdomains to threads in blocks of about equal work. Which thread has which changes nothing but time.
void deal(RunPlan& plan, std::int32_t threads) {
  const double all = std::max(forecast_of(plan), 1.0);
  double before = 0;
  for (const SubdomainId s : ids_of(plan.owners)) {
    plan.owners[s] = static_cast<Rank>(std::min(threads - 1, static_cast<std::int32_t>(before / all * threads)));
    before += plan.decomposition.subdomains[s].predicted;
  }
  if (threads == 1) plan.policy.reset();
  plan.layout = plan.policy ? layout_of(plan, threads) : nullptr;
}

RunPlan plan_of_generation(const RunPlan& first, const IdVector<SubdomainId, Demand>& demands,
                           const IdVector<SubdomainId, Fate>& fates, std::int32_t threads) {
  RunPlan plan = first;
  for (const SubdomainId s : ids_of(fates))
    plan.decomposition.subdomains[s].predicted = fates[s] == Fate::kKeep ? 0 : demands[s].triangles;
  plan.work.sleep = false;
  plan.presplit = true;
  deal(plan, threads);
  return plan;
}

}  // namespace

Fate fate_of(const Part& part, const Demand& demand, double coarsening) {
  return demand.too_large || demand.triangles < (1 - coarsening) * part.asked ? Fate::kRemake : Fate::kKeep;
}

Parts regenerate(const RunPlan& first, const Parts& present, const Wanted& wanted,
                 const IdVector<SubdomainId, Demand>& demands, const IdVector<SubdomainId, Fate>& fates,
                 std::int32_t threads, const Hooks& hooks) {
  RunPlan plan = plan_of_generation(first, demands, fates, threads);
  Agreement agreement(plan, present, wanted, fates);
  plan.presplit_paths = std::make_shared<const PresplitPaths>(agreement.take_paths());

  std::vector<std::unique_ptr<LinearLengths>> fields;
  IdVector<SubdomainId, Beginning> beginnings(present.size());
  for (const SubdomainId s : ids_of(present)) {
    if (wanted.between == nullptr)
      fields.push_back(std::make_unique<LinearLengths>(present[s].mesh->mesh, wanted.lengths[s]));
    beginnings[s].size = wanted.between == nullptr ? fields.back().get() : wanted.between;
    if (fates[s] == Fate::kKeep) beginnings[s].mesh = present[s].mesh;
    beginnings[s].told = agreement.take_told(s);
  }
  plan.beginnings = &beginnings;

  const double forecast = forecast_of(plan);
  RefinementInRounds::Watch watch{.check = hooks.check};
  if (hooks.progress) watch.progress = [&](std::int64_t triangles) { hooks.progress(triangles, forecast); };
  RefinementInRounds rounds(plan, std::vector<const SizeField*>(to_index(threads)), std::move(watch));
  rounds.run();

  Parts parts = present;
  for (auto& [s, subdomain] : rounds.subdomains()) {
    if (subdomain.started()) parts[s].mesh = std::make_shared<const SubdomainMesh>(subdomain.take_mesh());
    if (fates[s] == Fate::kRemake) parts[s].asked = demands[s].triangles;
  }
  return parts;
}

}  // namespace driftmesh::adapt
