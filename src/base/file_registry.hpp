#pragma once

#include <map>
#include <string>

#include "base/file_identity.hpp"

namespace driftmesh {

/// All files of one run, by what they are used for, so that nothing that is read is overwritten and no two outputs have
/// one name. Files are told apart by their identity, not by their spelling. Character devices (/dev/null) may have any
/// number of uses. Register everything before the work starts.
class FileRegistry {
 public:
  /// The run reads a file. `use` is what the user calls it by: "--size-mesh". Throws InputError, naming both uses, if
  /// the run also writes it, and if standard input is read twice.
  void reads(const std::string& path, const std::string& use);
  /// The run writes a file. Throws InputError, naming both uses, if the run also reads it or writes it a second time.
  void writes(const std::string& path, const std::string& use);

 private:
  struct Use {
    std::string path;  // as the user spells it
    std::string name;
  };
  using Uses = std::map<FileIdentity, Use>;

  [[noreturn]] static void refuse_to_overwrite(const Use& written, const Use& read);

  Uses read_, written_;
};

}  // namespace driftmesh
