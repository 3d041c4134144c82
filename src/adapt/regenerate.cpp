#include "adapt/regenerate.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "adapt/agree.hpp"
#include "adapt/mend.hpp"
#include "base/bytes.hpp"
#include "base/in_turns.hpp"
#include "mesh/size_bound.hpp"
#include "migration/subdomain.hpp"
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
  [[nodiscard]] RootId root() const { return root_; }
  [[nodiscard]] std::vector<dyadic::Path> has() const { return points_on(part_.mesh, root_); }
  [[nodiscard]] std::vector<dyadic::Path> wants(const Lengths& lengths, double twice_area) const {
    return points_wanted(part_.mesh, root_, lengths, twice_area);
  }

 private:
  const SubdomainMesh& part_;
  RootId root_{};
};

/// What the subdomains of a generation begin with.
class Beginnings {
 public:
  Beginnings(const RunPlan& plan, const Generation& present, const Wanted& wanted,
             const IdVector<SubdomainId, Fate>& fates, std::int32_t threads, Ranks& ranks)
      : decomposition_(plan.decomposition),
        bounds_(plan.bounds),
        present_(present),
        wanted_(wanted),
        fates_(fates),
        keep_(present.parts.size()),
        fields_(present.parts.size()),
        beginnings_(present.parts.size()) {
    bounds_.size = wanted.between;
    for (const GlobalRootId r : ids_of(decomposition_.roots))
      if (is_open(r)) open_.push_back(r);
    ranks.agree([&] {
      for (const GlobalRootId r : open_) want_on(r);
      in_turns(present.here.size(), to_index(threads), [&](std::size_t i) { begin(present.here[i]); });
    });
    hear_of_sides(ranks);
    for (const GlobalRootId r : open_) agree_on(r);
  }

  [[nodiscard]] const IdVector<SubdomainId, Beginning>& all() const { return beginnings_; }
  /// The points on interfaces for subdomains that begin with their outlines.
  [[nodiscard]] PresplitPaths take_paths() { return std::move(points_); }

 private:
  [[nodiscard]] const SubdomainMesh& part(SubdomainId s) const { return *present_.parts[s].mesh; }

  /// Whether an interface of this rank may get other points.
  [[nodiscard]] bool is_open(GlobalRootId r) const {
    const Decomposition::Root& root = decomposition_.roots[r];
    return root.is_interface() && (present_.is_here(root.left) || present_.is_here(root.right)) &&
           (fates_[root.left] != Fate::kKeep || fates_[root.right] != Fate::kKeep);
  }

  /// The points that an interface is to have, as a function of the lengths along it. A side that is mended keeps these,
  /// and beside a side that is kept all that it has.
  void want_on(GlobalRootId r) {
    const Decomposition::Root& root = decomposition_.roots[r];
    const SubdomainId seen = present_.is_here(root.left) ? root.left : root.right;
    std::vector<dyadic::Path>& points = points_[r];
    if (!wanted_.inside.empty()) {
      points = Side(part(seen), r).has();
    } else if (wanted_.between != nullptr) {
      points = presplit_paths(decomposition_, r, bounds_);
      std::ranges::sort(points);
    } else {
      const SizeBounds sizes = bounds_;
      points = Side(part(seen), r)
                   .wants(wanted_.lengths[seen],
                          std::min(sizes.twice_area(root.left_region), sizes.twice_area(root.right_region)));
    }
    const bool one_is_kept = fates_[root.left] == Fate::kKeep || fates_[root.right] == Fate::kKeep;
    for (const SubdomainId s : {root.left, root.right})
      if (fates_[s] == Fate::kMend && present_.is_here(s)) {
        const Side side(part(s), r);
        keep_[s][side.root()] = one_is_kept ? side.has() : points;
      }
  }

