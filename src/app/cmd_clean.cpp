#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "app/commands.hpp"
#include "base/remains.hpp"
#include "base/standard_streams.hpp"
#include "base/words.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh::app {
namespace {

struct CleanCommand {
  std::string folder;
  double hours = kAbandoned / 3600;
  bool dry_run = false;
};

std::string whose(const Remains& file) {
  if (!file.is_here)
    return fmt::format("of process {} on {}, written to {} ago", file.owner.process, file.owner.host,
                       duration_words(std::max(0.0, file.quiet)));
  return fmt::format("of process {} of this host, which {}", file.owner.process,
                     file.has_ended ? "has ended" : "is running");
}

void remove(const std::string& path) {
  std::error_code failed;
  std::filesystem::remove(path, failed);
  if (!failed) return;
  errno = failed.default_error_condition().value();
  throw FileError(path, "cannot remove");
}

void clean(const CleanCommand& asked) {
  std::error_code unknown;
  if (!std::filesystem::is_directory(asked.folder, unknown))
    throw InputError({asked.folder}, "is no folder", "name the one where runs have written");
  std::size_t removed = 0;
  std::uint64_t bytes = 0;
  for (const Remains& file : temporaries_in(asked.folder)) {
    const bool goes = is_abandoned(file, asked.hours * 3600);
    if (goes && !asked.dry_run) remove(file.path);
    print(fmt::format("{:<8} {}, {}, {}\n",
                      !goes           ? "kept"
                      : asked.dry_run ? "would go"
                                      : "removed",
                      file.path, bytes_words(file.bytes), whose(file)));
    removed += goes ? 1 : 0;
    bytes += goes ? file.bytes : 0;
  }
  print(fmt::format("{} file{} {}, {}\n", removed, removed == 1 ? "" : "s", asked.dry_run ? "would go" : "removed",
                    bytes_words(bytes)));
}

}  // namespace

cli::Command clean_command() {
  const auto command = std::make_shared<CleanCommand>();
  return {.name = "clean",
          .summary = "Remove what runs that were killed have left in a folder",
          .options = {{.kind = cli::Option::Kind::kPositional,
                       .name = "folder",
                       .value = "FOLDER",
                       .help = "Where they wrote, or had their scratch files",
                       .required = true,
                       .completes = cli::Option::Completes::kFolder,
                       .take = cli::into(command->folder)},
                      {.name = "older",
                       .value = "HOURS",
                       .help = "Of other hosts, remove what nobody has written to for so long; 0: all",
                       .standard = "24",
                       .take = cli::into(command->hours, {.least = 0})},
                      {.kind = cli::Option::Kind::kFlag,
                       .name = "dry-run",
                       .help = "Only say what would be removed",
                       .take = cli::into(command->dry_run)}},
          .notes =
              "These are files that were not complete (NAME.tmp-HOST-PROCESS-NUMBER). One of a process that runs on "
              "this host is never removed. Whether a process on another host, or in another container, still runs "
              "is not known here: give --older 0 if none does.",
          .examples = {"driftmesh clean /shared/results --dry-run", "driftmesh clean /shared/results"},
          .exit_codes = "0 done, 1 error, 2 wrong usage",
          .run = [command](cli::Call&) {
            clean(*command);
            return 0;
          }};
}

}  // namespace driftmesh::app
