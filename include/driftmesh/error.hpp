#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace driftmesh {

/// Base of every error that a user of the program may see. `what()` is one complete message: what failed, where,
/// the likely cause and the next step. The command line prints it as it is and exits with 1.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A place in an input file, for messages of the form "file:line: ...". Line 0 means the file as a whole.
struct SourcePlace {
  std::string file;
  std::size_t line = 0;
};

/// Something in the user's input is wrong and cannot be repaired with a clear intent.
class InputError : public Error {
 public:
  /// Message "file:line: what; next".
  InputError(const SourcePlace& place, const std::string& what, const std::string& next);
  /// A message that is complete already: several of the above, one a line.
  explicit InputError(const std::string& message) : Error(message) {}
};

/// A file could not be opened, read, written or renamed. The message names the file and the system's reason.
class FileError : public Error {
 public:
  FileError(const std::string& file, const std::string& what);
};

/// A limit that the user set or that the data structure has (triangles, memory, depth) was reached.
class LimitError : public Error {
 public:
  using Error::Error;
};

}  // namespace driftmesh
