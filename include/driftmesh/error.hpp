#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace driftmesh {

/// Base of all errors that the library throws. `what()` is one complete message: what failed, where, the likely cause
/// and the next step.
///
/// \code
/// try {
///   const driftmesh::Mesh mesh = driftmesh::mesh(driftmesh::read_poly("missing.poly"));
/// } catch (const driftmesh::InputError& error) {
///   std::cerr << error.place().file << " is wrong in line " << error.place().line << ": " << error.what() << '\n';
/// } catch (const driftmesh::Error& error) {
///   std::cerr << error.what() << '\n';  // here: which file, and why it cannot be read
/// }
/// \endcode
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A place in an input file, for messages of the form "file:line: ...". Line 0 means the file as a whole.
struct SourcePlace {
  std::string file;
  std::size_t line = 0;
};

/// The user's input is wrong, and the intent is not clear enough to repair it.
class InputError : public Error {
 public:
  /// Message "file:line: what; next". In `what`, control characters become '?', and what is too long is cut off.
  InputError(const SourcePlace& place, const std::string& what, const std::string& next);
  /// A complete message: several of the above, one per line, the first of them about `first`.
  explicit InputError(const std::string& message, SourcePlace first = {}) : Error(message), place_(std::move(first)) {}

  /// The place of the (first) problem. No file: it is not known, or another rank met the error.
  [[nodiscard]] const SourcePlace& place() const { return place_; }

 private:
  SourcePlace place_;
};

/// A file could not be opened, read, written or renamed. The message names the file and the system's reason.
class FileError : public Error {
 public:
  FileError(const std::string& file, const std::string& what);
  /// A message that is complete already.
  explicit FileError(const std::string& message) : Error(message) {}

  /// The file; empty: it is not known, or another rank met the error.
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
};

/// A limit that the user set or that a data structure has (triangles, memory, depth) was reached.
class LimitError : public Error {
 public:
  using Error::Error;
};

/// The caller cancelled the work (MeshOptions::progress).
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace driftmesh
