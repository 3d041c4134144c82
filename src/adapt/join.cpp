#include "adapt/join.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "adapt/granularity.hpp"
#include "adapt/renumber.hpp"
#include "decompose/glue_subdomains.hpp"
#include "decompose/with_joins.hpp"

namespace driftmesh::adapt {
namespace {

using Groups = IdVector<SubdomainId, SubdomainId>;

IdVector<SubdomainId, double> asked_of(const IdVector<SubdomainId, Demand>& demands) {
  IdVector<SubdomainId, double> asked;
  for (const Demand& demand : demands) asked.push_back(demand.triangles);
  return asked;
}

/// All of a group on one rank.
IdVector<SubdomainId, Rank> together(const IdVector<SubdomainId, Rank>& holders, const Groups& group,
                                     const IdVector<SubdomainId, double>& asked) {
  IdVector<SubdomainId, SubdomainId> largest = group;
  for (const SubdomainId s : ids_of(group))
    if (asked[s] > asked[largest[group[s]]]) largest[group[s]] = s;
  IdVector<SubdomainId, Rank> next;
  for (const SubdomainId s : ids_of(group)) next.push_back(holders[largest[group[s]]]);
  return next;
}

/// Lengths at vertices travel as a field at points.
std::vector<double> as_values(const Generation& generation, const LengthsOfParts& lengths) {
  std::vector<double> values(generation.piece.mesh.points.size());
  for (const SubdomainId s : generation.here)
    for (const VertexId v : ids_of(generation.places[s]))
      if (const std::int32_t place = generation.places[s][v]; place != kNone) values[to_index(place)] = lengths[s][v];
  return values;
}

LengthsOfParts as_lengths(const Generation& generation, const std::vector<double>& values) {
  LengthsOfParts lengths(generation.parts.size());
  for (const SubdomainId s : generation.here)
    for (const std::int32_t place : generation.places[s])
      lengths[s].push_back(place == kNone ? std::numeric_limits<double>::infinity() : values[to_index(place)]);
  return lengths;
}

/// A part in the new decomposition.
struct NewPart {
  Part part;
  Former former;
};

NewPart glued(const Parts& present, std::vector<SubdomainId> members, const JoinedSubdomains& joined, SubdomainId s) {
  if (members.size() == 1) {
    Part part = present[members.front()];
    const Renaming renaming = renaming_of(*part.mesh, joined);
    if (renaming == Renaming::kNumbers)
      part.mesh = std::make_shared<const SubdomainMesh>(renamed_subdomain(*part.mesh, joined));
    if (renaming != Renaming::kRoots) return {std::move(part), {.parts = std::move(members)}};
  }
  std::vector<const SubdomainMesh*> meshes;
  Part part;
  part.density = present[members.front()].density;
  for (const SubdomainId p : members) {
    meshes.push_back(present[p].mesh.get());
    part.asked += present[p].asked;
  }
  GluedSubdomain made = glue_subdomains(meshes, joined, s);
  part.mesh = std::make_shared<const SubdomainMesh>(std::move(made.part));
  if (std::ranges::all_of(members, [&](SubdomainId p) { return present[p].made_for != nullptr; })) {
    Lengths lengths;
    for (const auto& [mesh, v] : made.vertex) lengths.push_back((*present[members[to_index(mesh)]].made_for)[v]);
    part.made_for = std::make_shared<const Lengths>(std::move(lengths));
  }
  return {std::move(part), {std::move(members), std::move(made.vertex), std::move(made.triangle)}};
}

/// All parts of this rank in the new decomposition.
Holding glued(const Held& present, const JoinedSubdomains& joined,
              const IdVector<SubdomainId, std::vector<SubdomainId>>& members,
              const std::function<Generation(Parts)>& assemble, Ranks& ranks) {
  Parts parts(members.size());
  IdVector<SubdomainId, Former> former(members.size());
  ranks.agree([&] {
    for (const SubdomainId s : ids_of(members))
      if (present.generation.is_here(members[s].front())) {
        NewPart made = glued(present.generation.parts, members[s], joined, s);
        parts[s] = std::move(made.part);
        former[s] = std::move(made.former);
      }
  });
  return renumbered(present, assemble(std::move(parts)), former);
}

RunPlan plan_of(const RunPlan& plan, Decomposition decomposition,
                const IdVector<SubdomainId, std::vector<SubdomainId>>& members) {
  RunPlan now = plan;
  now.decomposition = std::move(decomposition);
  now.owners.clear();
  for (const auto& some : members) now.owners.push_back(plan.owners[some.front()]);
  return now;
}

IdVector<SubdomainId, Demand> sums_of(const IdVector<SubdomainId, Demand>& demands,
                                      const IdVector<SubdomainId, SubdomainId>& whole, std::size_t count) {
  IdVector<SubdomainId, Demand> sums(count);
  for (const SubdomainId s : ids_of(demands)) {
    Demand& sum = sums[whole[s]];
    sum.triangles += demands[s].triangles;
    sum.changes += demands[s].changes;
    sum.too_large = sum.too_large || demands[s].too_large;
  }
  return sums;
}

std::vector<std::int32_t> own_numbers(std::size_t count) {
  std::vector<std::int32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace

std::optional<Joined> join_light(
    const Basis& from, std::int32_t shares,
    const std::function<Generation(const Decomposition& decomposition, Parts parts)>& assemble, Ranks& ranks) {
  const Generation& present = from.present.generation;
  const IdVector<SubdomainId, double> asked = asked_of(from.demands);
  const Groups group = light_groups(from.plan.decomposition, asked, shares);
  if (group.empty()) return {};
  JoinedSubdomains joined = with_joins(from.plan.decomposition, group);
  IdVector<SubdomainId, std::vector<SubdomainId>> members(joined.decomposition.size());
  for (const SubdomainId s : ids_of(group)) members[joined.whole[s]].push_back(s);

  std::string lengths = "lengths";
  while (from.present.fields.contains(lengths)) lengths += '_';
  Fields fields = from.present.fields;
  fields[lengths].values = as_values(present, from.wanted.lengths);
  const Stayed all{own_numbers(present.piece.mesh.points.size()), own_numbers(present.piece.mesh.triangles.size())};
  const Held start{present, fields, all};

  const IdVector<SubdomainId, Rank> holders = together(present.holders, group, asked);
  Joined made;
  made.wanted = from.wanted;
  for (const SubdomainId s : ids_of(holders)) made.moved += holders[s] != present.holders[s] ? 1 : 0;
  const auto assemble_joined = [&](Parts parts) { return assemble(joined.decomposition, std::move(parts)); };
  if (made.moved > 0) {
    const auto assemble_moved = [&](Parts parts) { return assemble(from.plan.decomposition, std::move(parts)); };
    made.present = glued(moved(start, holders, assemble_moved, ranks), joined, members, assemble_joined, ranks);
  } else {
    made.present = glued(start, joined, members, assemble_joined, ranks);
  }
  made.wanted.lengths = as_lengths(made.present.generation, made.present.fields.at(lengths).values);
  made.present.fields.erase(lengths);
  made.demands = sums_of(from.demands, joined.whole, members.size());
  for (const SubdomainId s : ids_of(members))
    if (members[s].size() > 1) made.several.push_back(s);
  made.plan = plan_of(from.plan, std::move(joined.decomposition), members);
  made.whole = std::move(joined.whole);
  return made;
}

}  // namespace driftmesh::adapt
