#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "decompose/decomposition.hpp"
#include "decompose/extract_subdomain.hpp"
#include "support/random.hpp"
#include "support/split_points.hpp"

// Changes of decompositions, made apart from those of the program.

namespace driftmesh::testing {

/// A decomposition with fewer subdomains, and which of them each of the old ones is a part of.
struct Merged {
  Decomposition decomposition;
  IdVector<SubdomainId, SubdomainId> parent;
};

/// Makes subdomain `b` a part of `a` < `b`: their common roots are inside it then. The last one gets the number of `b`.
inline Merged merged(const Decomposition& d, SubdomainId a, SubdomainId b) {
  Merged all{d, {}};
  Decomposition& coarse = all.decomposition;
  const auto last = static_cast<SubdomainId>(d.size() - 1);
  for (const SubdomainId s : ids_of(d.subdomains)) all.parent.push_back(s == b ? a : s == last ? b : s);
  for (Decomposition::Root& root : coarse.roots)
    for (SubdomainId* side : {&root.left, &root.right})
      if (*side != kNoSubdomain) *side = all.parent[*side];
  coarse.subdomains[a].area += d.subdomains[b].area;
  coarse.subdomains[a].predicted += d.subdomains[b].predicted;
  coarse.subdomains[b] = b == last ? d.subdomains[a] : d.subdomains[last];
  coarse.subdomains.pop_back();
  coarse.point_begin = {0};
  coarse.point_list.clear();
  for (const SubdomainId s : ids_of(coarse.subdomains)) {
    std::vector<GlobalPointId> inner;
    for (const SubdomainId part : ids_of(all.parent))
      if (all.parent[part] == s)
        inner.insert(inner.end(), d.inner_points_of(part).begin(), d.inner_points_of(part).end());
    std::sort(inner.begin(), inner.end());
    coarse.point_list.insert(coarse.point_list.end(), inner.begin(), inner.end());
    coarse.point_begin.push_back(static_cast<std::int32_t>(coarse.point_list.size()));
  }
  list_roots(coarse);
  return all;
}

struct Broken {
  Decomposition decomposition;
  RenamedRoots renamed;
};

/// Breaks about every `every`th root of the decomposition at points that its meshes have there, some of the new roots
/// in the other direction. Pieces of shells could only be broken all at once (see same_segments.cpp), and are not.
inline Broken broken(const Decomposition& d, const SplitPoints& points, std::uint64_t every, Random& random) {
  Broken all{d, {}};
  Decomposition& now = all.decomposition;
  struct Piece {
    dyadic::Path interval;
    GlobalPointId a, b;
  };
  for (const auto& [name, splits] : points) {
    if (d.roots[name].shell != kNone || splits.empty() || random() % every != 0) continue;
    std::vector<Piece> pieces, whole{{dyadic::kWhole, d.roots[name].a, d.roots[name].b}};
    while (!whole.empty()) {
      const Piece piece = whole.back();
      whole.pop_back();
      const auto split = splits.find(piece.interval);
      if (split == splits.end() || (piece.interval != dyadic::kWhole && random() % 3 == 0)) {
        pieces.push_back(piece);
        continue;
      }
      const GlobalPointId middle = now.points.next_id();
      now.points.push_back(split->second);
      now.origin.push_back(kNone);
      whole.push_back({dyadic::second_half(piece.interval), middle, piece.b});
      whole.push_back({dyadic::first_half(piece.interval), piece.a, middle});
    }
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      Decomposition::Root root = d.roots[name];
      root.a = pieces[k].a;
      root.b = pieces[k].b;
      if (root.a > root.b) root.turn_around();  // the rule of check_decomposition
      const GlobalRootId renamed = k == 0 ? name : now.roots.next_id();
      if (k == 0)
        now.roots[name] = root;
      else
        now.roots.push_back(root);
      all.renamed[name].push_back({pieces[k].interval, renamed});
    }
  }
  list_roots(now);
  return all;
}

}  // namespace driftmesh::testing
