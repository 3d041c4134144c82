#include "study/decision_log.hpp"

#include <limits>

#include "study/json_text.hpp"

namespace driftmesh::study {
namespace {

using balancer::Deliberation;
using config::Json;
using Subject = Deliberation::Subject;

Json loads_json(const Deliberation& load) {
  Json loads = Json::array();
  for (const auto& [rank, unused, l] : load.loads)
    loads.push_back({{"rank", rank}, {"speed", l.speed}, {"remaining", l.remaining}, {"doubt", l.doubt}});
  return loads;
}

Json moves_json(const Deliberation& plan) {
  Json moves = Json::array();
  for (const balancer::JudgedMove& m : plan.moves)
    moves.push_back({{"subdomain", m.subdomain}, {"from", m.from}, {"to", m.to}, {"verdict", name_of(m.verdict)}});
  return moves;
}

Json line_of(const Deliberation& considered) {
  Json line = {{"time", considered.time}, {"rank", considered.rank}, {"what", name_of(considered.subject)}};
  line.update(json_of(considered));
  return line;
}

Json line_of(const MoveRecord& move) {
  return {{"time", move.left}, {"rank", move.from},       {"what", "move"},     {"subdomain", move.subdomain},
          {"to", move.to},     {"arrived", move.arrived}, {"bytes", move.bytes}};
}

}  // namespace

config::Json json_of(const Deliberation& considered) {
  Json said = {{"verdict", name_of(considered.verdict)}};
  switch (considered.subject) {
    case Subject::kLoad:
      said.update({{"finish", considered.finish},
                   {"ideal", considered.ideal},
                   {"noise", considered.noise},
                   {"gain", considered.saves},
                   {"loads", loads_json(considered)}});
      break;
    case Subject::kPlan:
      said.update({{"saves", considered.saves}, {"whole", considered.whole}, {"moves", moves_json(considered)}});
      if (considered.border > 0) said["border"] = considered.border;
      break;
    case Subject::kAdvice:
    case Subject::kAdmission:
      said["moves"] = moves_json(considered);
      break;
    case Subject::kRequest:
      said["thief"] = considered.thief;
      if (considered.verdict == balancer::Verdict::kDone) said["giver"] = considered.giver;
      break;
  }
  return said;
}

std::string decision_lines(const ClusterRun& run) {
  std::string lines;
  auto move = run.moves.begin();
  const auto write_moves_before = [&](double time) {
    for (; move != run.moves.end() && move->left < time; ++move) lines += json_text(line_of(*move), -1);
  };
  for (const Deliberation& considered : run.deliberations) {
    write_moves_before(considered.time);
    lines += json_text(line_of(considered), -1);
  }
  write_moves_before(std::numeric_limits<double>::infinity());
  return lines;
}

}  // namespace driftmesh::study
