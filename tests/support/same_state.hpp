#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "migration/packed_form.hpp"

// Compares the state of subdomains member by member, so that nothing can be lost on the way without a name. Each
// comparison takes a structure apart by a structured binding of all its members: with a member more it does not
// compile.
namespace driftmesh::testing {

/// The members in which two states differ, as "refiner.made counters.encroaching"; empty if they are the same to the
/// last bit.
class StateDifference {
 public:
  [[nodiscard]] const std::string& words() const { return words_; }

  void compare(const char* name, double a, double b) {
    note(name, std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b));
  }
  template <class T>
  requires(std::integral<T> || std::is_enum_v<T>) void compare(const char* name, T a, T b) { note(name, a == b); }
  void compare(const char* name, const Point& a, const Point& b) {
    const Inside inside(*this, name);
    const auto& [ax, ay] = a;
    const auto& [bx, by] = b;
    compare("x", ax, bx);
    compare("y", ay, by);
  }
  template <class Root>
  void compare(const char* name, const SplitPoint<Root>& a, const SplitPoint<Root>& b) {
    const Inside inside(*this, name);
    const auto& [aroot, apath] = a;
    const auto& [broot, bpath] = b;
    compare("root", aroot, broot);
    compare("path", apath, bpath);
  }
  void compare(const char* name, const Triangle& a, const Triangle& b) {
    const auto& [avertex, aneighbor] = a;
    const auto& [bvertex, bneighbor] = b;
    note(name, avertex == bvertex && aneighbor == bneighbor);
  }
  void compare(const char* name, const Subsegment& a, const Subsegment& b) {
    const auto& [avertex, ahalf, apath, aroot, achild] = a;
    const auto& [bvertex, bhalf, bpath, broot, bchild] = b;
    note(name, avertex == bvertex && ahalf == bhalf && apath == bpath && aroot == broot && achild == bchild);
  }
  void compare(const char* name, const RootSegment& a, const RootSegment& b) {
    const auto& [avertex, amarker, ashell, atree] = a;
    const auto& [bvertex, bmarker, bshell, btree] = b;
    note(name, avertex == bvertex && amarker == bmarker && ashell == bshell && atree == btree);
  }
  void compare(const char* name, const SkinnyBuckets::Entry& a, const SkinnyBuckets::Entry& b) {
    const auto& [atriangle, abucket] = a;
    const auto& [btriangle, bbucket] = b;
    note(name, atriangle == btriangle && abucket == bbucket);
  }
  void compare(const char* name, const RefineCounters& a, const RefineCounters& b) {
    const Inside inside(*this, name);
    const auto& [afree, asegment, adeleted, aencroaching, agiven_up] = a;
    const auto& [bfree, bsegment, bdeleted, bencroaching, bgiven_up] = b;
    compare("free_points", afree, bfree);
    compare("segment_points", asegment, bsegment);
    compare("deleted_points", adeleted, bdeleted);
    compare("encroaching", aencroaching, bencroaching);
    compare("given_up", agiven_up, bgiven_up);
  }
  void compare(const char* name, const Triangulation& a, const Triangulation& b) {
    const Inside inside(*this, name);
    const auto& [atriangles, apoints, aorigin, aregion, asubsegments, aroots, afree_triangles, afree_vertices] = a;
    const auto& [btriangles, bpoints, borigin, bregion, bsubsegments, broots, bfree_triangles, bfree_vertices] = b;
    compare("triangles", atriangles, btriangles);
    compare("points", apoints, bpoints);
    compare("origin", aorigin, borigin);
    compare("region", aregion, bregion);
    compare("subsegments", asubsegments, bsubsegments);
    compare("roots", aroots, broots);
    compare("free_triangles", afree_triangles, bfree_triangles);
    compare("free_vertices", afree_vertices, bfree_vertices);
  }
  void compare(const char* name, const SubdomainMesh& a, const SubdomainMesh& b) {
    const Inside inside(*this, name);
    const auto& [amesh, aroots, apoints] = a;
    const auto& [bmesh, broots, bpoints] = b;
    compare("mesh", amesh, bmesh);
    compare("roots", aroots, broots);
    compare("points", apoints, bpoints);
  }
  void compare(const char* name, const RefinerState& a, const RefinerState& b) {
    const Inside inside(*this, name);
    const auto& [astage, anext, asweep, askinny, adeferred, aunsplittable, amade, asize, amax, acounters] = a;
    const auto& [bstage, bnext, bsweep, bskinny, bdeferred, bunsplittable, bmade, bsize, bmax, bcounters] = b;
    compare("stage", astage, bstage);
    compare("next_segment", anext, bnext);
    note("sweep", asweep.places() == bsweep.places());
    compare("sweep.again", asweep.again(), bsweep.again());
    compare("skinny", askinny.entries(), bskinny.entries());
    compare("deferred", adeferred, bdeferred);
    note("unsplittable", aunsplittable == bunsplittable);
    compare("made", amade, bmade);
    compare("size", asize, bsize);
    compare("max_triangles", amax, bmax);
    compare("counters", acounters, bcounters);
  }
  void compare(const char* name, const DormantMesh& a, const DormantMesh& b) {
    compare(name, a.wake(), b.wake());
    note(name, a.bytes() == b.bytes());
  }
  void compare(const char* name, const DormantBody& a, const DormantBody& b) {
    const Inside inside(*this, name);
    const auto& [amesh, aunsplittable, amax, acounters, aforecast] = a;
    const auto& [bmesh, bunsplittable, bmax, bcounters, bforecast] = b;
    compare("mesh", amesh, bmesh);
    compare("unsplittable", aunsplittable, bunsplittable);
    compare("max_triangles", amax, bmax);
    compare("counters", acounters, bcounters);
    compare("forecast", aforecast, bforecast);
  }
  void compare(const char* name, const SubdomainState::Body& a, const SubdomainState::Body& b) {
    const Inside inside(*this, name);
    const auto& [apart, arefiner, aforecast] = a;
    const auto& [bpart, brefiner, bforecast] = b;
    compare("part", apart, bpart);
    compare("refiner", arefiner, brefiner);
    compare("forecast", aforecast, bforecast);
  }
  void compare(const char* name, const SubdomainState& a, const SubdomainState& b) {
    const Inside inside(*this, name);
    const auto& [aid, arefined, apending, abody, adormant] = a;
    const auto& [bid, brefined, bpending, bbody, bdormant] = b;
    compare("id", aid, bid);
    compare("refined", arefined, brefined);
    compare("pending", apending, bpending);
    compare("body", abody, bbody);
    compare("dormant", adormant, bdormant);
  }
  template <class T>
  void compare(const char* name, const std::optional<T>& a, const std::optional<T>& b) {
    note(name, a.has_value() == b.has_value());
    if (a && b) compare(name, *a, *b);
  }
  template <class Array>
  requires requires(const Array& array) { array.data(); }
  void compare(const char* name, const Array& a, const Array& b) {
    if (a.size() != b.size()) return note(name, false);
    const std::size_t before = words_.size();
    for (std::size_t i = 0; i < a.size() && words_.size() == before; ++i) compare(name, a.data()[i], b.data()[i]);
  }

 private:
  /// The name of a structure, in front of those of its members.
  class Inside {
   public:
    Inside(StateDifference& difference, const std::string& name) : difference_(difference), before_(difference.path_) {
      difference.path_ += name + ".";
    }
    ~Inside() { difference_.path_ = before_; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

   private:
    StateDifference& difference_;
    std::string before_;
  };

  void note(const char* name, bool same) {
    if (!same) words_ += (words_.empty() ? "" : " ") + path_ + name;
  }

  std::string path_, words_;
};

template <class State>
[[nodiscard]] std::string difference(const State& a, const State& b) {
  StateDifference found;
  found.compare("state", a, b);
  return found.words();
}

/// The same state, to be packed.
[[nodiscard]] inline SubdomainView view_of(const SubdomainState& state) {
  SubdomainView view{state.id, state.refined, state.pending, {}, nullptr};
  if (state.body) view.body.emplace(SubdomainView::Body{state.body->part, state.body->refiner, state.body->forecast});
  if (state.dormant) view.dormant = &*state.dormant;
  return view;
}

}  // namespace driftmesh::testing
