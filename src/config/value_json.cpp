#include "config/value_json.hpp"

#include "job/keys.hpp"

namespace driftmesh::config {

Json json_of(const job::Value& value) {
  return std::visit(
      [](const auto& held) -> Json {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(held)>, std::vector<job::Record>>) {
          Json list = Json::array();
          for (const job::Record& record : held) {
            Json& item = list.emplace_back(Json::object());
            for (const auto& [name, field] : record) item[name] = json_of(field);
          }
          return list;
        } else {
          return held;
        }
      },
      static_cast<const job::Value::variant&>(value));
}

Json json_of(const job::Request& request, unsigned entry_points) {
  Json all = Json::object();
  for (const job::Key& key : job::keys())
    if ((key.entry_points & entry_points) != 0) all[key.name] = json_of(key.load(request));
  return all;
}

}  // namespace driftmesh::config
