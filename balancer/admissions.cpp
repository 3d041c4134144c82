#include "balancer/admissions.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "balancer/snapshot/deliberation.hpp"
#include "balancer/snapshot/situation.hpp"

namespace driftmesh::balancer {
namespace {

using Stage = Admission::Stage;

}  // namespace

std::vector<Rank> short_of_memory(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                  const std::map<Rank, double>& on_its_way, double givers) {
  std::map<Rank, double> needed;
  for (const Move& move : moves)
    if (const SubdomainLoad* const s = find(snapshot, move.subdomain)) needed[move.destination] += memory_for(*s);
  std::vector<Rank> short_ones;
  for (const auto& [rank, triangles] : needed) {
    const auto coming = on_its_way.find(rank);
    const double before = coming == on_its_way.end() ? 0 : coming->second;
    if (must_ask(snapshot.ranks[rank].free_memory + before, triangles, before, givers)) short_ones.push_back(rank);
  }
  return short_ones;
}

void Admissions::arrived(SubdomainId id) {
  std::erase_if(expected_, [&](const Passage& p) { return p.guest.subdomain == id; });
}

void Admissions::stayed(SubdomainId id) {
  const auto place = std::ranges::find(admitted_, id, [](const Passage& p) { return p.guest.subdomain; });
  if (place != admitted_.end()) returned_.push_back(*place);
}

double Admissions::set_aside() const {
  return std::accumulate(expected_.begin(), expected_.end(), 0.0,
                         [](double sum, const Passage& p) { return sum + p.guest.triangles; });
}

Admissions::Settled Admissions::settle(double free_memory, std::vector<ReportedLoad>& own) {
  Settled settled;
  admitted_.clear();
  for (const Step& step : std::exchange(steps_, {})) switch (step.step.stage) {
      case Stage::kAsk:
        answer(step, free_memory, settled);
        break;
      case Stage::kAnswer:
        follow(step, own, settled);
        break;
      case Stage::kReturn:
        take_back(step, settled);
        break;
    }
  say_returned(settled);
  for (const Passage& p : asked_) take_out(own, p.guest.subdomain);
  return settled;
}

// Whoever fits comes, in the order of the question.
void Admissions::answer(const Step& question, double free_memory, Settled& settled) {
  Admission answer{question.step.round, Stage::kAnswer, {}};
  double left = free_memory - set_aside();
  for (const Admission::Guest& guest : question.step.guests) {
    if (guest.triangles > left) {
      settled.refused = true;
      settled.not_coming.push_back(guest.subdomain);
      continue;
    }
    left -= guest.triangles;
    expected_.push_back({question.source, question.step.round, guest});
    answer.guests.push_back(guest);
  }
  settled.messages.push_back({question.source, std::move(answer)});
}

// It may have been finished since, given away, or come to need more than was asked for.
void Admissions::follow(const Step& answer, std::vector<ReportedLoad>& own, Settled& settled) {
  constexpr double kMore = 1.05;
  Deliberation followed{.subject = Deliberation::Subject::kAdmission, .verdict = Verdict::kNoMoves};
  std::erase_if(asked_, [&](const Passage& p) {
    if (p.other != answer.source || p.round != answer.step.round) return false;
    const SubdomainId id = p.guest.subdomain;
    const auto load = std::ranges::find(own, id, &ReportedLoad::subdomain);
    const bool admitted =
        std::ranges::find(answer.step.guests, id, &Admission::Guest::subdomain) != answer.step.guests.end();
    const bool fits = load != own.end() && room_for(*load) <= kMore * p.guest.triangles;
    const Verdict verdict = load == own.end() ? Verdict::kGone : admitted && fits ? Verdict::kDone : Verdict::kNoMemory;
    followed.moves.push_back({id, self_, p.other, verdict});
    if (verdict == Verdict::kGone) settled.gone.push_back(id);
    if (verdict == Verdict::kDone) {
      followed.verdict = verdict;
      settled.moves.push_back({id, p.other});
      admitted_.push_back(p);
      take_out(own, id);
    } else if (admitted) {
      returned_.push_back(p);
    }
    return true;
  });
  if (!followed.moves.empty()) note(std::move(followed));
}

void Admissions::take_back(const Step& step, Settled& settled) {
  for (const Admission::Guest& guest : step.step.guests) {
    const auto is_it = [&](const Passage& p) {
      return p.other == step.source && p.round == step.step.round && p.guest.subdomain == guest.subdomain;
    };
    if (std::erase_if(expected_, is_it) > 0) settled.not_coming.push_back(guest.subdomain);
  }
}

void Admissions::say_returned(Settled& settled) {
  for (const Passage& p : std::exchange(returned_, {}))
    settled.messages.push_back({p.other, Admission{p.round, Stage::kReturn, {p.guest}}});
}

std::vector<Outgoing> Admissions::ask(std::span<const Move> moves, std::span<const ReportedLoad> own) {
  std::map<Rank, Admission> questions;
  Deliberation asked{.subject = Deliberation::Subject::kAdmission, .verdict = Verdict::kAsked};
  for (const Move& move : moves) {
    const auto load = std::ranges::find(own, move.subdomain, &ReportedLoad::subdomain);
    if (load == own.end()) continue;
    const auto [question, first] = questions.try_emplace(move.destination);
    if (first) question->second.round = ++round_;
    const Admission::Guest guest{move.subdomain, room_for(*load)};
    question->second.guests.push_back(guest);
    asked_.push_back({move.destination, question->second.round, guest});
    asked.moves.push_back({move.subdomain, self_, move.destination, Verdict::kAsked});
  }
  if (!asked.moves.empty()) note(std::move(asked));
  std::vector<Outgoing> messages;
  for (auto& [rank, question] : questions) messages.push_back({rank, std::move(question)});
  return messages;
}

}  // namespace driftmesh::balancer
