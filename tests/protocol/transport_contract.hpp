#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "driftmesh/error.hpp"
#include "protocol/rank_step.hpp"
#include "protocol/transport.hpp"
#include "support/id_literals.hpp"

/// The contract of Transport as tests. The tests of an implementation call check_transport_contract with a function
/// that runs a program on all ranks (of this process), each with a fresh transport.
namespace driftmesh::protocol::contract {

using Program = std::function<RankStep(Transport&)>;
using RunProgram = std::function<void(const Program&)>;

/// Bytes that are determined by sender, receiver, and their number between the two.
inline Bytes content(Rank source, Rank destination, std::uint64_t number, std::size_t size) {
  auto state = static_cast<std::uint32_t>(to_int(source) * 1000 + to_int(destination)) * 7919u +
               static_cast<std::uint32_t>(number);
  Bytes bytes(size);
  for (std::byte& byte : bytes) byte = std::byte((state = state * 1664525u + 1013904223u) >> 24);
  return bytes;
}

/// A rank that sends messages of the given sizes to every rank, itself included, and waits for theirs. With `reluctant`
/// it sends all of them before it polls for the first time; otherwise it polls after each.
class Exchange {
 public:
  Exchange(Transport& transport, std::vector<std::size_t> sizes, bool reluctant)
      : transport_(transport), sizes_(std::move(sizes)), reluctant_(reluctant) {
    for (const Rank source : first_ids<Rank>(transport_.ranks()))
      for (std::uint64_t number = 0; number < sizes_.size(); ++number)
        ++expected_[{source, content(source, transport_.rank(), number, sizes_[number])}];
    awaited_ = sizes_.size() * to_index(transport_.ranks());
  }

  StepResult step() {
    if (next_ < sizes_.size()) {
      do {
        for (const Rank to : first_ids<Rank>(transport_.ranks()))
          transport_.send(to, content(transport_.rank(), to, next_, sizes_[next_]));
      } while (++next_ < sizes_.size() && reluctant_);
      if (next_ < sizes_.size()) return take(), StepResult::kBusy;
    }
    if (awaited_ == 0) return StepResult::kFinished;
    return take() ? StepResult::kBusy : StepResult::kIdle;
  }

 private:
  bool take() {
    auto message = transport_.poll();
    if (!message) return false;
    const auto found = expected_.find({message->source, message->bytes});
    const bool due = found != expected_.end() && found->second > 0;
    REQUIRE_MESSAGE(due, "rank ", to_int(transport_.rank()), " got ", message->bytes.size(), " bytes from rank ",
                    to_int(message->source), " that nobody sent, or sent twice");
    --found->second;
    --awaited_;
    return true;
  }

  Transport& transport_;
  std::vector<std::size_t> sizes_;
  bool reluctant_;
  std::size_t next_ = 0;
  std::size_t awaited_ = 0;
  std::map<std::pair<Rank, Bytes>, int> expected_;
};

inline void exchange(const RunProgram& run, const std::vector<std::size_t>& sizes, bool reluctant) {
  run([&](Transport& transport) {
    return [rank = std::make_shared<Exchange>(transport, sizes, reluctant)] { return rank->step(); };
  });
}

inline void every_size_arrives_once_and_unchanged(const RunProgram& run) {
  exchange(run, {0, 1, 7, 0, 512, 4096, 70'000, 1}, false);
}

// Ranks that all send before anyone receives: a send that waits for its receiver never gets past this.
inline void sending_never_waits(const RunProgram& run) {
  exchange(run, std::vector<std::size_t>(20, 20'000), true);
}

inline void many_small_messages(const RunProgram& run) {
  exchange(run, std::vector<std::size_t>(100, 12), false);
}

// A message that travels around the ring: each hop needs the one before, so idle ranks must wake up.
inline void a_message_goes_around(const RunProgram& run) {
  run([](Transport& transport) {
    return [&transport, hops = 0, started = false]() mutable {
      const Rank next = next_in_ring(transport.rank(), transport.ranks());
      if (transport.rank() == 0_rank && !std::exchange(started, true)) transport.send(next, Bytes(1));
      const auto message = transport.poll();
      if (!message) return StepResult::kIdle;
      REQUIRE(next_in_ring(message->source, transport.ranks()) == transport.rank());
      const bool last = ++hops == 50;
      if (!last || transport.rank() != 0_rank) transport.send(next, Bytes(1));
      return last ? StepResult::kFinished : StepResult::kBusy;
    };
  });
}

inline void nothing_comes_of_nothing(const RunProgram& run) {
  run([](Transport& transport) {
    return [&transport, polls = 0]() mutable {
      REQUIRE(!transport.poll());
      return ++polls == 20 ? StepResult::kFinished : StepResult::kBusy;
    };
  });
}

inline void wrong_destinations_are_errors(const RunProgram& run) {
  run([](Transport& transport) {
    return [&transport] {
      REQUIRE(transport.rank() >= 0_rank);
      REQUIRE(transport.rank() < Rank{transport.ranks()});
      CHECK_THROWS_AS(transport.send(Rank{-1}, Bytes(3)), LimitError);
      CHECK_THROWS_AS(transport.send(Rank{transport.ranks()}, Bytes(3)), LimitError);
      return StepResult::kFinished;
    };
  });
}

inline void time_does_not_go_back(const RunProgram& run) {
  run([](Transport& transport) {
    return [&transport, last = transport.now(), steps = 0]() mutable {
      transport.spend(1e-3);
      const double now = transport.now();
      REQUIRE(now >= last);
      last = now;
      return ++steps == 20 ? StepResult::kFinished : StepResult::kBusy;
    };
  });
}

inline void check_transport_contract(const RunProgram& run) {
  every_size_arrives_once_and_unchanged(run);
  sending_never_waits(run);
  many_small_messages(run);
  a_message_goes_around(run);
  nothing_comes_of_nothing(run);
  wrong_destinations_are_errors(run);
  time_does_not_go_back(run);
}

}  // namespace driftmesh::protocol::contract
