#pragma once

#include <string>
#include <string_view>

namespace driftmesh {

/// Whether a file's name stands for standard input where it is read, and for standard output where it is written: "-",
/// or "-" with an extension that names the format, as in "-.msh". A file with that name is "./-".
[[nodiscard]] bool is_standard_stream(std::string_view path);

/// Whether `path` is just "-" or "/dev/null", which leave the format to the reader or writer.
[[nodiscard]] inline bool names_no_format(std::string_view path) {
  return path == "-" || path == "/dev/null";
}

/// Occupies those of the descriptors 0, 1 and 2 that the process was started without, so that using them fails.
/// Otherwise the first files that are opened would get them, and printed text would end up in these files. Call it
/// first in main.
void hold_closed_streams();

/// From now on, printed text is discarded.
void mute_standard_output();

/// Whether nothing asked for standard output before: only one file can be written to it.
[[nodiscard]] bool take_standard_output();

/// Prints to standard output, or to standard error if standard output is taken. What is printed may stay in a buffer
/// until flush_standard_output(). Throws FileError.
void print(std::string_view text);
/// Throws FileError, once, if anything that was printed could not be written.
void flush_standard_output();

}  // namespace driftmesh
