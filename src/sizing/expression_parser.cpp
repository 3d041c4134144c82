#include "sizing/expression_parser.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <utility>

#include "base/from_chars.hpp"
#include "base/key_error.hpp"
#include "base/nearest_name.hpp"
#include "sizing/local_width.hpp"
#include "sizing/outline_curvature.hpp"
#include "sizing/segment_distance.hpp"

namespace driftmesh {
namespace {

using Leaf = ExpressionStep::Leaf;

constexpr std::string_view kDistance = "distance", kSlope = "slope", kWidth = "width", kCurvature = "curvature";
constexpr char kExample[] = "write for example 0.1 + 0.02*sqrt(x^2 + y^2)";
constexpr int kLoosest = 1, kSign = 6;  // precedences; a sign binds as tightly as ^

// Not those of <cctype>, which depend on the locale.
bool is_blank(char c) {
  return c == ' ' || ('\t' <= c && c <= '\r');
}
bool is_digit(char c) {
  return '0' <= c && c <= '9';
}
bool begins_name(char c) {
  return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || c == '_';
}
/// Whether c is part of a character in UTF-8 after its first byte.
bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

template <class Row>
const Row* find_row(std::span<const Row> rows, std::string_view Row::*name, std::string_view wanted) {
  const auto found = std::ranges::find(rows, wanted, name);
  return found == rows.end() ? nullptr : &*found;
}
const Operator* find_operator(std::string_view token) {
  return find_row(expression_operators(), &Operator::token, token);
}

std::vector<std::string> known_names() {
  std::vector<std::string> names{"x", "y"};
  for (const NamedConstant& constant : expression_constants()) names.emplace_back(constant.name);
  for (const std::string_view name : {kDistance, kSlope, kWidth, kCurvature}) names.emplace_back(name);
  for (const Function& function : expression_functions()) names.emplace_back(function.name);
  return names;
}

std::string quoted(std::string_view text) {
  return '"' + std::string(text) + '"';
}

template <class Words>
std::string listed(const Words& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

/// "1, 2, 5", only the first of them if there are very many.
std::string list_of(const std::vector<std::int32_t>& markers) {
  constexpr std::size_t kMost = 20;
  std::vector<std::string> words;
  for (const std::int32_t marker : markers) words.push_back(std::to_string(marker));
  if (words.size() <= kMost) return listed(words);
  words.resize(kMost);
  return listed(words) + " and " + std::to_string(markers.size() - kMost) + " more";
}

void sort_once(std::vector<std::int32_t>& markers) {
  std::ranges::sort(markers);
  markers.erase(std::unique(markers.begin(), markers.end()), markers.end());
}

/// By precedence climbing: reads a value, then operators while they bind tightly enough.
class Parser {
 public:
  Parser(const std::string& text, const Pslg* input, const NamedRasters& rasters, const FindOutline& outline)
      : text_(text), input_(input), rasters_(rasters), outline_(outline) {}

  ParsedExpression parse() {
    if (text_.size() > kLongestExpression)
      fail({}, "it is " + std::to_string(text_.size()) + " characters long",
           "at most " + std::to_string(kLongestExpression) + " are read: give a background mesh or a raster instead");
    advance();
    read_choice();
    if (token_.kind != Token::kEnd) fail_here("an operator");
    return {std::move(steps_), std::move(functions_)};
  }

 private:
  struct Token {
    enum Kind { kEnd, kNumber, kName, kSymbol } kind = kEnd;
    std::string_view text{};
    std::size_t begin = 0;
    double number = 0;
  };

  // ---- Tokens ----

  void advance() {
    const std::string_view text = text_;
    std::size_t begin = token_.begin + token_.text.size();
    while (begin < text.size() && is_blank(text[begin])) ++begin;
    const std::string_view rest = text.substr(begin);
    token_ = {Token::kSymbol, rest.substr(0, 1), begin};
    if (rest.empty())
      token_.kind = Token::kEnd;
    else if (is_digit(rest[0]) || (rest[0] == '.' && rest.size() > 1 && is_digit(rest[1])))
      take_number(rest);
    else if (begins_name(rest[0]))
      take_name(rest);
    else if (find_operator(rest.substr(0, 2)) != nullptr)
      token_.text = rest.substr(0, 2);
    else
      while (token_.text.size() < rest.size() && continues_character(rest[token_.text.size()]))
        token_.text = rest.substr(0, token_.text.size() + 1);
  }
  void take_number(std::string_view rest) {
    const auto [end, error] = from_chars(rest.data(), rest.data() + rest.size(), token_.number);
    token_.kind = Token::kNumber;
    token_.text = rest.substr(0, end - rest.data());
    if (error != std::errc{})
      fail(token_, quoted(token_.text) + " is too large or too small",
           "numbers of double precision reach from 1e-323 to 1e308");
  }
  void take_name(std::string_view rest) {
    const auto end = std::ranges::find_if(rest, [](char c) { return !begins_name(c) && !is_digit(c); });
    token_.kind = Token::kName;
    token_.text = rest.substr(0, end - rest.begin());
  }
  bool take(std::string_view symbol) {
    if (token_.kind != Token::kSymbol || token_.text != symbol) return false;
    advance();
    return true;
  }
  void require(std::string_view symbol, const std::string& expected) {
    if (!take(symbol)) fail_here(expected);
  }

  // ---- The grammar ----

  void read_choice() {
    enter();
    read_operation(kLoosest);
    if (take("?")) {
      read_choice();
      require(":", "an operator or \":\"");
      read_choice();
      emit(kChoose);
    }
    --nesting_;
  }

  /// With operators of at least this precedence.
  void read_operation(int loosest) {
    enter();
    if (take("-")) {
      read_operation(kSign);
      emit(kNegative);
    } else if (take("+")) {
      read_operation(kSign);
    } else {
      read_value();
    }
    while (const Operator* found = find_operator(token_.text)) {
      if (found->precedence < loosest) break;
      advance();
      const bool from_right = found->token == "^";
      read_operation(found->precedence + (from_right ? 0 : 1));
      if (from_right && steps_.back().constant == 2)
        square();
      else
        emit(found->operation);
    }
    --nesting_;
  }

  void read_value() {
    if (token_.kind == Token::kNumber) {
      emit({.constant = token_.number});
      advance();
    } else if (token_.kind == Token::kName) {
      read_name();
    } else {
      require("(", "a number, a name or \"(\"");
      read_choice();
      require(")", "an operator or \")\"");
    }
  }

  void read_name() {
    const Token name = token_;
    advance();
    const auto raster = std::ranges::find(rasters_, name.text, &NamedRaster::name);
    if (const auto* constant = find_row(expression_constants(), &NamedConstant::name, name.text))
      emit({.constant = constant->value});
    else if (const auto* function = find_row(expression_functions(), &Function::name, name.text))
      read_call(name, *function);
    else if (name.text == "x" || name.text == "y")
      emit({.leaf = name.text == "x" ? Leaf::kX : Leaf::kY});
    else if (name.text == kDistance)
      emit_function(read_distance(name));
    else if (name.text == kSlope)
      emit_function(read_slope(name));
    else if (name.text == kWidth)
      emit_function(read_of_outline<LocalWidth>(name, width_));
    else if (name.text == kCurvature)
      emit_function(read_of_outline<OutlineCurvature>(name, curvature_));
    else if (raster != rasters_.end())
      emit_function(raster->function != nullptr ? raster->function : values_of(raster->raster));
    else
      fail_unknown(name);
  }

  void open(const Token& name) { require("(", "\"(\" after " + quoted(name.text)); }

  void read_call(const Token& name, const Function& function) {
    open(name);
    int count = 0;
    do {
      read_choice();
      if (++count > 1 && function.takes != Function::Arguments::kFixed) emit(function.operation);
    } while (take(","));
    require(")", "an operator, \",\" or \")\"");
    if (function.takes == Function::Arguments::kAnyForMean) {
      emit({.constant = static_cast<double>(count)});
      emit(find_operator("/")->operation);
    }
    if (function.takes == Function::Arguments::kFixed) finish_call(name, function, count);
  }
  void finish_call(const Token& name, const Function& function, int count) {
    const int missing = function.operation.operands - count;
    if (missing < 0 || std::cmp_greater(missing, function.defaults.size()))
      fail(name,
           "found " + std::to_string(count) + (count == 1 ? " argument" : " arguments") + ", expected " +
               std::string(name.text) + "(" + std::string(function.arguments) + ")",
           kExample);
    for (const double value : function.defaults.last(missing)) emit({.constant = value});
    emit(function.operation);
  }

  // ---- What is measured ----

  std::shared_ptr<const PlaneFunction> read_distance(const Token& name) {
    open(name);
    std::vector<std::int32_t> markers;
    if (!take(")")) {
      do markers.push_back(read_marker());
      while (take(","));
      if (!take(")")) fail_in_distance();
    }
    sort_once(markers);
    std::shared_ptr<const PlaneFunction>& distance = distances_[markers];
    if (distance == nullptr) {
      require_segments(name, markers);
      distance = std::make_shared<const SegmentDistance>(*input_, markers);
    }
    return distance;
  }

  std::int32_t read_marker() {
    const int sign = take("-") ? -1 : 1;
    const char* const last = token_.text.data() + token_.text.size();
    std::int64_t marker = 0;
    const auto [end, error] = std::from_chars(token_.text.data(), last, marker);
    if (token_.kind != Token::kNumber || end != last || error != std::errc{} || !std::in_range<std::int32_t>(marker))
      fail_in_distance();
    advance();
    return sign * static_cast<std::int32_t>(marker);
  }
  [[noreturn]] void fail_in_distance() const {
    fail(token_, "the arguments of distance are markers of segments, whole numbers with commas between them",
         "write distance(1, 2), or distance() for all segments");
  }

  void require_segments(const Token& name, const std::vector<std::int32_t>& markers) const {
    std::vector<std::int32_t> known;
    if (input_ != nullptr)
      for (const Pslg::Segment& s : input_->segments) known.push_back(s.marker);
    if (known.empty())
      fail(name, "there are no segments that distance could measure to", "give an input that has segments");
    sort_once(known);
    for (const std::int32_t marker : markers)
      if (!std::ranges::binary_search(known, marker))
        fail(name, "no segment has the marker " + std::to_string(marker),
             "the markers of segments are " + list_of(known));
  }

  std::shared_ptr<const PlaneFunction> read_slope(const Token& slope) {
    open(slope);
    const Token name = token_;
    if (name.kind == Token::kName) advance();
    if (name.kind != Token::kName || !take(")"))
      fail(token_, "the argument of slope is the name of a raster", "write for example slope(depth)");
    const auto raster = std::ranges::find(rasters_, name.text, &NamedRaster::name);
    if (raster != rasters_.end() && raster->raster != nullptr) return slope_of(raster->raster);
    const std::string asked(name.text);
    fail(name, "slope asks for the raster '" + asked + "', which is not given" + suggestion(asked, raster_names()),
         KeyText::of("name its file: {input.rasters} {}=FILE", asked));
  }

  /// `made`: when it was named before.
  template <class Function>
  std::shared_ptr<const PlaneFunction> read_of_outline(const Token& name, std::shared_ptr<const PlaneFunction>& made) {
    open(name);
    require(")", "\")\": " + std::string(name.text) + " takes no arguments");
    if (made != nullptr) return made;
    const OutlineSegments outline = outline_ ? outline_() : OutlineSegments{};
    if (outline.empty())
      fail(name, "there is no domain that " + std::string(name.text) + " could measure", "give an input");
    return made = std::make_shared<const Function>(outline);
  }

  // ---- Steps ----

  void emit(const Operation& operation) {
    depth_ -= operation.operands - 1;
    steps_.push_back({.operation = &operation});
  }
  void emit(const ExpressionStep& leaf) {
    if (++depth_ > static_cast<int>(kDeepestExpression)) fail_nesting();
    steps_.push_back(leaf);
  }
  void emit_function(std::shared_ptr<const PlaneFunction> function) {
    const auto found = std::ranges::find(functions_, function);
    emit({.leaf = Leaf::kFunction, .function = static_cast<std::size_t>(found - functions_.begin())});
    if (found == functions_.end()) functions_.push_back(std::move(function));
  }
  /// In place of a power whose exponent is the step before.
  void square() {
    steps_.pop_back();
    --depth_;
    emit(kSquare);
  }
  void enter() {
    if (++nesting_ > kDeepestExpression) fail_nesting();
  }

  // ---- Errors ----

  [[noreturn]] void fail(const Token& at, const std::string& what, const KeyText& next) const {
    const auto before = std::string_view(text_).substr(0, at.begin);
    const auto column = 1 + std::ranges::count_if(before, [](char c) { return !continues_character(c); });
    throw Keyed<InputError>(place_of_expression(text_), "column " + std::to_string(column) + ": " + what, next);
  }
  [[noreturn]] void fail_here(const std::string& expected) const {
    const std::string found = token_.kind == Token::kEnd ? "the expression ends" : "found " + quoted(token_.text);
    const bool begins_value = token_.kind == Token::kNumber || token_.kind == Token::kName || token_.text == "(";
    fail(token_, found + ", expected " + expected,
         std::string(token_.text == "=" ? "give the length alone, and compare with \"==\""
                     : begins_value && expected.find("operator") != std::string::npos ? "products need a \"*\""
                                                                                      : kExample));
  }
  [[noreturn]] void fail_nesting() const {
    fail(token_, "it is nested too deeply", "simplify it, or give a background mesh or a raster instead");
  }
  [[noreturn]] void fail_unknown(const Token& name) const {
    std::vector<std::string> names = known_names();
    const std::vector<std::string> rasters = raster_names();
    names.insert(names.begin() + 2, rasters.begin(), rasters.end());
    const std::string suggested = suggestion(name.text, names);
    fail(name, quoted(name.text) + " is not known" + suggested,
         suggested.empty() ? "it may use " + listed(names) : "driftmesh config --functions lists the functions");
  }
  static std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
    const std::string probable = probable_name(std::string(name), known);
    return probable.empty() ? "" : " (did you mean " + probable + "?)";
  }
  std::vector<std::string> raster_names() const {
    std::vector<std::string> names;
    for (const NamedRaster& raster : rasters_) names.push_back(raster.name);
    return names;
  }

  const std::string& text_;
  const Pslg* input_;
  const NamedRasters& rasters_;
  const FindOutline& outline_;
  Token token_;
  std::vector<ExpressionStep> steps_;
  std::vector<std::shared_ptr<const PlaneFunction>> functions_;
  std::map<std::vector<std::int32_t>, std::shared_ptr<const PlaneFunction>> distances_;
  std::shared_ptr<const PlaneFunction> width_, curvature_;
  std::size_t nesting_ = 0;
  int depth_ = 0;  // values on the stack
};

}  // namespace

ParsedExpression parse_expression(const std::string& text, const Pslg* input, const NamedRasters& rasters,
                                  const FindOutline& outline) {
  return Parser(text, input, rasters, outline).parse();
}

SourcePlace place_of_expression(const std::string& text) {
  constexpr std::size_t kMost = 200;
  return {"size expression " + quoted(text.size() <= kMost ? text : text.substr(0, kMost) + "...")};
}

bool is_known_to_expressions(std::string_view name) {
  const std::vector<std::string> known = known_names();
  return std::ranges::find(known, name) != known.end();
}

}  // namespace driftmesh
