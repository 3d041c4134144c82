#include "study/chrome_trace.hpp"

#include "study/decision_log.hpp"
#include "study/json_text.hpp"

namespace driftmesh::study {
namespace {

using config::Json;

void add_names(Json& events, std::size_t ranks) {
  for (std::size_t r = 0; r < ranks; ++r)
    events.push_back({{"ph", "M"},
                      {"name", "thread_name"},
                      {"pid", 0},
                      {"tid", r},
                      {"args", {{"name", "rank " + std::to_string(r)}}}});
}

void add_slice(Json& events, const LoadSample& s) {
  events.push_back({{"ph", "X"},
                    {"name", "refine"},
                    {"pid", 0},
                    {"tid", s.rank},
                    {"ts", kMicro * (s.time - s.worked)},
                    {"dur", kMicro * s.worked},
                    {"args", {{"triangles", s.triangles}, {"to_be_made", s.remaining}}}});
}

/// A move is two events, which need a duration to be visible, and an arrow between them.
void add_move(Json& events, const MoveRecord& m, std::size_t number) {
  const std::string name = "subdomain " + to_string(m.subdomain);
  for (const bool leaves : {true, false}) {
    const Json at = {{"pid", 0}, {"tid", leaves ? m.from : m.to}, {"ts", kMicro * (leaves ? m.left : m.arrived)}};
    Json moment = {{"ph", "X"}, {"name", name + (leaves ? " leaves" : " arrives")}, {"dur", 1}};
    moment["args"] = {{"bytes", m.bytes}};
    Json arrow = {{"ph", leaves ? "s" : "f"}, {"name", "move"}, {"cat", "move"}, {"id", number}};
    if (!leaves) arrow["bp"] = "e";
    moment.update(at);
    arrow.update(at);
    events.push_back(std::move(moment));
    events.push_back(std::move(arrow));
  }
}

void add_deliberation(Json& events, const balancer::Deliberation& considered) {
  events.push_back({{"ph", "i"},
                    {"s", "t"},
                    {"cat", "balance"},
                    {"name", std::string(name_of(considered.subject)) + ": " + name_of(considered.verdict)},
                    {"pid", 0},
                    {"tid", considered.rank},
                    {"ts", kMicro * considered.time},
                    {"args", json_of(considered)}});
}

}  // namespace

std::string chrome_trace(const ClusterRun& run) {
  Json events = Json::array();
  add_names(events, run.ranks.size());
  for (const LoadSample& s : run.samples)
    if (s.worked > 0) add_slice(events, s);
  for (std::size_t i = 0; i < run.moves.size(); ++i) add_move(events, run.moves[i], i);
  for (const balancer::Deliberation& considered : run.deliberations) add_deliberation(events, considered);
  return json_text(Json({{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}}), -1);
}

}  // namespace driftmesh::study
