#pragma once

#include <doctest/doctest.h>

#include <cstddef>

#include "distributed/exchange.hpp"
#include "support/adversarial_network.hpp"

namespace driftmesh::testing {

/// Performs a whole exchange over the network, ranks[r] being rank r, with messages in parts of `part` bytes.
inline void exchange_over(protocol::AdversarialNetwork& network, const IdVector<Rank, Exchange*>& ranks,
                          std::size_t part = ExchangeRunner::kPart) {
  IdVector<Rank, ExchangeRunner> runners;
  for (const Rank r : ids_of(ranks)) runners.emplace_back(network.transport(r), part);
  IdVector<Rank, protocol::RankStep> steps;
  for (const Rank r : ids_of(ranks)) steps.push_back([&, r] { return runners[r].step(*ranks[r]); });
  REQUIRE(network.run(steps).end == protocol::RunEnd::kFinished);
}

}  // namespace driftmesh::testing
