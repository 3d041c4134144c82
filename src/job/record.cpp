#include "job/record.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/key_error.hpp"
#include "driftmesh/error.hpp"
#include "job/value.hpp"

namespace driftmesh::job {
namespace {

std::string sizing_words(const Request::Sizing& sizing) {
  std::string words;
  const auto add = [&](const std::string& what) { words += (words.empty() ? "" : ", ") + what; };
  if (!sizing.expression.empty()) add(sizing.expression);
  if (!sizing.background.empty()) add(sizing.background);
  if (!sizing.tree.empty()) add(sizing.tree);
  if (sizing.across > 0) add(std::to_string(sizing.across) + " layers across channels");
  if (sizing.gradation > 0) add("gradation " + shortest_text(sizing.gradation));
  if (sizing.shortest > 0) add("at least " + shortest_text(sizing.shortest));
  if (sizing.longest > 0) add("at most " + shortest_text(sizing.longest));
  if (sizing.courant_step > 0)
    add((words.empty() ? "as a time step of " : "but for a time step of ") + shortest_text(sizing.courant_step) + " s" +
        (words.empty() ? " allows" : ""));
  return words;
}

std::int64_t count_of(std::size_t size) {
  return static_cast<std::int64_t>(size);
}

/// Hole points, and rings of polygons other than the first.
std::size_t holes_in(const Pslg& pslg) {
  std::size_t holes = pslg.holes.size();
  for (const Pslg::Polygon& polygon : pslg.polygons) holes += std::max<std::size_t>(polygon.rings.size(), 1) - 1;
  return holes;
}

}  // namespace

void require_step(const RunRecord& run) {
  if (!run.request.input.strict || run.step.misses() == 0) return;
  const auto seconds = [&](double room) { return shortest_text(run.request.sizing.courant_step * room); };
  throw Keyed<InputError>({run.input_file},
                          "the time step of " + seconds(1) + " s is too long for " + std::to_string(run.step.misses()) +
                              " triangles; one of " + seconds(run.step.least_room) + " s holds",
                          "coarsen the outline with {input.simplify} or {input.snap}, ask for a shorter step, or "
                          "accept it (not strict)");
}

void record_domain(RunRecord& run, const Request& request, const Domain& domain) {
  run.request = request;
  run.input_file = input_name(request);
  run.projection = domain.projection;
  run.input_points = count_of(domain.pslg.points.size());
  run.input_segments = count_of(domain.pslg.segments.size());
  run.input_holes = count_of(holes_in(domain.pslg));
  run.input_regions = count_of(domain.pslg.regions.size());
  run.repairs = domain.repairs;
  run.simplified = domain.simplified;
  run.closed = domain.closed;
  run.creeks = domain.creeks;
  run.min_angle = request.bounds.angle;
  run.sizing = sizing_words(request.sizing);
}

}  // namespace driftmesh::job
