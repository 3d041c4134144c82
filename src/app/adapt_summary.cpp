#include "app/adapt_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace driftmesh::app {
namespace {

std::string outline_summary(const patch::Report& report, const AdaptCommand& command) {
  std::string text = "outline        ";
  if (report.gone_edges == 0 && report.pieces == 0)
    text += "the same as before\n";
  else
    text += fmt::format("{} edges gone, {} lines new\n", report.gone_edges, report.pieces);
  if (report.beyond > 0)
    text += fmt::format("beyond         {} new points where the mesh was not before: data of its nearest place\n",
                        report.beyond);
  if (report.other_markers > 0)
    text += fmt::format("markers        {} edges that stay keep theirs, which are others in {}\n", report.other_markers,
                        command.outline);
  return text;
}

std::string unmet_summary(const patch::Unmet& unmet, const patch::Report& report, std::size_t before) {
  const auto kept = static_cast<std::int64_t>(before) - report.gone;
  return fmt::format(
      "kept           {} triangles; {} were too large, {} too dense, {} below the angle, {} not Delaunay\n", kept,
      unmet.too_large, unmet.too_dense, unmet.skinny, unmet.not_delaunay);
}

}  // namespace

std::string adapt_summary(const patch::Remade& remade, const patch::Unmet& unmet, std::size_t before,
                          const AdaptCommand& command, const std::vector<job::StageTime>& stages) {
  const patch::Report& report = remade.report;
  std::string text = unmet.triangles.empty() ? "" : unmet_summary(unmet, report, before);
  text += fmt::format("triangles      {} before, {} now: {} gone, {} made\n", before, remade.mesh.triangles.size(),
                      report.gone, report.made);
  if (!command.outline.empty()) text += outline_summary(report, command);
  text += fmt::format("points         {} gone, {} made\n", report.gone_points, report.new_points);
  if (!command.only.empty() || !command.outline.empty())
    text += fmt::format("margin         {} triangles around {}, up to {:.4g} away\n", report.margin,
                        command.outline.empty() ? "what was asked for" : "what touches it", report.margin_width);
  text += "time          ";
  for (const job::StageTime& stage : stages)
    text += fmt::format(" {} {:.2f} s", stage.name == "read" && !command.outline.empty() ? "read outline" : stage.name,
                        stage.seconds);
  return text + "\nfile           " + command.output + "\n";
}

std::string warning_if_nothing_stays(const patch::Remade& remade, const Box& before, const AdaptCommand& command) {
  const auto stays = [&](std::int32_t v) { return remade.old_points[to_index(v)] >= 0; };
  if (std::ranges::any_of(remade.mesh.triangles, [&](const auto& t) { return std::ranges::count_if(t, stays) > 1; }))
    return {};
  const Box now = Box::of(remade.mesh.points);
  return fmt::format(
      "nothing of the mesh stays in the domain of {}: the mesh was from {:.10g},{:.10g} to {:.10g},{:.10g}, "
      "the domain is from {:.10g},{:.10g} to {:.10g},{:.10g}",
      command.outline, before.low.x, before.low.y, before.high.x, before.high.y, now.low.x, now.low.y, now.high.x,
      now.high.y);
}

}  // namespace driftmesh::app
