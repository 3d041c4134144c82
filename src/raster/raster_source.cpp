#include "raster/raster_source.hpp"

#include <filesystem>

#include "base/file_bytes.hpp"
#include "gis/raster_file.hpp"
#include "raster/ascii_grid.hpp"

namespace driftmesh {
namespace {

/// The bytes come first, since the grid reads them for as long as it lives.
class AsciiFile final : private FileBytes, public AsciiGrid {
 public:
  explicit AsciiFile(const std::string& path) : FileBytes(path), AsciiGrid(path, view()) {}
};

}  // namespace

std::unique_ptr<RasterRows> open_raster_rows(const std::string& path) {
  if (std::filesystem::path(path).extension() == ".asc") return std::make_unique<AsciiFile>(path);
  return open_raster_file(path);
}

}  // namespace driftmesh
