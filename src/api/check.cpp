#include "driftmesh/check.hpp"

#include <algorithm>
#include <utility>

#include "api/call.hpp"
#include "api/library_request.hpp"
#include "base/cores.hpp"
#include "driftmesh/repair.hpp"
#include "geometry/box.hpp"
#include "job/check.hpp"
#include "job/domain.hpp"
#include "job/rasters.hpp"
#include "verify/report_text.hpp"
#include "verify/verify.hpp"

namespace driftmesh {
namespace {

/// The request for a mesh as such: how it was made does not matter.
job::Request requirements_of(const MeshOptions& options) {
  const job::Request all = request_of(options);
  job::Request request;
  request.input = all.input;
  request.bounds.angle = all.bounds.angle;
  static_cast<PlainBounds&>(request.bounds) = all.bounds;
  request.sizing = all.sizing;
  request.output.depth = all.output.depth;
  job::check(request, job::kOnePiece);
  return request;
}

/// One, if there is a `size`: the caller's may not be made for more.
std::size_t threads_for(const MeshOptions& options) {
  const bool for_one = options.threads == 0 && options.size && described_field(options.size) == nullptr;
  return for_one ? 1 : to_index(threads_or_cores(options.threads));
}

std::vector<CheckReport::Finding> findings_of(const Findings& found) {
  std::vector<CheckReport::Finding> findings;
  for (const Flaw flaw : first_ids<Flaw>(kFlawCount))
    if (found.count(flaw) > 0) findings.push_back({flaw_name(flaw), found.count(flaw), found.messages(flaw)});
  return findings;
}

CheckReport report_of(const VerifyReport& found, const VerifyOptions& asked) {
  const Quality& quality = found.quality;
  return {.accepted = found.accepted(),
          .findings = findings_of(found.findings),
          .text = report_text(found, asked),
          .verdict = verdict_text(found, asked),
          .points = static_cast<std::int64_t>(found.points),
          .triangles = static_cast<std::int64_t>(found.triangles),
          .subsegments = static_cast<std::int64_t>(found.subsegments),
          .area = found.area,
          .smallest_area = quality.smallest_area,
          .largest_area = quality.largest_area,
          .smallest_angle = quality.smallest_angle,
          .largest_angle = quality.largest_angle,
          .angles = quality.angles,
          .exceptions = static_cast<std::int64_t>(quality.exception_count()),
          .courant = found.step.greatest,
          .triangles_above = static_cast<std::int64_t>(found.step.above)};
}

/// `input`: null, or as the caller has it.
CheckReport check_against(const Mesh& mesh, const Pslg* input, const MeshOptions& options) {
  const job::Request request = requirements_of(options);
  Pslg domain;
  if (input != nullptr) {
    domain = *input;
    static_cast<void>(job::clean_input(request.input, job::input_name(request), domain));
  }
  const FunctionField function(options.size);
  SizeSource source;
  VerifyOptions asked{.min_angle = request.bounds.angle,
                      .plain = request.bounds,
                      .across = {request.sizing.across, 0},
                      .given = request.input.close_channels > 0 ? nullptr : input,
                      .moved = request.input.snap + request.input.simplify,
                      .holes = job::holes_left(request.input),
                      .courant = job::courant_of(request.sizing),
                      .strict_step = request.input.strict,
                      .threads = threads_for(options)};
  job::Rasters rasters = job::rasters_of(request, "");
  const Box box = input != nullptr ? job::box_of(domain) : Box::of(mesh.points);
  open_all(rasters, box, {});
  const std::shared_ptr<const Raster> depth = rasters.depths();
  if (asked.courant.step > 0) asked.depth = depth.get();
  if (const SizeField* described = described_field(options.size)) {
    source = job::exact_size_of(*described, input != nullptr ? &domain : nullptr, Box::of(mesh.points));
    asked.size = source.field.get();
    asked.size_is_compiled = true;
  } else if (options.size) {
    asked.size = &function;
    asked.size_spacing = job::sizing_of(request.sizing, box).spacing;
  }
  return report_of(input != nullptr ? verify(mesh, domain, asked) : verify(mesh, asked), asked);
}

}  // namespace

CheckReport check(const Mesh& mesh, const MeshOptions& options) {
  return in_words_of_library([&] { return check_against(mesh, nullptr, options); });
}

CheckReport check(const Mesh& mesh, const Pslg& input, const MeshOptions& options) {
  return in_words_of_library([&] { return check_against(mesh, &input, options); });
}

}  // namespace driftmesh
