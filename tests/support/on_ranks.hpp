#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#include "distributed/ranks.hpp"
#include "protocol/threads/thread_network.hpp"

namespace driftmesh::testing {

/// Calls work(ranks) on each of so many ranks, which are threads, at once.
inline void on_ranks(std::int32_t count, const std::function<void(Ranks&)>& work) {
  protocol::ThreadNetwork network(count);
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
  std::vector<std::thread> threads;
  for (const Rank r : first_ids<Rank>(count))
    threads.emplace_back([&, r] {
      RanksOfTransport ranks(network.transport(r));
      try {
        work(ranks);
      } catch (...) {
        failures[to_index(r)] = std::current_exception();
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace driftmesh::testing
