#pragma once

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/transport.hpp"

/// The only part of the protocol that uses MPI. Communicators are given by their Fortran handles (MPI_Comm_c2f), which
/// the MPI standard defines as integers, so that this header does not need mpi.h.
namespace driftmesh::protocol {

/// MPI, from its initialization to its end. One object, made by the main thread before all others. If MPI has already
/// been initialized by other code, that code must also finalize it.
class MpiSession {
 public:
  MpiSession();
  /// The same with the arguments of main, for tests.
  MpiSession(int& argc, char**& argv);
  /// Finalizes MPI, which waits for all ranks. After a failure, call abort instead.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  [[nodiscard]] static int world();  ///< MPI_COMM_WORLD
  /// The rank given to this process by mpirun or a similar launcher, if any; known before MPI is initialized.
  [[nodiscard]] static std::optional<Rank> launched_as();
  /// Name and version of the MPI library: "Open MPI v4.1.4". Works before MPI is initialized.
  [[nodiscard]] static std::string library();
  /// What MPI calls the machine of this process.
  [[nodiscard]] static std::string host();
  /// The number of ranks of the communicator that share this machine's memory. Collective.
  [[nodiscard]] static int ranks_on_this_machine(int communicator);

  /// Prints `message` on stderr and stops all ranks; mpiexec exits with `code`. Without MPI, exits this process alone.
  [[noreturn]] static void abort(const std::string& message, int code = EXIT_FAILURE);

 private:
  bool began_ = false;
};

/// Messages between the ranks of an MPI communicator. Uses its own duplicate, so that its messages and those of other
/// libraries cannot mix. Only collective calls wait for other ranks: construction, broadcast, gather and close.
class MpiTransport final : public Transport {
 public:
  explicit MpiTransport(int communicator);
  /// Without a preceding close(), gives up: messages being sent may or may not arrive. For errors only.
  ~MpiTransport() override;

  [[nodiscard]] Rank rank() const override;
  [[nodiscard]] std::int32_t ranks() const override;
  void send(Rank destination, Bytes bytes) override;
  std::optional<Received> poll() override;
  void idle() override;
  [[nodiscard]] double now() const override;

  /// The `bytes` of rank 0, on every rank. Collective.
  [[nodiscard]] Bytes broadcast(Bytes bytes);
  /// On rank 0 the bytes of every rank; empty elsewhere. Collective. Throws LimitError for more than 2 GiB in total:
  /// for reports, not for meshes.
  [[nodiscard]] std::vector<Bytes> gather(const Bytes& bytes);

  /// Shuts down cleanly: waits until everything sent has been received. Throws ProtocolError if a message has arrived
  /// that was never polled.
  void close();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace driftmesh::protocol
