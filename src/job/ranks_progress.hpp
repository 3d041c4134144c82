#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/key_text.hpp"
#include "job/request.hpp"
#include "job/team.hpp"

namespace driftmesh::job {

/// What ranks tell each other while they refine, a few times a second, on a channel of their own: rank 0 learns how
/// many triangles all have, and each rank watches the one before it, rank 0 the last, and names it if it falls silent.
class RanksProgress {
 public:
  /// `left`: says what is left of a run that is given up; empty: nothing. Collective.
  RanksProgress(Team& team, const Request::Patience& patience, std::function<KeyText()> left = {});

  /// If it is time, tells that this rank has so many triangles, and what it is `doing` ("refining subdomain 7"), and
  /// hears of others. Whether there is news to show, on rank 0.
  [[nodiscard]] bool tell(std::int64_t own, const std::string& doing);
  /// Tells it without hearing of others: at once if that is new.
  void tell_now(std::int64_t own, const std::string& doing);
  /// A line about the rank that this one watches: that it has fallen silent, doing what since when and on which host,
  /// at most once in each doubling of its silence, or that it answers again. Empty: nothing new. Throws Error with such
  /// a line when patience is at its end.
  [[nodiscard]] std::string silence();
  /// All triangles; on rank 0.
  [[nodiscard]] std::int64_t triangles() const;

  /// This rank is done with so many. Waits for the rank that it watches, rank 0 for all, and calls `news` when there
  /// may be some. Collective.
  void close(std::int64_t own, const std::function<void()>& news);

 private:
  void hear();
  void note(const std::string& doing);
  void send(std::int64_t own, bool is_done);

  std::unique_ptr<Channel> channel_;
  Rank watched_, watcher_;
  std::string name_;  // of the watched rank, and its host
  Request::Patience patience_;
  std::function<KeyText()> left_;
  std::vector<std::int64_t> triangles_;  // the triangles of each rank
  std::int32_t done_ = 0;                // ranks that rank 0 has heard of
  double told_;                          // when this rank last told
  double heard_;                         // when the watched one was last heard
  double next_line_;                     // the silence at which it is named next
  bool is_named_ = false;
  bool is_done_ = false;               // the watched one
  std::string doing_, watched_doing_;  // with the time of day since when
};

}  // namespace driftmesh::job
