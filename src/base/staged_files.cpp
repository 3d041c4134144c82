#include "base/staged_files.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

namespace fs = std::filesystem;

thread_local StagedFiles* innermost = nullptr;

/// Over a file of that name, too. If it fails, errno says why.
bool rename_file(const std::string& from, const std::string& to) noexcept {
  std::error_code failed;
  fs::rename(from, to, failed);
  if (failed) errno = failed.default_error_condition().value();
  return !failed;
}

}  // namespace

StagedFiles::StagedFiles() : outer_(std::exchange(innermost, this)) {}

StagedFiles::~StagedFiles() {
  innermost = outer_;
  take_back();
}

void StagedFiles::commit() {
  if (outer_ != nullptr) {
    std::move(files_.begin(), files_.end(), std::back_inserter(outer_->files_));
    files_.clear();
    return;
  }
  if (files_.size() == 1)  // a rename alone is all or nothing
    rename_to_target(files_[0]);
  else
    appear();
  finish();
}

void StagedFiles::appear() {
  held_.emplace();
  try {
    for (File& file : files_) {
      keep_old(file);
      rename_to_target(file);
    }
  } catch (...) {
    take_back();
    throw;
  }
}

void StagedFiles::finish() noexcept {
  for (const File& file : files_)
    if (!file.old.empty()) std::remove(file.old.c_str());
  files_.clear();
  held_.reset();
}

/// A second link to it, or, on file systems without, another name.
void StagedFiles::keep_old(File& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file.target, ignored)) return;  // over others, renaming fails
  const std::string old = temporary_name(file.target);
  std::error_code no_links;
  fs::create_hard_link(file.target, old, no_links);
  if (no_links && !rename_file(file.target, old)) throw FileError(file.listed.path, "cannot replace");
  file.old = old;
}

void StagedFiles::rename_to_target(File& file) {
  if (!rename_file(file.temporary, file.target)) throw FileError(file.listed.path, "cannot rename to");
  file.temporary.clear();
  file.noted.reset();
}

/// In the opposite order: a name that was given twice gets back what it had at first.
void StagedFiles::take_back() noexcept {
  for (auto file = files_.rbegin(); file != files_.rend(); ++file) {
    const bool appeared = file->temporary.empty();
    if (!file->old.empty())
      rename_file(file->old, file->target);
    else if (appeared)
      std::remove(file->target.c_str());
    if (!appeared) std::remove(file->temporary.c_str());
  }
  files_.clear();
  held_.reset();
}

std::vector<StagedFiles::Listed> StagedFiles::files() const {
  std::vector<Listed> all;
  for (const File& file : files_) all.push_back(file.listed);
  return all;
}

}  // namespace driftmesh
