#pragma once

#include <cstddef>

namespace driftmesh::mpi_test {

/// MPI handles that this process has made and not given back. A program that is linked with handle_census.cpp counts
/// them, in its libraries too.
struct HandleCensus {
  std::size_t communicators = 0;
  std::size_t requests = 0;  ///< of messages between ranks
  friend bool operator==(const HandleCensus&, const HandleCensus&) = default;
};
[[nodiscard]] HandleCensus handle_census();

}  // namespace driftmesh::mpi_test
