#include "picture/plot_canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <filesystem>

#include "base/standard_streams.hpp"
#include "driftmesh/error.hpp"
#include "picture/ascii_text.hpp"
#include "picture/plot.hpp"

#ifdef __SANITIZE_ADDRESS__
// Fontconfig keeps loaded fonts until the process ends; this is not our leak.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig";
}
// Do not report the suppression: tests would take that for an error.
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";
}
#endif

namespace driftmesh {
namespace {

/// What cairo can show of a text. Built without fonts of the system, it has letters of its own.
std::string shown_text(const std::string& text) {
#if defined(CAIRO_HAS_FT_FONT) || defined(CAIRO_HAS_QUARTZ_FONT) || defined(CAIRO_HAS_WIN32_FONT)
  return text;
#else
  return ascii_text(text);
#endif
}

/// ".png", ".svg" or ".pdf"; anything else if it is not a picture.
std::string format_of(const std::string& path) {
  return names_no_format(path) ? ".png" : std::filesystem::path(path).extension().string();
}

std::string checked_name(const std::string& path, int width, int height) {
  if (!is_picture_name(path))
    throw InputError({path, 0}, "is not a picture format", "use a name that ends in .png, .svg or .pdf");
  for (int length : {width, height})
    if (length < Canvas::kSmallest || length > Canvas::kLargest)
      throw InputError(
          {path, 0}, "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
          "each side may have " + std::to_string(Canvas::kSmallest) + " to " + std::to_string(Canvas::kLargest));
  return path;
}

cairo_status_t write_bytes(void* picture_file, const unsigned char* bytes, unsigned count) {
  auto& target = *static_cast<PictureFile*>(picture_file);
  try {
    target.file.write(bytes, count);
    return CAIRO_STATUS_SUCCESS;
  } catch (const std::exception& error) {
    target.failure = error.what();
    return CAIRO_STATUS_WRITE_ERROR;
  }
}

}  // namespace

bool is_picture_name(const std::string& path) {
  const std::string format = format_of(path);
  return format == ".png" || format == ".svg" || format == ".pdf";
}

Canvas::Canvas(const std::string& path, int width, int height)
    : file_(checked_name(path, width, height)), is_png_(format_of(path) == ".png") {
  if (is_png_)
    surface_ = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  else if (format_of(path) == ".svg")
    surface_ = cairo_svg_surface_create_for_stream(write_bytes, &file_, width, height);
  else
    surface_ = cairo_pdf_surface_create_for_stream(write_bytes, &file_, width, height);
  cairo_ = cairo_create(surface_);
  set_color(kPaper);
  cairo_paint(cairo_);
}

Canvas::~Canvas() {
  cairo_destroy(cairo_);
  cairo_surface_destroy(surface_);
}

void Canvas::set_color(const Rgb& color, double opacity) {
  cairo_set_source_rgba(cairo_, color.red, color.green, color.blue, opacity);
}

void Canvas::fill_rect(const PixelRect& rect, const Rgb& color) {
  set_color(color);
  cairo_rectangle(cairo_, rect.x, rect.y, rect.width, rect.height);
  cairo_fill(cairo_);
}

void Canvas::line(const Point& from, const Point& to, double width, const Rgb& color) {
  set_color(color);
  cairo_set_line_width(cairo_, width);
  cairo_move_to(cairo_, from.x, from.y);
  cairo_line_to(cairo_, to.x, to.y);
  cairo_stroke(cairo_);
}

void Canvas::choose_font(const TextStyle& style) {
  cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, style.size);
}

void Canvas::text(const Point& at, const std::string& characters, const TextStyle& style) {
  const double width = text_width(characters, style);
  const std::string shown = shown_text(characters);
  const double shift = style.align == TextAlign::kLeft ? 0 : style.align == TextAlign::kCenter ? width / 2 : width;
  if (style.halo) {
    cairo_move_to(cairo_, at.x - shift, at.y);
    cairo_text_path(cairo_, shown.c_str());
    set_color(kPaper, 0.85);
    cairo_set_line_width(cairo_, 0.4 * style.size);
    cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(cairo_);
  }
  set_color(style.color);
  cairo_move_to(cairo_, at.x - shift, at.y);
  cairo_show_text(cairo_, shown.c_str());
  cairo_new_path(cairo_);
}

double Canvas::text_width(const std::string& characters, const TextStyle& style) {
  choose_font(style);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_, shown_text(characters).c_str(), &extents);
  return extents.x_advance;
}

void Canvas::commit() {
  if (is_png_) cairo_surface_write_to_png_stream(surface_, write_bytes, &file_);
  cairo_surface_finish(surface_);
  if (!file_.failure.empty()) throw Error(file_.failure);
  const cairo_status_t status = cairo_surface_status(surface_);
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(std::string("cannot draw the picture: ") + cairo_status_to_string(status));
  file_.file.commit();
}

}  // namespace driftmesh
