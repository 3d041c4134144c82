#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "balancer/conduct.hpp"
#include "balancer/snapshot/messages.hpp"

namespace driftmesh::balancer {

/// How many ranks may each send a rank something without asking, if they cannot know of each other: where one planner
/// decides, itself and those that act on its last plan.
inline constexpr double kUnawareGivers = 2;

/// Whether memory is so close that a rank is asked first: what is free there, in triangles, would not do for as much
/// from each of these givers as is needed now and is on its way already.
[[nodiscard]] inline bool must_ask(double free_memory, double needed, double on_its_way = 0,
                                   double givers = kUnawareGivers) {
  return (on_its_way + needed) * givers > free_memory;
}

/// The destinations of `moves` that must be asked first, in ascending order, by what the snapshot knows of their free
/// memory, from which what is on its way to each rank, as the planner knows, has been taken off.
[[nodiscard]] std::vector<Rank> short_of_memory(const LoadSnapshot& snapshot, std::span<const Move> moves,
                                                const std::map<Rank, double>& on_its_way = {},
                                                double givers = kUnawareGivers);

/// One rank's part in asking those that may be short of memory before subdomains go there. A giver asks; the receiver
/// sets memory aside for those it admits, and answers, each question once; the giver hands over what was admitted and
/// is still worth it, and returns the rest, so that nothing stays set aside. While a question is unanswered its
/// subdomains count as gone: nobody plans with them, but they may well be refined here meanwhile.
class Admissions {
 public:
  explicit Admissions(Rank self) : self_(self) {}

  void receive(Rank source, Admission step) { steps_.push_back({source, std::move(step)}); }
  /// A subdomain has come: nothing need be set aside for it any more.
  void arrived(SubdomainId id);
  /// One of the moves that settle() returned could not be made.
  void stayed(SubdomainId id);

  /// Whether settle() has something to do that others wait for.
  [[nodiscard]] bool pressing() const { return !steps_.empty() || !returned_.empty(); }
  /// Whether a question is unanswered, or something is to be said: the run must not end.
  [[nodiscard]] bool waiting() const { return pressing() || !asked_.empty(); }
  /// Triangles for which memory is set aside.
  [[nodiscard]] double set_aside() const;

  /// What came of questions.
  struct Settled {
    std::vector<Move> moves;  ///< admitted: hand these over, now
    std::vector<Outgoing> messages;
    std::vector<SubdomainId> not_coming;  ///< refused here, or returned: they are not to be expected
    bool refused = false;                 ///< some of them for lack of memory
    std::vector<SubdomainId> gone;        ///< finished here meanwhile though asked for
  };
  /// Answers questions, given memory for `free_memory` triangles including what is set aside, and follows answers. What
  /// leaves, or waits for an answer, is removed from `own`.
  [[nodiscard]] Settled settle(double free_memory, std::vector<ReportedLoad>& own);

  /// Asks for `moves` of subdomains in `own`; they must not be asked for already.
  [[nodiscard]] std::vector<Outgoing> ask(std::span<const Move> moves, std::span<const ReportedLoad> own);

 private:
  struct Step {
    Rank source{};
    Admission step;
  };
  /// A subdomain that is to go from one rank to another, by a question of the giver.
  struct Passage {
    Rank other{};  // the receiver, at the giver; the giver, at the receiver
    std::uint32_t round = 0;
    Admission::Guest guest;
  };
  void answer(const Step& question, double free_memory, Settled& settled);
  void follow(const Step& answer, std::vector<ReportedLoad>& own, Settled& settled);
  void take_back(const Step& step, Settled& settled);
  void say_returned(Settled& settled);

  Rank self_;
  std::vector<Step> steps_;                           // not looked at
  std::uint32_t round_ = 0;                           // round of the last question
  std::vector<Passage> asked_, admitted_, returned_;  // here, as the giver
  std::vector<Passage> expected_;                     // here, as the receiver: memory is set aside for these
};

}  // namespace driftmesh::balancer
