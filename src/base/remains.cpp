#include "base/remains.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <system_error>

#include "base/system.hpp"

namespace driftmesh {
namespace {

namespace fs = std::filesystem;

/// The number at the end of a text, if digits alone follow the last `before`; cuts both off.
std::optional<long> take_number(std::string_view& text, char before) {
  const std::size_t at = text.rfind(before);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view digits = text.substr(at + 1);
  long number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 0) return std::nullopt;
  text = text.substr(0, at);
  return number;
}

/// A name of our own making, unlike "2024" in a file that somebody calls data.tmp-2024-01-02.
bool is_host(std::string_view host) {
  if (host == host_of_processes()) return true;
  constexpr long kLeast = 1'000'000;  // numbers of namespaces of processes are greater
  std::string_view name = host;
  const std::optional<long> space = take_number(name, '.');
  return space && *space > kLeast && !name.empty();
}

std::optional<Remains> remains_at(const fs::directory_entry& entry) {
  const auto owner = owner_in(entry.path().filename().string());
  std::error_code failed;
  if (!owner || entry.symlink_status(failed).type() != fs::file_type::regular) return std::nullopt;
  const std::uint64_t bytes = entry.file_size(failed);
  const fs::file_time_type written = entry.last_write_time(failed);
  if (failed) return std::nullopt;
  const std::chrono::duration<double> quiet = fs::file_time_type::clock::now() - written;
  const bool is_here = owner->host == host_of_processes();
  return Remains{entry.path().string(), *owner, bytes, quiet.count(), is_here, is_here && has_ended(owner->process)};
}

}  // namespace

std::optional<FileOwner> owner_in(std::string_view name) {
  const std::size_t at = name.rfind(kTemporaryMark);
  if (at == std::string_view::npos || at == 0) return std::nullopt;
  std::string_view rest = name.substr(at + kTemporaryMark.size());
  if (!take_number(rest, '-')) return std::nullopt;
  const std::optional<long> process = take_number(rest, '-');
  if (!process || *process == 0 || !is_host(rest)) return std::nullopt;
  return FileOwner{std::string(rest), *process};
}

std::vector<Remains> temporaries_in(const std::string& folder) {
  std::vector<Remains> found;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
    if (auto remains = remains_at(*at)) found.push_back(std::move(*remains));
  std::sort(found.begin(), found.end(), [](const Remains& a, const Remains& b) { return a.path < b.path; });
  return found;
}

}  // namespace driftmesh
