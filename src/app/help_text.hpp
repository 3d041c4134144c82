#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace driftmesh::app {

/// Help as CLI11 prints it, with descriptions wrapped to 100 columns and without empty lines in rows.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kNameColumns); }
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_group(std::string group, bool is_positional, std::vector<const CLI::Option*> opts) const override;

 private:
  static constexpr std::size_t kNameColumns = 30;
  static constexpr std::size_t kColumns = 100;
};

/// `text` with line breaks at spaces so that no line is longer than `columns`, where words allow it.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t columns);

}  // namespace driftmesh::app
