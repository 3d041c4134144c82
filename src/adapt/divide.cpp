#include "adapt/divide.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "adapt/granularity.hpp"
#include "adapt/linear_lengths.hpp"
#include "adapt/of_all_parts.hpp"
#include "adapt/recast.hpp"
#include "base/bytes.hpp"
#include "base/in_turns.hpp"
#include "decompose/further_cut.hpp"

namespace driftmesh::adapt {
namespace {

/// The sizes by which the present mesh was made.
class Sizes {
 public:
  explicit Sizes(const Dividing& how)
      : linear_(how.before.parts.size()), all_(how.before.parts.size(), how.wanted.between) {
    for (const SubdomainId s : how.before.here) {
      if (how.wanted.between != nullptr) continue;
      linear_[s] = std::make_unique<LinearLengths>(how.before.parts[s].mesh->mesh, how.wanted.lengths[s]);
      all_[s] = linear_[s].get();
    }
  }
  [[nodiscard]] const IdVector<SubdomainId, const SizeField*>& all() const { return all_; }

 private:
  IdVector<SubdomainId, std::unique_ptr<LinearLengths>> linear_;
  IdVector<SubdomainId, const SizeField*> all_;
};

/// The cuts of those that can be divided, ascending, on all ranks.
std::vector<FurtherCut> cuts_of(const Generation& present, std::vector<std::pair<SubdomainId, std::int32_t>> heavy,
                                const Dividing& how, const Sizes& sizes, Ranks& ranks) {
  std::erase_if(heavy, [&](const auto& one) { return !present.is_here(one.first); });
  std::vector<std::optional<FurtherCut>> found(heavy.size());
  ranks.agree([&] {
    in_turns(heavy.size(), to_index(how.threads), [&](std::size_t i) {
      const auto& [s, parts] = heavy[i];
      const Part& part = present.parts[s];
      QualityBounds bounds = how.plan.bounds;
      bounds.size = sizes.all()[s];
      found[i] = cut_further(how.plan.decomposition, s, *part.mesh, bounds, part.asked, parts);
    });
  });
  ByteWriter own;
  for (const auto& cut : found)
    if (cut) own.raw(to_bytes(*cut));
  std::vector<FurtherCut> cuts;
  for (const Bytes& bytes : ranks.bytes_of_all(own.take()))
    for (ByteReader reader(bytes); !reader.at_end();) cuts.push_back(further_cut_from(reader));
  std::ranges::sort(cuts, {}, &FurtherCut::whole);
  return cuts;
}

/// Makes those that are cut anew, with the separators inside.
Parts remade(const Generation& present, const IdVector<SubdomainId, double>& asked, const CutFurther& cut,
             const std::vector<FurtherCut>& cuts, const Dividing& how, const Sizes& sizes, Ranks& ranks) {
  const Wanted wanted{.lengths = {}, .between = how.wanted.between, .inside = sizes.all()};
  IdVector<SubdomainId, Fate> fates(present.parts.size(), Fate::kKeep);
  IdVector<SubdomainId, Demand> demands(present.parts.size());
  for (const FurtherCut& one : cuts) {
    fates[one.whole] = Fate::kRemake;
    demands[one.whole] = {.triangles = asked[one.whole], .too_large = true, .changes = asked[one.whole]};
  }
  RunPlan plan = how.plan;
  plan.decomposition = cut.with_separators;
  Hooks hooks = how.hooks;
  hooks.progress = {};
  return regenerate(plan, present, wanted, demands, fates, how.threads, ranks, hooks);
}

}  // namespace

std::optional<Divided> divide_heavy(const Parts& parts, const Dividing& how, Ranks& ranks) {
  const auto asked = of_all_parts(ranks, how.before, [&](SubdomainId s) { return parts[s].asked; });
  const auto heavy = heavy_ones(asked, how.shares);
  if (heavy.empty()) return {};
  Generation present;  // without a piece
  present.parts = parts;
  present.here = how.before.here;
  present.holders = how.before.holders;
  const Sizes sizes(how);
  const std::vector<FurtherCut> cuts = cuts_of(present, heavy, how, sizes, ranks);
  if (cuts.empty()) return {};
  CutFurther cut = with_cuts(how.plan.decomposition, cuts);
  const auto same = ids_of(parts);
  ranks.agree([&] { present.parts = recast(parts, cut.renamed, cut.broken, {same.begin(), same.end()}); });
  Parts made = remade(present, asked, cut, cuts, how, sizes, ranks);
  return Divided{std::move(made), std::move(cut)};
}

}  // namespace driftmesh::adapt
