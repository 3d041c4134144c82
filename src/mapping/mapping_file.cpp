#include "mapping/mapping_file.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/read_file.hpp"
#include "driftmesh/error.hpp"

namespace driftmesh {
namespace {

using Json = nlohmann::json;

constexpr const char* kFirst = ".0.json";
constexpr const char* kNext = "vt's schema LBDatafile describes such files";

class MappingReader {
 public:
  MappingReader(std::int32_t subdomains, std::int32_t ranks) : ranks_(ranks), owners_(to_index(subdomains)) {}

  void read(const std::string& file) {
    file_ = file;
    const Json data = Json::parse(read_file(file), nullptr, false);
    const auto phases = data.is_object() ? data.find("phases") : data.end();
    if (!data.is_object() || phases == data.end() || !phases->is_array() || phases->empty())
      fail("has no phases of load balancing statistics");
    const Json& last = phases->back();
    if (!last.is_object() || !last.contains("tasks") || !last["tasks"].is_array()) fail("has a phase without tasks");
    for (const Json& task : last["tasks"]) add(task);
  }

  Assignment finish() const {
    Assignment assignment;
    for (const SubdomainId s : ids_of(owners_)) {
      if (!owners_[s])
        fail("maps no rank to subdomain " + std::to_string(to_int(s)),
             "the file must be that of rank 0, with those of all ranks beside it, for this decomposition");
      assignment.push_back(*owners_[s]);
    }
    return assignment;
  }

 private:
  [[noreturn]] void fail(const std::string& what, const char* next = kNext) const {
    throw InputError({file_, 0}, what, next);
  }

  void add(const Json& task) {
    const auto entity = task.is_object() ? task.find("entity") : task.end();
    if (!task.is_object() || entity == task.end() || !entity->is_object()) fail("has a task without an entity");
    if (entity->contains("migratable") && (*entity)["migratable"] == false) return;  // work that belongs to a rank
    const std::int64_t number = number_of(*entity), rank = whole(task, "node");
    if (number < 0 || number >= static_cast<std::int64_t>(owners_.size()))
      fail("names subdomain " + std::to_string(number) + ", but there are " + std::to_string(owners_.size()),
           "it is for another decomposition: give its number of subdomains and its seed, or its file");
    if (rank < 0 || rank >= ranks_)
      fail("names rank " + std::to_string(rank) + ", but there are " + std::to_string(ranks_),
           "it is for more ranks: use as many");
    std::optional<Rank>& owner = owners_[SubdomainId{static_cast<std::int32_t>(number)}];
    if (owner) fail("names subdomain " + std::to_string(number) + " twice", "the files are not of one run");
    owner = Rank{static_cast<std::int32_t>(rank)};
  }

  [[nodiscard]] std::int64_t number_of(const Json& entity) const {
    const auto index = entity.find("index");
    if (index != entity.end() && index->is_array() && !index->empty() && index->front().is_number_integer())
      return index->front().get<std::int64_t>();
    return (whole(entity, "id") >> 18) - 1;
  }

  [[nodiscard]] std::int64_t whole(const Json& object, const char* name) const {
    const auto found = object.find(name);
    if (found == object.end() || !found->is_number_integer())
      fail(std::string("has a task without a whole number \"") + name + "\"");
    return found->get<std::int64_t>();
  }

  std::string file_;
  std::int32_t ranks_;
  IdVector<SubdomainId, std::optional<Rank>> owners_;
};

}  // namespace

std::vector<std::string> mapping_files(const std::string& path) {
  std::vector<std::string> files{path};
  if (!path.ends_with(kFirst)) return files;
  const std::string stem = path.substr(0, path.size() - std::string(kFirst).size());
  std::error_code ignored;
  for (int rank = 1;; ++rank) {
    const std::string file = stem + "." + std::to_string(rank) + ".json";
    if (!std::filesystem::exists(file, ignored)) return files;
    files.push_back(file);
  }
}

Assignment read_mapping(const std::string& path, std::int32_t subdomains, std::int32_t ranks) {
  MappingReader reader(subdomains, ranks);
  for (const std::string& file : mapping_files(path)) reader.read(file);
  return reader.finish();
}

}  // namespace driftmesh
