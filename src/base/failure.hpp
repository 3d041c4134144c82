#pragma once

#include <cstdint>
#include <exception>
#include <string>

#include "base/bytes.hpp"
#include "base/key_text.hpp"
#include "driftmesh/ids.hpp"

namespace driftmesh {

/// The message when memory runs out before a limit stops the work.
[[nodiscard]] inline KeyText out_of_memory() {
  return "out of memory: all that the system or {limits.max-memory} allows is in use; allow more, or ask for larger "
         "triangles";
}

/// An error in the form in which a rank sends it to the others, which throw it too.
struct Failure {
  enum class Kind : std::uint8_t { kNothing, kInput, kFile, kLimit, kCancelled, kKey, kOther };
  Kind kind = Kind::kNothing;
  KeyText message;
  std::string key{};  ///< kKey: that of the KeyError, whose problem is the message
  KeyText next{};     ///< kKey: the same

  void write(ByteWriter& writer) const;
  [[nodiscard]] static Failure read(ByteReader& reader);
};

/// The failure that an exception represents; kNothing for null.
[[nodiscard]] Failure failure_of(const std::exception_ptr& error);

/// Its message as a whole.
[[nodiscard]] KeyText text_of(const Failure& failure);

/// The failure with the rank that met it in its message, except for a KeyError. Nothing stays nothing.
[[nodiscard]] Failure met_by(Rank rank, Failure failure);

/// Throws an exception of the failure's kind.
[[noreturn]] void raise(const Failure& failure);

}  // namespace driftmesh
