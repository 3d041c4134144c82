#pragma once

#include <string>
#include <vector>

#include "driftmesh/point.hpp"
#include "picture/plot_color.hpp"

namespace driftmesh {

/// The texts of a chart.
struct ChartText {
  std::string title;
  std::string subtitle;
  std::string x_label;
  std::string y_label;
};

/// Bars side by side, each a stack of the same parts.
struct StackedBars {
  struct Part {
    std::string name;
    Rgb color;
    std::vector<double> heights;  ///< of each bar, >= 0
  };
  /// Consecutive bars with a name below them.
  struct Group {
    std::string name;
    std::size_t bars = 0;
  };
  ChartText text;
  std::vector<Part> parts;    ///< the lowest first
  std::vector<Group> groups;  ///< empty: bars are numbered
};

/// Curves in one frame.
struct LineChart {
  struct Curve {
    std::string name;  ///< empty: not in the legend
    Rgb color;
    std::vector<Point> points;  ///< x ascending
    std::vector<double> low;    ///< empty, or the lower edge of a band that ends at each point, without a line
    bool marks = false;         ///< whether points are marked
  };
  ChartText text;
  std::vector<Curve> curves;
  bool logarithmic_x = false;
  double y_from = 0;  ///< the lowest y that is shown
};

/// A timeline: time runs from left to right, each subject has a row, and arrows lead from row to row.
struct Timeline {
  struct Arrow {
    double from_time = 0, to_time = 0;
    std::size_t from_row = 0, to_row = 0;
  };
  ChartText text;
  std::size_t rows = 0;
  double end = 0;  ///< of time
  /// Of each row: the intervals of activity, as pairs of times.
  std::vector<std::vector<Point>> busy;
  std::vector<Arrow> arrows;
};

/// These draw as .png, .svg or .pdf, by the extension of `path`. Errors: InputError for an unknown extension,
/// FileError.
void plot_chart(const StackedBars& chart, const std::string& path);
void plot_chart(const LineChart& chart, const std::string& path);
void plot_chart(const Timeline& chart, const std::string& path);

}  // namespace driftmesh
