#include "verify/alternating_rings.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {
namespace {

/// The faces on both sides of a link, the link, and the face that a way over it comes from.
struct Crossing {
  std::int32_t from, to, link;
};

/// Links of which closed ways take any two, and the face around them.
struct LinkRing {
  std::int32_t around;
  std::vector<std::int32_t> links;
};

/// All rings, inner ones before those around them.
class RingSearch {
 public:
  explicit RingSearch(const Arrangement& arrangement)
      : steps_(static_cast<std::size_t>(arrangement.face_count())),
        found_(steps_.size()),
        lowest_(steps_.size()),
        next_(steps_.size()) {
    for (const std::int32_t link : first_ids<std::int32_t>(arrangement.links().size())) {
      const std::int32_t left = arrangement.left_face(link), right = arrangement.right_face(link);
      if (left == right) continue;
      steps_[left].push_back({left, right, link});
      steps_[right].push_back({right, left, link});
    }
  }

  std::vector<LinkRing> run() {
    enter(Arrangement::kUnbounded, -1);
    while (!way_.empty()) {
      const auto [face, entry] = way_.back();
      if (next_[face] < steps_[face].size())
        take(steps_[face][next_[face]++], entry);
      else
        leave();
    }
    return std::move(rings_);
  }

 private:
  struct Stay {
    std::int32_t face, entry;  // by this link
  };

  void enter(std::int32_t face, std::int32_t link) {
    found_[face] = lowest_[face] = ++count_;
    way_.push_back({face, link});
  }

  void take(const Crossing& step, std::int32_t entry) {
    if (step.link == entry) return;
    if (found_[step.to] == 0) {
      links_.push_back(step.link);
      enter(step.to, step.link);
    } else if (found_[step.to] < found_[step.from]) {
      links_.push_back(step.link);
      lowest_[step.from] = std::min(lowest_[step.from], found_[step.to]);
    }
  }

  void leave() {
    const auto [face, entry] = way_.back();
    way_.pop_back();
    if (way_.empty()) return;
    const std::int32_t before = way_.back().face;
    lowest_[before] = std::min(lowest_[before], lowest_[face]);
    if (lowest_[face] < found_[before]) return;
    const auto first = std::find(links_.rbegin(), links_.rend(), entry).base() - 1;
    rings_.push_back({before, {first, links_.end()}});
    links_.erase(first, links_.end());
  }

  std::vector<std::vector<Crossing>> steps_;  // from each face
  std::vector<std::int32_t> found_;           // the number of each face in the order of the search; 0: not found
  std::vector<std::int32_t> lowest_;          // the least that a way from what was found behind each face leads back to
  std::vector<std::size_t> next_;
  std::vector<Stay> way_;
  std::vector<std::int32_t> links_;  // those whose rings are not complete
  std::vector<LinkRing> rings_;
  std::int32_t count_ = 0;
};

bool is_even(const Arrangement& arrangement, const LinkRing& ring) {
  std::vector<std::int32_t> ends;
  for (const std::int32_t link : ring.links)
    for (const std::int32_t end : {arrangement.links()[link].a, arrangement.links()[link].b}) ends.push_back(end);
  std::ranges::sort(ends);
  for (auto first = ends.begin(); first != ends.end();) {
    const auto last = std::find_if(first, ends.end(), [&](std::int32_t end) { return end != *first; });
    if ((last - first) % 2 != 0) return false;
    first = last;
  }
  return true;
}

/// Counts the rings around each face, from outer rings to inner ones.
class Count {
 public:
  explicit Count(const Arrangement& arrangement)
      : arrangement_(arrangement), odd_(static_cast<std::size_t>(arrangement.face_count())) {}

  void add(const LinkRing& ring) {
    const char around = odd_[ring.around];
    std::vector<std::int32_t> faces;
    for (const std::int32_t link : ring.links)
      for (const std::int32_t face : {arrangement_.left_face(link), arrangement_.right_face(link)})
        if (face != ring.around) faces.push_back(face), odd_[face] = other(around);
    if (is_even(arrangement_, ring)) alternate(ring, around, faces);
  }

  [[nodiscard]] std::vector<char> odd() && { return std::move(odd_); }

 private:
  static char other(char odd) { return odd != 0 ? char{0} : char{1}; }

  /// From the face around a ring over one link after the other.
  void alternate(const LinkRing& ring, char around, std::vector<std::int32_t> faces) {
    std::vector<Crossing> steps;
    for (const std::int32_t link : ring.links) {
      const std::int32_t left = arrangement_.left_face(link), right = arrangement_.right_face(link);
      steps.push_back({left, right, link});
      steps.push_back({right, left, link});
    }
    std::ranges::sort(steps, {}, &Crossing::from);
    std::ranges::sort(faces);
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    std::vector<char> reached(faces.size());
    std::vector<std::pair<std::int32_t, char>> stack{{ring.around, around}};
    while (!stack.empty()) {
      const auto [face, odd] = stack.back();
      stack.pop_back();
      for (auto step = std::ranges::lower_bound(steps, face, {}, &Crossing::from);
           step != steps.end() && step->from == face; ++step) {
        if (step->to == ring.around) continue;
        char& known = reached[std::ranges::lower_bound(faces, step->to) - faces.begin()];
        if (known != 0) continue;
        known = 1;
        odd_[step->to] = other(odd);
        stack.emplace_back(step->to, other(odd));
      }
    }
  }

  const Arrangement& arrangement_;
  std::vector<char> odd_;
};

}  // namespace

std::vector<char> inside_of_alternating_rings(const Arrangement& arrangement) {
  const std::vector<LinkRing> rings = RingSearch(arrangement).run();
  Count count(arrangement);
  for (auto ring = rings.rbegin(); ring != rings.rend(); ++ring) count.add(*ring);
  return std::move(count).odd();
}

}  // namespace driftmesh
