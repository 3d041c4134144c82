#pragma once

#include <string>

#include "base/atomic_file.hpp"
#include "driftmesh/point.hpp"
#include "picture/plot_color.hpp"

struct _cairo;          // NOLINT(bugprone-reserved-identifier): cairo's own name
struct _cairo_surface;  // NOLINT(bugprone-reserved-identifier)

namespace driftmesh {

/// A rectangle of the picture, in pixels, y down.
struct PixelRect {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

enum class TextAlign { kLeft, kCenter, kRight };

struct TextStyle {
  double size = 12;
  Rgb color = kInk;
  TextAlign align = TextAlign::kLeft;
  bool bold = false;
  bool halo = false;  ///< white around the letters, for text on top of lines
};

/// Receives cairo's output. Exceptions must not pass through cairo, which is C, so their messages are kept in
/// `failure`.
struct PictureFile {
  explicit PictureFile(const std::string& path) : file(path) {}
  AtomicFile file;
  std::string failure;
};

/// The picture being drawn, with the operations that all parts need; cairo() gives access to all others.
class Canvas {
 public:
  static constexpr int kSmallest = 100;  ///< pixels, in each direction
  static constexpr int kLargest = 20000;

  /// The extension of the path selects the format: .png, .svg or .pdf. Errors: InputError for another extension or a
  /// size out of range, FileError.
  Canvas(const std::string& path, int width, int height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// Whether the format is a vector format.
  [[nodiscard]] bool is_vector() const { return !is_png_; }
  [[nodiscard]] _cairo* cairo() const { return cairo_; }

  void set_color(const Rgb& color, double opacity = 1);
  void fill_rect(const PixelRect& rect, const Rgb& color);
  void line(const Point& from, const Point& to, double width, const Rgb& color);
  /// `at` is on the baseline of the text.
  void text(const Point& at, const std::string& characters, const TextStyle& style);
  [[nodiscard]] double text_width(const std::string& characters, const TextStyle& style);

  /// Completes the file. Error: FileError.
  void commit();

 private:
  void choose_font(const TextStyle& style);

  PictureFile file_;
  bool is_png_;
  _cairo_surface* surface_ = nullptr;
  _cairo* cairo_ = nullptr;
};

}  // namespace driftmesh
