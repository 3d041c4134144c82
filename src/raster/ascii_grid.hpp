#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gis/raster_rows.hpp"

namespace driftmesh {

/// A raster in the text format that GIS call ESRI ASCII grid, without any library: lines "ncols 3", "nrows 2",
/// "xllcorner 0" or "xllcenter 0", likewise for y, "cellsize 1" or "dx 1" and "dy 1", and maybe "NODATA_value -9999",
/// in any order; then the values, from the northernmost row to the southernmost, from west to east in each.
class AsciiGrid : public RasterRows {
 public:
  /// `text` must outlive the object; `file` is for messages. Throws InputError with the line of a fault in the header.
  AsciiGrid(std::string file, std::string_view text);

  [[nodiscard]] const RasterFrame& frame() const override { return frame_; }
  /// Throws InputError with the line of what is no number.
  void read(std::int64_t j, std::int64_t first, std::span<float> values) override;
  /// Throws InputError where there are fewer or more values than the header says.
  void finish() override;

 private:
  struct Header;
  [[noreturn]] void fail(const std::string& what, const std::string& next) const;
  std::string_view next_word();
  [[nodiscard]] double number(std::string_view word, const char* what) const;
  void read_header();
  void set_frame(const Header& header);
  [[nodiscard]] float value_of(std::string_view word) const;
  void skip_to(std::int64_t j);

  std::string file_;
  std::string_view rest_;
  std::size_t line_ = 1;
  std::size_t word_line_ = 1;  // line of the word that was read last
  RasterFrame frame_;
  double none_ = -9999;
  std::int64_t next_row_ = 0;  // as rows are read: downward to 0
};

}  // namespace driftmesh
