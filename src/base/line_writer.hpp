#pragma once

#include <charconv>
#include <string>

#include "base/atomic_file.hpp"

namespace driftmesh {

/// Writes lines of fields separated by single blanks. Numbers are the shortest that read back to the same bits.
class LineWriter {
 public:
  explicit LineWriter(AtomicFile& file) : file_(file) {}

  template <class T>
  LineWriter& field(T value) {
    char text[32];  // the longest double, -1.2345678901234567e-123, has 24 characters
    const auto result = std::to_chars(text, text + sizeof text, value);
    if (!line_.empty()) line_ += ' ';
    line_.append(text, result.ptr);
    return *this;
  }
  void end() {
    line_ += '\n';
    file_.write(line_);
    line_.clear();
  }

 private:
  AtomicFile& file_;
  std::string line_;
};

}  // namespace driftmesh