  void begin(SubdomainId s) {
    Beginning& beginning = beginnings_[s];
    if (!wanted_.inside.empty()) {
      beginning.size = wanted_.inside[s];
    } else if (wanted_.between == nullptr) {
      fields_[s] = std::make_unique<LinearLengths>(part(s).mesh, wanted_.lengths[s]);
      beginning.size = fields_[s].get();
    } else {
      beginning.size = wanted_.between;
    }
    if (fates_[s] == Fate::kRemake) return;
    beginning.mesh = present_.parts[s].mesh;
    if (wanted_.inside.empty()) beginning.lengths = &wanted_.lengths[s];
    if (fates_[s] == Fate::kKeep) return;
    Mended mended = mend(part(s), *present_.parts[s].made_for, wanted_.lengths[s], bounds_, keep_[s]);
    beginning.mesh = std::move(mended.mesh);
    beginning.open = std::move(mended.open);
  }

  /// The points on an interface with which a side here begins.
  [[nodiscard]] std::vector<dyadic::Path> begins_with(SubdomainId s, GlobalRootId r) const {
    return beginnings_[s].mesh ? Side(*beginnings_[s].mesh, r).has() : std::vector<dyadic::Path>();
  }

  /// The same for sides on other ranks.
  void hear_of_sides(Ranks& ranks) {
    std::map<Rank, ByteWriter> to_others;
    for (const GlobalRootId r : open_) {
      const Decomposition::Root& root = decomposition_.roots[r];
      if (present_.is_here(root.left) == present_.is_here(root.right)) continue;
      const bool left_is_here = present_.is_here(root.left);
      ByteWriter& writer = to_others[present_.holders[left_is_here ? root.right : root.left]];
      writer.value(r);
      writer.array(begins_with(left_is_here ? root.left : root.right, r));
    }
    std::vector<Mail> mail;
    for (auto& [rank, writer] : to_others) mail.push_back({rank, writer.take()});
    for (const Mail& from : ranks.swap(std::move(mail)))
      for (ByteReader reader(from.bytes); !reader.at_end();) {
        const auto r = reader.value<GlobalRootId>();
        reader.array(across_[r]);
      }
  }

  /// It gets the points that it is to have, and those that a side begins with. Sides that lack some are told.
  void agree_on(GlobalRootId r) {
    const Decomposition::Root& root = decomposition_.roots[r];
    std::vector<dyadic::Path>& points = points_[r];
    const std::array<SubdomainId, 2> sides{root.left, root.right};
    std::array<std::vector<dyadic::Path>, 2> had;
    for (const std::size_t i : {0, 1}) {
      had[i] = present_.is_here(sides[i]) ? begins_with(sides[i], r) : across_[r];
      points = united(points, had[i]);
    }
    for (const std::size_t i : {0, 1}) {
      Beginning& beginning = beginnings_[sides[i]];
      if (!beginning.mesh) continue;
      for (const dyadic::Path path : without(points, had[i])) beginning.told.push_back({r, path});
    }
    if (points.empty()) points_.erase(r);
  }

  const Decomposition& decomposition_;
  QualityBounds bounds_;
  const Generation& present_;
  const Wanted& wanted_;
  const IdVector<SubdomainId, Fate>& fates_;
  IdVector<SubdomainId, PointsToKeep> keep_;
  IdVector<SubdomainId, std::unique_ptr<LinearLengths>> fields_;
  std::vector<GlobalRootId> open_;
  std::map<GlobalRootId, std::vector<dyadic::Path>> across_;  // points with which sides on other ranks begin
  PresplitPaths points_;
  IdVector<SubdomainId, Beginning> beginnings_;
};

double work_in(const Demand& demand, Fate fate) {
  if (fate == Fate::kKeep) return 0;
  return fate == Fate::kMend ? demand.changes : demand.triangles;
}

RunPlan plan_of_generation(const RunPlan& first, const Generation& present,
                           const IdVector<SubdomainId, Demand>& demands, const IdVector<SubdomainId, Fate>& fates,
                           std::int32_t threads) {
  RunPlan plan = first;
  for (const SubdomainId s : ids_of(fates)) plan.decomposition.subdomains[s].predicted = work_in(demands[s], fates[s]);
  plan.work.sleep = false;
  plan.presplit = true;
  deal_to_threads(plan, threads, [&](SubdomainId s) { return present.is_here(s); });
  return plan;
}

