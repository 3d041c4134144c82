#include "job/value_bytes.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "driftmesh/error.hpp"

namespace driftmesh::job {
namespace {

using Texts = std::vector<std::string>;
using Table = std::map<std::string, std::string>;

enum class StoredAs : std::uint8_t { kFlag, kInteger, kNumber, kText, kNumbers, kTexts, kTable };

struct Writing {
  ByteWriter& writer;

  void operator()(bool flag) const { begin(StoredAs::kFlag).number(static_cast<std::uint8_t>(flag ? 1 : 0)); }
  void operator()(std::int64_t integer) const { begin(StoredAs::kInteger).number(integer); }
  void operator()(double number) const { begin(StoredAs::kNumber).number(number); }
  void operator()(const std::string& text) const { begin(StoredAs::kText).text(text); }
  void operator()(const std::vector<double>& numbers) const { begin(StoredAs::kNumbers).array(numbers); }
  void operator()(const Texts& texts) const {
    begin(StoredAs::kTexts).number(std::uint64_t{texts.size()});
    for (const std::string& text : texts) writer.text(text);
  }
  void operator()(const Table& table) const {
    begin(StoredAs::kTable).number(std::uint64_t{table.size()});
    for (const auto& [name, text] : table) {
      writer.text(name);
      writer.text(text);
    }
  }
  void operator()(const std::vector<Record>& /*records*/) const { throw Error("a list of records is not stored"); }

 private:
  ByteWriter& begin(StoredAs kind) const {
    writer.number(kind);
    return writer;
  }
};

}  // namespace

void write_value(ByteWriter& writer, const Value& value) {
  std::visit(Writing{writer},
             static_cast<const std::variant<bool, std::int64_t, double, std::string, std::vector<double>, Texts, Table,
                                            std::vector<Record>>&>(value));
}

Value read_value(ByteReader& reader) {
  switch (reader.number<StoredAs>()) {
    case StoredAs::kFlag:
      return reader.number<std::uint8_t>() != 0;
    case StoredAs::kInteger:
      return reader.number<std::int64_t>();
    case StoredAs::kNumber:
      return reader.number<double>();
    case StoredAs::kText:
      return reader.text();
    case StoredAs::kNumbers: {
      std::vector<double> numbers;
      reader.array(numbers);
      return numbers;
    }
    case StoredAs::kTexts: {
      Texts texts;
      for (auto left = reader.number<std::uint64_t>(); left > 0; --left) texts.push_back(reader.text());
      return texts;
    }
    case StoredAs::kTable: {
      Table table;
      for (auto left = reader.number<std::uint64_t>(); left > 0; --left) {
        const std::string name = reader.text();
        table[name] = reader.text();
      }
      return table;
    }
  }
  throw Error("it has a value of unknown kind");
}

}  // namespace driftmesh::job
