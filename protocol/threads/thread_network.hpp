#pragma once

#include <cstdint>
#include <memory>

#include "protocol/transport.hpp"

namespace driftmesh::protocol {

/// Messages between threads of this process: each thread is a rank. The bytes of a message are not copied.
class ThreadNetwork {
 public:
  explicit ThreadNetwork(std::int32_t ranks);
  ~ThreadNetwork();
  ThreadNetwork(const ThreadNetwork&) = delete;
  ThreadNetwork& operator=(const ThreadNetwork&) = delete;

  /// The transport of a rank, for one thread at a time. The network outlives it.
  [[nodiscard]] Transport& transport(Rank rank);

 private:
  class End;
  IdVector<Rank, std::unique_ptr<End>> ends_;
};

}  // namespace driftmesh::protocol
