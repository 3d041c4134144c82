#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driftmesh/pslg.hpp"
#include "driftmesh/size_field.hpp"
#include "geometry/box.hpp"
#include "sizing/background_function.hpp"
#include "sizing/medial_axis.hpp"
#include "sizing/named_raster.hpp"

namespace driftmesh {

/// Requirements on the sizes of triangles. All that are given apply: the shortest length wins.
struct SizingOptions {
  /// A target edge length in x and y; see ExpressionField. Empty: none.
  std::string expression{};
  /// A background mesh; see read_background. Empty: none.
  std::string background{};
  /// The same in memory, with its gradation.
  std::shared_ptr<const BackgroundFunction> lengths{};
  /// A file that write_size_tree wrote for the domain, instead of all others; see read_size_tree. Empty: none.
  std::string tree{};
  /// Layers of triangles across every channel; see across.hpp. 0: any number.
  int across = 0;
  /// By how much lengths may grow per unit of distance, > 0; absent: no limit. 0.2 to 0.3 grade well. Those of the
  /// background mesh along its edges, those of the expression along straight lines in the box of the domain.
  std::optional<double> gradation{};
  double longest = std::numeric_limits<double>::infinity();  ///< target edge lengths are at most this, > 0
  double shortest = 0;  ///< target edge lengths are at least this: smaller values are raised to it
  /// Where the function does not tell that it is positive, squares are no narrower than this, > 0: see SizeTree.
  double spacing = std::numeric_limits<double>::infinity();
  /// The domain.
  Box domain{};
  /// With the segments that distance() in the expression measures to; null: none. Not owned, and needed only while the
  /// field is made.
  const Pslg* input = nullptr;
  /// The outline of the domain, of which width() in the expression is the width; needed for `across`, too.
  FindOutline outline{};
  /// Those that the expression may name.
  NamedRasters rasters{};
  /// Lengths at points as the sources give them, not from a tree: for those who judge what was made from that.
  bool exact = false;
};

/// A size field, and the background mesh in it; null: none.
struct SizeSource {
  std::unique_ptr<SizeField> field;
  std::shared_ptr<const BackgroundMesh> background;
};

/// The field that the options ask for; null when they ask for nothing. Throws InputError and FileError.
[[nodiscard]] SizeSource make_size(const SizingOptions& options);
[[nodiscard]] std::unique_ptr<SizeField> make_size_field(const SizingOptions& options);

/// Lengths from files in Triangle's format. `path` is their common stem, or one of them:
/// - mesh, mesh.node, mesh.ele: the first attribute of each point is the target edge length there, linear in between;
/// - mesh.area: the area bound of each triangle, <= 0 for none. With a gradation the bounds first become lengths at the
///   points (the shortest around each), limited and linear in between; without one they hold triangle by triangle.
[[nodiscard]] std::shared_ptr<const BackgroundFunction> read_background(const std::string& path,
                                                                        std::optional<double> gradation);

/// The files that read_background reads.
[[nodiscard]] std::vector<std::string> background_files(const std::string& path);

}  // namespace driftmesh
