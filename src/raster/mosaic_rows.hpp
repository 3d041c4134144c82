#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/box.hpp"
#include "gis/raster_rows.hpp"

namespace driftmesh {

/// A raster in a file, and where its values are.
struct RasterTile {
  std::string path;
  RasterFrame frame;
};

/// Whether the points of two frames belong to one grid, to a hundredth of a spacing.
[[nodiscard]] bool on_one_grid(const RasterFrame& a, const RasterFrame& b);

/// Around both of two frames on one grid.
[[nodiscard]] RasterFrame frame_around(const RasterFrame& a, const RasterFrame& b);

/// From the first value to the last: half a cell less on each side than the raster has.
[[nodiscard]] Box box_of(const RasterFrame& frame);

/// Rasters on one grid and in one system, as one. Where several have a value, that of the first counts. A file is open
/// only while rows that it has are read.
class MosaicRows final : public RasterRows {
 public:
  explicit MosaicRows(std::vector<RasterTile> tiles);

  [[nodiscard]] const RasterFrame& frame() const override { return frame_; }
  [[nodiscard]] PlaceFunction from_plane(const Projection& projection) const override {
    return any_->from_plane(projection);
  }
  [[nodiscard]] PlaceFunction to_plane(const Projection& projection) const override {
    return any_->to_plane(projection);
  }
  [[nodiscard]] DomainSystem domain_system() const override { return any_->domain_system(); }
  [[nodiscard]] bool in_mercator() const override { return any_->in_mercator(); }
  void read(std::int64_t j, std::int64_t first, std::span<float> values) override;
  void finish() override;

 private:
  struct Part {
    RasterTile tile;
    std::int64_t left, bottom;  // its first column and row here
    std::unique_ptr<RasterRows> open{};
    bool done = false;
  };

  RasterFrame frame_;
  std::vector<Part> parts_;
  std::unique_ptr<RasterRows> any_;  // one of the files, which knows the system
  std::vector<float> row_;
};

/// Files as one raster. Throws InputError if they are several that are not on one grid, and as open_raster_rows does.
[[nodiscard]] std::unique_ptr<RasterRows> open_mosaic(const std::vector<std::string>& paths);

}  // namespace driftmesh
