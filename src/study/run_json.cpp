#include "study/run_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/value_json.hpp"
#include "driftmesh/version.hpp"
#include "job/key.hpp"
#include "study/json_text.hpp"

namespace driftmesh::study {
namespace {

using config::Json;

constexpr int kVersion = 1;

Json creeks_json(const RunRecord& run) {
  Json list = Json::array();
  for (const Creek& creek : run.creeks)
    list.push_back({{"place", {creek.at.x, creek.at.y}}, {"width", creek.width}, {"length", creek.length}});
  return list;
}

Json closed_json(const ClosedChannels& closed) {
  return {{"channels", closed.channels}, {"area", closed.area}, {"parts", closed.parts}};
}

Json input_json(const RunRecord& run) {
  const RepairReport& r = run.repairs;
  return {{"file", run.input_file},
          {"projection", run.projection},
          {"points", run.input_points},
          {"segments", run.input_segments},
          {"holes", run.input_holes},
          {"regions", run.input_regions},
          {"repairs",
           {{"rounded_points", r.rounded_points.count},
            {"duplicate_points", r.duplicate_points.count},
            {"close_points", r.close_points.count},
            {"zero_length_segments", r.zero_length_segments.count},
            {"duplicate_segments", r.duplicate_segments.count},
            {"points_on_segments", r.points_on_segments.count},
            {"points_close_segments", r.points_close_segments.count},
            {"crossings", r.crossings.count},
            {"overlaps", r.overlaps.count},
            {"collapsed", r.collapsed.count},
            {"largest_move", r.largest_move},
            {"marker_conflicts", r.marker_conflicts.count}}},
          {"simplified", {{"points", run.simplified.points}, {"rings", run.simplified.rings}}},
          {"closed_channels", closed_json(run.closed)},
          {"narrow_creeks", creeks_json(run)},
          {"warnings", run.warnings}};
}

Json mesh_json(const RunRecord& run) {
  return {{"complete", run.complete},
          {"triangles", run.triangles},
          {"vertices", run.vertices},
          {"subsegments", run.subsegments},
          {"acute_corners", run.acute_corners},
          {"free_points_added", run.counters.free_points},
          {"segment_points_added", run.counters.segment_points},
          {"free_points_deleted", run.counters.deleted_points},
          {"encroaching_points_rejected", run.counters.encroaching},
          {"smallest_angle", run.shape.smallest},
          {"largest_angle", run.shape.largest},
          {"angles_by_10_degrees", run.shape.bins},
          {"smallest_area", run.shape.smallest_area},
          {"largest_area", run.shape.largest_area},
          {"total_area", run.shape.total_area},
          {"digest", fmt::format("{:016x}", run.digest)}};
}

Json exceptions_json(const RunRecord& run) {
  Json list = Json::array();
  for (const RunRecord::ExceptionGroup& group : run.exceptions) {
    Json places = Json::array();
    for (const auto& p : group.places) places.push_back({p.at.x, p.at.y});
    Json item = {{"cause", group.cause}, {"triangles", group.count}, {"places", places}};
    if (group.worst_angle < 180) item["worst_angle"] = group.worst_angle;
    list.push_back(item);
  }
  return list;
}

Json step_json(const RunRecord& run) {
  static constexpr std::array kCauses{"short segment", "split segment", "between segments", "angles or sizes"};
  Json causes = Json::array();
  for (std::size_t k = 0; k < run.step.groups.size(); ++k) {
    const auto& group = run.step.groups[k];
    Json places = Json::array();
    for (std::size_t i = 0; i < std::min(group.places.size(), static_cast<std::size_t>(group.count)); ++i)
      places.push_back({group.places[i].at.x, group.places[i].at.y});
    if (group.count > 0) causes.push_back({{"cause", kCauses[k]}, {"triangles", group.count}, {"places", places}});
  }
  return {{"holds", run.request.sizing.courant_step * run.step.least_room},
          {"triangles_above", run.step.misses()},
          {"causes", causes}};
}

Json work_json(const RunRecord& run) {
  Json stages = Json::object();
  for (const job::StageTime& stage : run.stages) stages[stage.name] = stage.seconds;
  return {{"seconds", run.seconds},
          {"seconds_by_stage", stages},
          {"triangles_per_second", run.triangles_per_second()},
          {"forecast_triangles", run.forecast},
          {"peak_bytes_refining", run.peak_refining},
          {"peak_bytes", run.peak}};
}

Json parts_json(const RunRecord& run) {
  Json ranks = Json::array();
  for (const RunRecord::Rank& r : run.ranks)
    ranks.push_back({{"triangles", r.triangles},
                     {"subdomains", r.subdomains},
                     {"seconds",
                      {{"computing", r.times.computing},
                       {"sending", r.times.sending},
                       {"polling", r.times.polling},
                       {"balancing", r.times.balancing},
                       {"idle", r.times.idle}}},
                     {"interface_splits", r.interface_splits},
                     {"splits_sent", r.counters.splits_sent},
                     {"splits_handled", r.counters.splits_handled},
                     {"split_messages_sent", r.counters.batches_sent},
                     {"hand_offs", r.counters.hand_offs},
                     {"hand_off_bytes", r.counters.hand_off_bytes},
                     {"arrivals", r.counters.arrivals},
                     {"forwarded", r.counters.forwarded},
                     {"most_hops", r.counters.most_hops},
                     {"held", r.counters.held},
                     {"peak_bytes", r.peak}});
  Json parts = {{"subdomains", run.subdomains}, {"presplit", run.presplit}, {"ranks", ranks}};
  if (run.rounds > 0) parts["rounds"] = run.rounds;
  return parts;
}

Json files_json(const RunRecord& run) {
  Json list = Json::array();
  for (const RunRecord::File& file : run.files) list.push_back({{"name", file.name}, {"bytes", file.bytes}});
  return list;
}

}  // namespace

std::string run_json(const RunRecord& run) {
  Json record = {{"format", "driftmesh run"},
                 {"version", kVersion},
                 {"program", DRIFTMESH_VERSION},
                 {"command", run.command},
                 {"input", input_json(run)},
                 {"request", config::json_of(run.request, job::kMesh)},
                 {"bounds", {{"min_angle", run.min_angle}, {"max_area", run.max_area}, {"edge_length", run.sizing}}},
                 {"mesh", mesh_json(run)},
                 {"exceptions", exceptions_json(run)},
                 {"work", work_json(run)},
                 {"files", files_json(run)}};
  if (run.request.sizing.courant_step > 0 && run.triangles > 0) record["time_step"] = step_json(run);
  if (!run.ranks.empty()) record["parts"] = parts_json(run);
  if (run.checkpoints.count > 0)
    record["checkpoints"] = {
        {"count", run.checkpoints.count}, {"seconds", run.checkpoints.seconds}, {"bytes", run.checkpoints.bytes}};
  return json_text(record, 2);
}

}  // namespace driftmesh::study
