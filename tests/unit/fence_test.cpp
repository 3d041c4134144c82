#include "job/fence.hpp"

#include <doctest/doctest.h>

#include <csignal>
#include <vector>

#include "base/noted_signals.hpp"

using namespace driftmesh;
using job::AfterFence;
using job::AtFence;
using Wish = AtFence::Wish;

namespace {

AfterFence after(const std::vector<AtFence>& all) {
  return job::after_fence(all);
}

}  // namespace

TEST_CASE("a round is over when nobody has anything left to do") {
  CHECK(after({{true}}) == AfterFence{.round_is_over = true});
  CHECK(after({{false}}) == AfterFence{});
  CHECK(after({{true}, {false}, {true}}) == AfterFence{});
  CHECK(after({{true}, {true}, {true}}) == AfterFence{.round_is_over = true});
}

TEST_CASE("what one asks for, all do; who ends leaves a checkpoint") {
  CHECK(after({{false}, {false, Wish::kSave}}) == AfterFence{.save = true});
  CHECK(after({{false, Wish::kEnd}, {false, Wish::kSave}, {false}}) == AfterFence{.save = true, .end = true});
  CHECK(after({{true}, {true, Wish::kSave}}) == AfterFence{.save = true, .round_is_over = true});
  CHECK(after({{true, Wish::kEnd}, {true}}) == AfterFence{.save = true, .end = true, .round_is_over = true});
}

TEST_CASE("signals are noted while they are to be, and one request counts once") {
  const NotedSignals signals;
  CHECK_FALSE(NotedSignals::requested());
  CHECK_FALSE(NotedSignals::told_to_end());
  std::raise(SIGUSR1);
  CHECK(NotedSignals::requested());
  CHECK_FALSE(NotedSignals::told_to_end());
  NotedSignals::forget_request();
  CHECK_FALSE(NotedSignals::requested());
  std::raise(SIGTERM);
  CHECK(NotedSignals::told_to_end());
}

TEST_CASE("then they mean what they meant before") {
  static int came = 0;
  struct sigaction own {
  }, before{};
  own.sa_handler = [](int) { ++came; };
  sigaction(SIGUSR1, &own, &before);
  {
    const NotedSignals signals;
    std::raise(SIGUSR1);
  }
  CHECK(came == 0);
  std::raise(SIGUSR1);
  CHECK(came == 1);
  {
    const NotedSignals signals;
    CHECK_FALSE(NotedSignals::requested());
  }
  sigaction(SIGUSR1, &before, nullptr);
}
