#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/from_chars.hpp"
#include "driftmesh/error.hpp"
#include "io/byte_cursor.hpp"

namespace driftmesh {

// The two encodings of a .msh file behind one interface, so that each section is read by one function:
//   integer()  an int of the format       size()  a size_t of the format       real()  a double
// Each throws InputError if the file ends or holds something else there.

/// Numbers as bytes.
class BinaryMshInput {
 public:
  explicit BinaryMshInput(ByteCursor& cursor) : cursor_(cursor) {}
  std::int32_t integer() { return cursor_.take<std::int32_t>("a section"); }
  std::uint64_t size() { return cursor_.take<std::uint64_t>("a section"); }
  double real() { return cursor_.take<double>("a section"); }

 private:
  ByteCursor& cursor_;
};

/// Numbers as text separated by blanks.
class TextMshInput {
 public:
  explicit TextMshInput(ByteCursor& cursor) : cursor_(cursor) {}
  std::int32_t integer() { return number<std::int32_t>(); }
  std::uint64_t size() { return number<std::uint64_t>(); }
  double real() { return number<double>(); }

 private:
  template <class Number>
  Number number() {
    cursor_.skip_blanks();
    const std::string_view rest = cursor_.rest();
    Number value{};
    const auto [end, error] = from_chars(rest.data(), rest.data() + rest.size(), value);
    const auto length = static_cast<std::size_t>(end - rest.data());
    if (error != std::errc() || (length < rest.size() && !ByteCursor::is_blank(*end)))
      throw InputError(cursor_.place(),
                       "holds '" + std::string(rest.substr(0, rest.find_first_of(" \r\n\t")).substr(0, 30)) +
                           "' where a number is expected",
                       "the file is damaged or was not written completely");
    (void)cursor_.take_bytes(length, 1, "a number");
    return value;
  }

  ByteCursor& cursor_;
};

}  // namespace driftmesh
