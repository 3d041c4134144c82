#include "app/number_map.hpp"

#include <sstream>
#include <string_view>
#include <utility>

#include "base/read_file.hpp"
#include "cli/values.hpp"
#include "driftmesh/error.hpp"
#include "io/file_sink.hpp"

namespace driftmesh::app {
namespace {

constexpr std::string_view kTitle = "kind,new,old";

NumberMap::Entry entry_of(const std::vector<std::string>& words) {
  NumberMap::Entry entry;
  cli::into(entry.now, {.least = 0})(words[1]);
  cli::into(entry.before, {.least = -1})(words[2]);
  return entry;
}

}  // namespace

void write_number_map(const std::string& path, const std::vector<std::int32_t>& old_points,
                      const std::vector<std::int32_t>& old_triangles) {
  FileSink out(path);
  out.text(kTitle);
  out.character('\n');
  const auto write = [&](std::string_view kind, const std::vector<std::int32_t>& old) {
    for (std::size_t i = 0; i < old.size(); ++i) {
      if (std::cmp_equal(old[i], i)) continue;
      out.text(kind);
      out.character(',');
      out.number(i);
      out.character(',');
      out.number(old[i]);
      out.character('\n');
    }
  };
  write("point", old_points);
  write("triangle", old_triangles);
  out.commit();
}

NumberMap read_number_map(const std::string& path) {
  NumberMap map;
  std::istringstream lines(read_file(path));
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line == kTitle) continue;
    const std::vector<std::string> words = cli::separated(line);
    const bool is_point = words[0] == "point";
    try {
      if (words.size() != 3 || (!is_point && words[0] != "triangle")) throw cli::UsageError("");
      (is_point ? map.points : map.triangles).push_back(entry_of(words));
    } catch (const cli::UsageError&) {
      throw InputError({path, number}, "is '" + line + "'",
                       "lines are point,NEW,OLD or triangle,NEW,OLD, as driftmesh adapt --map writes them");
    }
  }
  return map;
}

}  // namespace driftmesh::app