/// The lengths by which vertices were made, of a mesh that began as another one with the same numbers: for those that
/// are still there the ones by which they were, unless lengths have changed so far that they have been reconsidered.
Lengths lengths_of_making(const Triangulation& mesh, const Lengths& lengths, const Triangulation& before,
                          const Lengths& made_for, bool reconsidered) {
  Lengths all = lengths;
  for (const VertexId v : ids_of(before.points)) {
    if (before.origin[v] == kDeleted || mesh.origin[v] == kDeleted || !(before.points[v] == mesh.points[v])) continue;
    const bool has_changed = lengths[v] < made_for[v] || (reconsidered && lengths[v] > kGrown * made_for[v]);
    if (!has_changed) all[v] = made_for[v];
  }
  return all;
}

/// Mending takes out what is much too dense and leaves what is a little too dense, which adds up.
bool is_too_dense(const Part& part) {
  constexpr double kDense = 1.1;
  return part.density > 0 && static_cast<double>(part.mesh->mesh.live_triangles()) > kDense * part.density * part.asked;
}

/// Memory in which less than half of the slots is in use is slow to work in.
bool is_worn(const Triangulation& mesh) {
  return mesh.free_triangles.size() > mesh.live_triangles();
}

}  // namespace

Fate fate_of(const Part& part, const Demand& demand, double coarsening) {
  if (is_too_dense(part)) return Fate::kRemake;
  if (!demand.too_large && demand.triangles >= (1 - coarsening) * part.asked) return Fate::kKeep;
  const Triangulation& mesh = part.mesh->mesh;
  const double triangles = std::max(demand.triangles, static_cast<double>(mesh.live_triangles()));
  return part.made_for && demand.changes < triangles / 2 && !is_worn(mesh) ? Fate::kMend : Fate::kRemake;
}

Parts regenerate(const RunPlan& first, const Generation& present, const Wanted& wanted,
                 const IdVector<SubdomainId, Demand>& demands, const IdVector<SubdomainId, Fate>& fates,
                 std::int32_t threads, Ranks& ranks, const Hooks& hooks) {
  RunPlan plan = plan_of_generation(first, present, demands, fates, threads);
  Beginnings beginnings(plan, present, wanted, fates, threads, ranks);
  plan.beginnings = &beginnings.all();
  plan.presplit_paths = std::make_shared<const PresplitPaths>(beginnings.take_paths());

  double forecast = 0;
  for (const SubdomainId s : present.here) forecast += plan.decomposition.subdomains[s].predicted;
  RefinementInRounds::Watch watch{.check = hooks.check, .check_all = hooks.check_all};
  if (hooks.progress) watch.progress = [&](std::int64_t triangles) { hooks.progress(triangles, forecast); };
  RefinementInRounds rounds(plan, std::vector<const SizeField*>(to_index(threads)), std::move(watch),
                            HeldOnRanks{ranks, present.holders});
  rounds.run();

  Parts parts = present.parts;
  for (auto& [s, subdomain] : rounds.subdomains()) {
    Part& part = parts[s];
    if (fates[s] != Fate::kKeep) part.asked = demands[s].triangles;
    const std::shared_ptr<const SubdomainMesh>& begun = beginnings.all()[s].mesh;
    if (!subdomain.started()) {  // nothing was left to do
      part.mesh = begun;
      continue;
    }
    Lengths lengths = subdomain.lengths();
    part.mesh = std::make_shared<const SubdomainMesh>(subdomain.take_mesh());
    if (const auto& made_for = present.parts[s].made_for; begun && made_for)
      lengths = lengths_of_making(part.mesh->mesh, lengths, begun->mesh, *made_for, fates[s] == Fate::kMend);
    part.made_for = std::make_shared<const Lengths>(std::move(lengths));
    if (fates[s] == Fate::kRemake)
      part.density = part.asked > 0 ? static_cast<double>(part.mesh->mesh.live_triangles()) / part.asked : 0;
  }
  return parts;
}

}  // namespace driftmesh::adapt
