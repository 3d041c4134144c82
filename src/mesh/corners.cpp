#include "mesh/corners.hpp"

#include <vector>

#include "mesh/cavity.hpp"
#include "mesh/corner_plan.hpp"
#include "mesh/fixed_corners.hpp"

namespace driftmesh {
namespace {

/// Cuts what is left of a root segment, which begins at `from` on the apex's side: the piece up to the cut becomes a
/// new root, the root keeps the rest. Returns the new vertex, kNone if rounding leaves no room.
VertexId cut_shell_piece(Triangulation& mesh, Cavity& cavity, VertexId from, const CornerPlan::Cut& cut) {
  const RootId root = root_of(cut.end);
  const SubsegmentId rest = mesh.roots[root].tree;
  if (cavity.gather_on(rest, cut.at) != Cavity::Found::kClear) return kNone;
  const VertexId v = mesh.add_vertex(cut.at, kShellEnd + cut.circle);
  const RootId shell = mesh.add_root(from, v, mesh.roots[root].marker, cut.shell);
  const SubsegmentId piece = mesh.roots[shell].tree;
  Subsegment& s = mesh.subsegments[rest];
  const bool at_start = s.vertex[0] == from;
  s.vertex[at_start ? 0 : 1] = v;
  mesh.roots[root].vertex = s.vertex;
  cavity.fill_on(v, at_start ? piece : rest, at_start ? rest : piece);
  return v;
}

/// Turns the rest of a root segment into a shell piece, directed away from the apex like all of them.
void make_shell_piece(Triangulation& mesh, VertexId from, const CornerPlan::TipPiece& tip) {
  RootSegment& root = mesh.roots[root_of(tip.end)];
  root.shell = tip.shell;
  if (root.vertex[0] != from) mesh.turn_around(root_of(tip.end));
}

}  // namespace

bool may_split(const Triangulation& mesh, SubsegmentId s, InsertionRules::Split split) {
  if (split != InsertionRules::Split::kInside) return split == InsertionRules::Split::kEverywhere;
  const auto& half = mesh.subsegments[s].half;
  return half[0] != kNone && half[1] != kNone;
}

std::int32_t prepare_corners(Triangulation& mesh, const CornerUse& use) {
  return prepare_corners(mesh, use, {});
}

std::int32_t prepare_corners(Triangulation& mesh, const CornerUse& use, const IdVector<RootId, bool>& fixed) {
  const CornerPlan plan = plan_corners(mesh, use, fixed);
  const auto free = [&](SegmentEnd end) { return may_split(mesh, mesh.roots[root_of(end)].tree, use.rules.split); };
  IdVector<SegmentEnd, VertexId> reached;  // from each end
  for (const RootSegment& root : mesh.roots) reached.insert(reached.end(), root.vertex.begin(), root.vertex.end());
  Cavity cavity(mesh);
  std::int64_t room = use.rules.most_points;
  for (const CornerPlan::Cut& cut : plan.cuts) {
    if (!free(cut.end)) continue;
    if (room-- <= 0) return plan.clusters;
    VertexId& from = reached[cut.end];
    if (const VertexId v = cut_shell_piece(mesh, cavity, from, cut); v != kNone) from = v;
  }
  for (const CornerPlan::TipPiece& tip : plan.tips)
    if (free(tip.end)) make_shell_piece(mesh, reached[tip.end], tip);
  return plan.clusters;
}

bool on_same_shell(const Triangulation& mesh, VertexId u, VertexId v) {
  const VertexOrigin a = mesh.origin[u], b = mesh.origin[v];
  if (is_shell_end(a) && a == b) return true;
  if (!is_midpoint(a) || !is_midpoint(b)) return false;
  const Subsegment& s = mesh.subsegments[halved_by(a)];
  const Subsegment& t = mesh.subsegments[halved_by(b)];
  return s.path == t.path && s.root != t.root && mesh.roots[s.root].shell != kNone &&
         mesh.roots[s.root].shell == mesh.roots[t.root].shell;
}

}  // namespace driftmesh
