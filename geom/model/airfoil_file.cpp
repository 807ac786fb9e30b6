// Steps: split the text into lines of two numbers, detect the layout, order the points around the section, scale them to the chord, correct the orientation,
// and check the shape.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include "geom/base/error.h"
#include "geom/model/airfoil_parts.h"

namespace sterna {
namespace {

/// Lines of text before the points (name, remarks).
constexpr int k_max_header_lines = 12;
/// A chord within these limits counts as 1, except for rounding and conventions of file writers: such files are not scaled.
constexpr double k_least_unit_chord = 0.95, k_greatest_unit_chord = 1.05;
/// Radians. A polyline that turns by more at a point reverses its direction (sumo's limit: 175 degrees).
constexpr double k_sharpest_turn = 3.0543;
constexpr std::size_t k_fewest_points = 5;

struct NumberedPoint {
  Uv p;
  int line = 0;
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& attempted) : attempted_(attempted) {
    int number = 0;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++number;
      while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
      while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
      lines_.push_back({line, number});
    }
  }

  Airfoil airfoil() {
    read_header();
    read_points();
    const bool is_lednicer = !counts_.empty() || looks_like_lednicer();
    std::vector<NumberedPoint> around = is_lednicer ? from_lednicer() : points_;
    scale(around);
    orient(around);
    check_shape(around);
    std::vector<Uv> points;
    for (const NumberedPoint& p : around) points.push_back(p.p);
    return airfoil_parts::make(name_, points);
  }

