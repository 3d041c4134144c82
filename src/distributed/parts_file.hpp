#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "distributed/ranks.hpp"
#include "driftmesh/id_vector.hpp"
#include "driftmesh/ids.hpp"
#include "io/hdf5_bytes.hpp"

namespace driftmesh {

/// A kind of file in which ranks keep what they have of a mesh in subdomains.
struct PartsFormat {
  const char* head;      ///< the name of the array that tells the kind from others
  std::int64_t version;  ///< that is written and read
  const char* what;      ///< "an adaptive mesh"
  const char* use;       ///< what such a file is for: "load it with ..."
  const char* source;    ///< what writes one
};
inline constexpr PartsFormat kAdaptiveMeshFile{"session", 2, "an adaptive mesh", "load it with AdaptiveMesh::load",
                                               "save() of one or driftmesh mesh --save"};
inline constexpr PartsFormat kCheckpointFile{"run", 1, "a checkpoint", "go on with driftmesh mesh --resume",
                                             "driftmesh mesh --checkpoint"};

/// Writes one HDF5 file: what rank 0 has in `heads`, by the names of their arrays, and a part for each of `count`
/// subdomains, from the rank that has it. All is sealed with checksums. `own`: the bytes that the parts of this rank
/// have; part(s) is called once for each, so that they need not be in memory together. The file appears when all of it
/// is written, or else one that was there stays. Errors, on all ranks: FileError, InputError for a path that cannot
/// hold a regular file, Error if a part has another size. Collective. Returns the bytes of all parts.
std::uint64_t write_parts(const std::string& path, const PartsFormat& format, const std::map<std::string, Bytes>& heads,
                          std::size_t count, const std::map<SubdomainId, std::uint64_t>& own,
                          const std::function<Bytes(SubdomainId)>& part, Ranks& ranks);

/// Such a file, to be read. Errors: InputError, which names a file of another kind or version, and one that is damaged;
/// FileError.
class PartsFile {
 public:
  PartsFile(std::string path, const PartsFormat& format);

  [[nodiscard]] Bytes head(const std::string& name) const;
  /// The end of the bytes of each part among those of all.
  [[nodiscard]] const std::vector<std::uint64_t>& ends() const { return ends_; }
  [[nodiscard]] Bytes part(SubdomainId s) const;

  /// Lets `read` make something of what is in the file. An Error becomes an InputError that names the file.
  template <class Read>
  auto understand(const Read& read) const {
    try {
      return read();
    } catch (const InputError&) {
      throw;
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      refuse(error);
    }
  }

 private:
  [[noreturn]] void refuse(const Error& error) const;
  [[nodiscard]] Bytes unsealed(const std::string& array, std::uint64_t first, std::uint64_t count,
                               const std::string& what) const;

  std::string path_;
  Hdf5Bytes file_;
  std::vector<std::uint64_t> ends_;
};

/// Whether the file is one of this kind, of whatever version. Looks into regular HDF5 files alone.
[[nodiscard]] bool is_parts_file(const std::string& path, const PartsFormat& format);

/// The first part that each of so many ranks takes, and their number at last: all take about as much in sum. `ends`:
/// sums of what parts weigh, ascending.
[[nodiscard]] std::vector<std::size_t> shares_of(const std::vector<std::uint64_t>& ends, std::int32_t ranks);

}  // namespace driftmesh
