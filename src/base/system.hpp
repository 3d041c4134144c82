#pragma once

#include <cstdint>
#include <string>

namespace driftmesh {

// What the system tells of itself and of processes, and how signals end this one. Portable builds know less: that is
// said here in brackets.

/// Names within which the numbers of processes mean something: the host's, and that of its namespace of processes, for
/// containers may share folders and even the name of their host. [portable]
[[nodiscard]] std::string host_of_processes();

/// The number of this process. [a random one]
[[nodiscard]] long number_of_process();

/// Whether a process of this host has ended. [never]
[[nodiscard]] bool has_ended(long process);

/// Bytes of memory that the machine has. [16 GB]
[[nodiscard]] std::uint64_t memory_of_machine();

/// From now on the handler is called when SIGINT, SIGTERM, SIGHUP or SIGPIPE ask the process to end. Ignored ones stay
/// ignored, except SIGPIPE. [the first two, which are C++'s]
void call_at_ending_signals(void (*handler)(int));

/// Ends the process as the signal does by itself; within its handler, when that returns.
void end_by(int signal);

}  // namespace driftmesh
