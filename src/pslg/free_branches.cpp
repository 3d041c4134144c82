#include "pslg/free_branches.hpp"

#include <cstdint>

#include "driftmesh/id_vector.hpp"

namespace driftmesh {

std::vector<bool> free_branches(const std::vector<Pslg::Segment>& segments, std::size_t points,
                                const std::vector<bool>& may_go) {
  struct Incident {
    std::int32_t count = 0;
    std::int32_t combined = 0;  // by exclusive or: if there is one, this is it
  };
  std::vector<Incident> at(points);
  const auto change = [&](std::int32_t segment, std::int32_t by) {
    for (const std::int32_t end : {segments[segment].a, segments[segment].b}) {
      at[end].count += by;
      at[end].combined ^= segment;
    }
  };
  for (const std::int32_t s : first_ids<std::int32_t>(segments.size()))
    if (segments[s].a != segments[s].b) change(s, 1);
  std::vector<bool> free(segments.size(), false);
  for (std::size_t p = 0; p < points; ++p) {
    auto end = static_cast<std::int32_t>(p);
    while (at[end].count == 1) {
      const std::int32_t s = at[end].combined;
      if (!may_go[to_index(s)]) break;
      free[to_index(s)] = true;
      change(s, -1);
      end = segments[s].a == end ? segments[s].b : segments[s].a;
    }
  }
  return free;
}

}  // namespace driftmesh
