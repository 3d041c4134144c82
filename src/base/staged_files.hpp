#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/temporary_files.hpp"

namespace driftmesh {

/// Files that appear under their names together or not at all. While an object exists, files that AtomicFile commits on
/// this thread are complete, but stay under their temporary names; commit() renames all of them, in the order in which
/// they were completed. Without commit(), the files under these names are as they were. Objects are destroyed in the
/// reverse order of their making; what an inner one commits, the outer one takes over.
///
/// Every file is whole, and all renames come in one step of a few microseconds in which the signals of
/// remove_temporaries_on_signals() wait. Only a kill without warning or a loss of power in just that step leaves some
/// files new and others old.
class StagedFiles {
 public:
  StagedFiles();
  ~StagedFiles();
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;

  /// Throws FileError if a file cannot be renamed; none has its name then.
  void commit();

  // The two halves of commit(), for ranks that agree in between. Not for inner objects.

  /// Renames all files; what they replace is kept. Throws as commit() does.
  void appear();
  /// What has appeared stays. Otherwise, the destructor takes it back.
  void finish() noexcept;

  /// A file by its name, as AtomicFile was given it, and its bytes.
  struct Listed {
    std::string path;
    std::uint64_t bytes = 0;
  };
  [[nodiscard]] std::vector<Listed> files() const;

 private:
  friend class AtomicFile;
  struct File {
    Listed listed;
    std::string target;     // the name to appear under
    std::string temporary;  // empty once it has appeared
    std::unique_ptr<NotedTemporary> noted;
    std::string old;  // what was there before, under a name of its own, or empty
  };

  void take(File file) { files_.push_back(std::move(file)); }
  static void keep_old(File& file);
  static void rename_to_target(File& file);
  void take_back() noexcept;

  StagedFiles* outer_;
  std::vector<File> files_;
  std::optional<HeldSignals> held_;  // from appear() to finish()
};

}  // namespace driftmesh
