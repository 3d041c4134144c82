#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace driftmesh::config {

/// The source of a YAML text: a file, or one --set of the command line.
class Origin {
 public:
  [[nodiscard]] static Origin file(const std::string& path);
  [[nodiscard]] static Origin setting(const std::string& text);

  /// Whether a place is that of a setting.
  [[nodiscard]] static bool is_setting(const std::string& place);

  /// "file:line:column", or "--set key=value".
  [[nodiscard]] std::string place(const YAML::Mark& mark) const;
  /// Throws InputError with that place.
  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what, const std::string& next) const;
  /// A file that it names: relative to the folder of the file, or to the working directory for --set.
  [[nodiscard]] std::string resolved(const std::string& file) const;
  /// A file that it names to be written, likewise. Empty: the file would lie outside of that folder, which the one who
  /// starts the program has not agreed to.
  [[nodiscard]] std::string resolved_output(const std::string& file) const;
  /// Throws InputError if it is not YAML.
  [[nodiscard]] YAML::Node parse(const std::string& text) const;

 private:
  Origin(std::string name, std::string folder, bool has_lines);
  void refuse_control_characters(const std::string& text) const;

  std::string name_;
  std::string folder_;
  bool has_lines_;
};

}  // namespace driftmesh::config
