#pragma once

#include <cstdint>
#include <exception>
#include <string>

#include "base/bytes.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh {

/// The message when memory runs out before a limit stops the work. Like other limits it names an option of the command
/// line, which the library replaces by its own.
inline constexpr const char* kOutOfMemory =
    "out of memory: all that the system or --max-memory allows is in use; allow more, or ask for larger triangles";

/// An error in the form in which a rank sends it to the others, which throw it too.
struct Failure {
  enum class Kind : std::uint8_t { kNothing, kInput, kFile, kLimit, kCancelled, kKey, kOther };
  Kind kind = Kind::kNothing;
  std::string message;
  std::string key{}, next{};  ///< kKey: of the KeyError, whose problem is the message

  void write(ByteWriter& writer) const;
  [[nodiscard]] static Failure read(ByteReader& reader);
};

/// The failure that an exception represents; kNothing for null.
[[nodiscard]] Failure failure_of(const std::exception_ptr& error);

/// The failure with the rank that met it in its message, except for a KeyError. Nothing stays nothing.
[[nodiscard]] Failure met_by(Rank rank, Failure failure);

/// Throws an exception of the failure's kind.
[[noreturn]] void raise(const Failure& failure);

}  // namespace driftmesh
