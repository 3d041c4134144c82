#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace driftmesh::app {

/// Help as CLI11 prints it, in at most 100 columns and without what only programmers want to know.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;

 private:
  static constexpr std::size_t kNameColumns = 30;
  static constexpr std::size_t kColumns = 100;
};

/// `text` with line breaks at spaces so that no line is longer than `columns`, where words allow it.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t columns);

}  // namespace driftmesh::app