 private:
  struct Line {
    std::string_view text;
    int number;
  };
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';' || c == '\x1a' || c == '\f'; }

  [[noreturn]] void fail(int line, const std::string& problem) const {
    throw Error({.code = ErrorCode::file_malformed,
                 .attempted = attempted_,
                 .problem = (line > 0 ? "line " + std::to_string(line) + ": " : std::string()) + problem,
                 .hint =
                     "an airfoil file holds a name and then x z per line, from the trailing edge over the upper side (Selig), or counts and each side from the "
                     "leading edge (Lednicer)"});
  }

  /// Returns the numbers of a line; nothing if any of its words is not a number.
  static std::optional<std::vector<double>> numbers(std::string_view text) {
    std::vector<double> result;
    while (!text.empty()) {
      std::size_t end = 0;
      while (end < text.size() && !is_blank(text[end])) ++end;
      std::string_view word = text.substr(0, end);
      if (word.front() == '+') word.remove_prefix(1);
      double value = 0.0;
      const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc{} || next != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
      result.push_back(value);
      text.remove_prefix(end);
      while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    }
    return result;
  }

  void read_header() {
    for (at_ = 0; at_ < lines_.size(); ++at_) {
      const auto values = numbers(lines_[at_].text);
      if (!lines_[at_].text.empty() && values && values->size() == 2) return;
      if (name_.empty()) name_ = std::string(lines_[at_].text);
      if (lines_[at_].number > k_max_header_lines)
        fail(lines_[at_].number, "no line of two numbers in the first " + std::to_string(k_max_header_lines) + " lines");
    }
    if (lines_.empty()) fail(0, "the file is empty");
    fail(lines_.back().number, "the file ends here and holds no points");
  }

  void read_points() {
    for (; at_ < lines_.size(); ++at_) {
      const Line& line = lines_[at_];
      if (line.text.empty() || line.text.front() == '#' || line.text.front() == '!') continue;
      const auto values = numbers(line.text);
      if (!values) fail(line.number, "\"" + std::string(line.text) + "\" is not two numbers");
      if (values->size() != 2) fail(line.number, std::to_string(values->size()) + " numbers, expected 2");
      const double x = (*values)[0], z = (*values)[1];
      if (points_.empty() && counts_.empty() && x > 1.5 && z > 1.5) {  // these are Lednicer's counts: the first point of a section is never in this range
        if (x != std::floor(x) || z != std::floor(z) || x > 1e5 || z > 1e5) fail(line.number, "counts of points that are not whole numbers");
        counts_ = {static_cast<std::size_t>(x), static_cast<std::size_t>(z)};
        continue;
      }
      points_.push_back({{x, z}, line.number});
    }
    if (points_.size() < k_fewest_points)
      fail(points_.empty() ? lines_.back().number : points_.back().line,
           std::to_string(points_.size()) + " points, at least " + std::to_string(k_fewest_points) + " are needed");
    if (!counts_.empty() && counts_[0] + counts_[1] != points_.size())
      fail(points_.back().line,
           "the counts give " + std::to_string(counts_[0]) + " + " + std::to_string(counts_[1]) + " points, the file holds " + std::to_string(points_.size()));
  }

  /// Returns true if both sides run aft from the leading edge: x decreases once, by most of the chord.
  bool looks_like_lednicer() {
    const double chord = chord_of(points_);
    if (!(points_.front().p.u < points_[points_.size() / 4].p.u)) return false;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      if (points_[i].p.u - points_[i - 1].p.u > -0.9 * chord) continue;
      counts_ = {i, points_.size() - i};
      return true;
    }
    return false;
  }

  std::vector<NumberedPoint> from_lednicer() const {
    const auto middle = points_.begin() + static_cast<std::ptrdiff_t>(counts_[0]);
    for (const auto& [begin, end] : {std::pair{points_.begin(), middle}, std::pair{middle, points_.end()}})
      if (end - begin < 2 || !(begin->p.u < (end - 1)->p.u))
        fail(begin == points_.end() ? points_.back().line : begin->line, "the points of this side do not run aft from the leading edge");
    std::vector<NumberedPoint> around(points_.begin(), middle);
    std::reverse(around.begin(), around.end());
    const bool repeats_nose = around.back().p == middle->p;
    around.insert(around.end(), middle + (repeats_nose ? 1 : 0), points_.end());
    return around;
  }

  static double chord_of(const std::vector<NumberedPoint>& points) {
    const auto [low, high] = std::minmax_element(points.begin(), points.end(), [](const NumberedPoint& a, const NumberedPoint& b) { return a.p.u < b.p.u; });
    return high->p.u - low->p.u;
  }

  void scale(std::vector<NumberedPoint>& points) const {
    const double chord = chord_of(points);
    if (!(chord > 0.0)) fail(points.front().line, "all points have the same x");
    if (chord > k_least_unit_chord && chord < k_greatest_unit_chord) return;
    double nose = points.front().p.u;
    for (const NumberedPoint& p : points) nose = std::min(nose, p.p.u);
    for (NumberedPoint& p : points) p.p = {(p.p.u - nose) / chord, p.p.v / chord};
  }

  static void orient(std::vector<NumberedPoint>& points) {
    double area = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Uv a = points[i].p, b = points[(i + 1) % points.size()].p;
      area += a.u * b.v - b.u * a.v;
    }
    if (area < 0.0) std::reverse(points.begin(), points.end());
  }

  void check_shape(std::vector<NumberedPoint>& points) const {
    std::vector<NumberedPoint> distinct;
    for (const NumberedPoint& p : points)
      if (distinct.empty() || std::hypot(p.p.u - distinct.back().p.u, p.p.v - distinct.back().p.v) > airfoil_parts::k_same_point) distinct.push_back(p);
    if (distinct.size() < k_fewest_points)
      fail(points.front().line, std::to_string(distinct.size()) + " different points, at least " + std::to_string(k_fewest_points) + " are needed");
    for (std::size_t i = 1; i + 1 < distinct.size(); ++i) {
      const Uv a = distinct[i].p - distinct[i - 1].p, b = distinct[i + 1].p - distinct[i].p;
      const double turn = std::abs(std::atan2(a.u * b.v - a.v * b.u, a.u * b.u + a.v * b.v));
      if (turn > k_sharpest_turn)
        fail(distinct[i].line, "the section turns back on itself here, by " + std::to_string(static_cast<int>(turn * 57.29577951)) + " degrees");
    }
    std::vector<Uv> plain;
    for (const NumberedPoint& p : distinct) plain.push_back(p.p);
    const std::size_t nose = airfoil_parts::least_x(plain);
    if (nose == 0 || nose + 1 == plain.size()) fail(distinct[nose].line, "the points do not run around the section: the first or last point is the foremost");
    constexpr double k_open_ends = 0.25;  // relative to the chord
    if (std::abs(plain.front().u - plain.back().u) > k_open_ends)
      fail(distinct.back().line, "the two ends of the section are apart: x = " + std::to_string(plain.front().u) + " and " + std::to_string(plain.back().u));
  }

  std::string attempted_, name_;
  std::vector<Line> lines_;
  std::size_t at_ = 0;
  std::vector<std::size_t> counts_;
  std::vector<NumberedPoint> points_;
};

}  // namespace

Airfoil parse_airfoil(std::string_view text, const std::string& attempted) { return Parser(text, attempted).airfoil(); }

Airfoil read_airfoil(const std::filesystem::path& path) {
  const std::string attempted = "reading airfoil " + path.string();
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error({.code = ErrorCode::file_not_found, .attempted = attempted, .problem = "the file does not exist or cannot be read"});
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  Airfoil airfoil = parse_airfoil(text, attempted);
  if (airfoil.name.empty()) airfoil.name = path.stem().string();
  return airfoil;
}

}  // namespace sterna
