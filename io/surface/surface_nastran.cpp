// A card consists of fields: of eight columns each, of sixteen if the name ends in '*', or separated by commas. Lines that begin with a blank field, '+' or '*'
// continue a card.
#include "io/surface/surface_nastran.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/input/file_buffer.h"
#include "io/input/left_out.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/names/name_rules.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_field = 8;
constexpr std::size_t k_large_field = 16;
constexpr std::size_t k_line = 80;
constexpr std::int64_t k_max_nastran_id = 99999999;  // eight characters

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view() : text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

bool begins_with_word(std::string_view line, std::string_view word) { return equal_ignoring_case(without_blanks(line).substr(0, word.size()), word); }

/// Parses a number: "1.5-3" is 1.5e-3, "1.D3" is 1e3.
bool parse_real(std::string_view field, double& value) {
  std::string text;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const char c = field[i];
    const bool is_sign = c == '+' || c == '-';
    if (i == 0 && c == '+') continue;
    if (c == 'd' || c == 'D' || c == 'e' || c == 'E') {
      text += 'e';
    } else {
      if (is_sign && !text.empty() && text.back() != 'e') text += 'e';
      if (!(c == '+' && !text.empty())) text += c;
    }
  }
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && failure == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

/// Returns true for "NaN", "-Inf", "Infinity", "1.#QNAN".
bool is_not_finite_text(std::string_view field, double& value) {
  const std::string_view bare = field.starts_with('+') || field.starts_with('-') ? field.substr(1) : field;
  value = std::numeric_limits<double>::quiet_NaN();
  return equal_ignoring_case(bare.substr(0, 3), "nan") || equal_ignoring_case(bare.substr(0, 3), "inf") || bare.starts_with("1.#");
}

/// Meaning of an element card for surfaces.
struct ElementCard {
  std::string_view name;
  std::size_t n_corners;  ///< 0: a volume element
};
constexpr std::array<ElementCard, 12> k_elements = {{{"CTRIA3", 3},
                                                     {"CTRIA6", 3},
                                                     {"CTRIAR", 3},
                                                     {"CQUAD4", 4},
                                                     {"CQUAD8", 4},
                                                     {"CQUADR", 4},
                                                     {"CQUAD", 4},
                                                     {"CTETRA", 0},
                                                     {"CPENTA", 0},
                                                     {"CPYRAM", 0},
                                                     {"CPYRA", 0},
                                                     {"CHEXA", 0}}};

/// Returns true for cards of elements that are neither faces nor volumes of a mesh, and for cards of unsupported faces.
bool is_other_element(std::string_view name) {
  constexpr std::array<std::string_view, 20> k_names = {"CBAR",   "CBEAM",  "CROD",    "CONROD", "CTUBE",   "CBEND",   "CBUSH",   "CELAS1", "CELAS2", "CELAS3",
                                                        "CSHEAR", "CTRIAX", "CTRIAX6", "CQUADX", "CQUADX4", "CQUADX8", "CTRIAX3", "PLOTEL", "CAERO1", "CAERO2"};
  return std::any_of(k_names.begin(), k_names.end(), [&](std::string_view known) { return equal_ignoring_case(name, known); });
}

struct NastranFace {
  std::array<std::int64_t, 4> nodes{};
  std::size_t n_corners = 3;
  std::int64_t pid = 0;
  std::size_t line = 0;
};

class BulkParser {
 public:
  BulkParser(const FileBuffer& buffer, const RunContext& context) : buffer_(buffer), text_(buffer.text()), context_(context), builder_(buffer.source) {}

  SurfaceSoup parse() {
    const bool has_begin = find_bulk();
    bool has_end = false;
    while (!has_end && next_line()) {
      if (line_number_ % k_stop_interval == 0) context_.check_stop();
      if (line_.starts_with('$')) {
        take_comment();
      } else if (begins_with_word(line_, "ENDDATA")) {
        has_end = true;
      } else if (!without_blanks(line_).empty()) {
        take_line();
      }
    }
    take_card();
    // Files meant for inclusion in others have neither beginning nor end.
    if (has_begin && !has_end)
      throw_malformed(buffer_.source, "line " + std::to_string(line_number_), "found the end of the file, expected ENDDATA after BEGIN BULK",
                      "the file may have been cut short: copy or write it again");
    if (!has_end) context_.warn(buffer_.source + ": there is no ENDDATA; the file may be incomplete");
    curved_.warn(buffer_.source, context_);
    elements_.warn(buffer_.source, context_);
    add_faces();
    SurfaceSoup soup = builder_.finish(context_, n_volumes_ > 0);
    soup.n_cells = n_volumes_;
    soup.has_names = soup.patch_names.size() > 1 || !names_.empty();
    return soup;
  }

 private:
  // ---- lines

  bool next_line() {
    if (position_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find_first_of("\r\n", position_), text_.size());
    line_ = text_.substr(position_, end - position_);
    position_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
    ++line_number_;
    return true;
  }

  /// Finds the bulk data. Executive and case control precede "BEGIN BULK", if present.
  bool find_bulk() {
    while (next_line())
      if (begins_with_word(line_, "BEGIN") && without_blanks(without_blanks(line_).substr(5)).size() >= 4 &&
          equal_ignoring_case(without_blanks(without_blanks(line_).substr(5)).substr(0, 4), "BULK"))
        return true;
    position_ = line_number_ = 0;
    return false;
  }

  void take_line() {
    const bool is_continuation = line_[0] == '+' || line_[0] == '*' || line_[0] == ',' || without_blanks(line_.substr(0, k_field)).empty();
    if (!is_continuation) {
      take_card();
      card_line_ = line_number_;
    } else if (fields_.empty()) {
      fail(line_number_, "found a continuation, expected the beginning of a card");
    }
    line_.find(',') != std::string_view::npos ? take_free_fields(is_continuation) : take_columns(is_continuation);
  }

  void take_free_fields(bool is_continuation) {
    std::string_view rest = line_;
    const auto next = [&rest] {
      const std::size_t end = std::min(rest.find(','), rest.size());
      const std::string_view field = without_blanks(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      return field;
    };
    const std::string_view name = next();
    if (!is_continuation) fields_.emplace_back(name);
    const std::size_t n_fields = name.ends_with('*') ? 4 : 8;
    for (std::size_t i = 0; i < n_fields; ++i) fields_.emplace_back(next());
  }

  void take_columns(bool is_continuation) {
    std::string expanded;
    if (line_.find('\t') != std::string_view::npos) {
      for (const char c : line_) {
        if (c == '\t') expanded.append(k_field - expanded.size() % k_field, ' ');
        else expanded += c;
        if (expanded.size() > k_line) break;
      }
      line_ = expanded;
    }
    const std::string_view name = without_blanks(line_.substr(0, k_field));
    const bool is_large = name.ends_with('*') || name.starts_with('*');
    if (!is_continuation) fields_.emplace_back(name);
    const std::size_t width = is_large ? k_large_field : k_field;
    for (std::size_t at = k_field; at < k_line - k_field; at += width)
      fields_.emplace_back(at < line_.size() ? without_blanks(line_.substr(at, std::min(width, k_line - k_field - at))) : std::string_view());
  }

  /// Reads name comments: "$ANSA_NAME_COMMENT;7;PSHELL;left wing;..." and "$HMNAME COMP  7"left wing"" name the PID 7.
  void take_comment() {
    if (equal_ignoring_case(line_.substr(0, 19), "$ANSA_NAME_COMMENT;")) {
      std::string_view rest = line_.substr(19);
      const std::size_t kind = rest.find(';');
      const std::size_t name = kind == std::string_view::npos ? kind : rest.find(';', kind + 1);
      if (name == std::string_view::npos || !equal_ignoring_case(rest.substr(kind + 1, name - kind - 1), "PSHELL")) return;
      add_name(rest.substr(0, kind), rest.substr(name + 1, rest.find(';', name + 1) - name - 1));
    } else if (begins_with_word(line_, "$HMNAME COMP") || begins_with_word(line_, "$HMNAME PROP")) {
      const std::size_t open = line_.find('"');
      const std::size_t close = open == std::string_view::npos ? open : line_.find('"', open + 1);
      if (close != std::string_view::npos) add_name(line_.substr(12, open - 12), line_.substr(open + 1, close - open - 1));
    }
  }

  void add_name(std::string_view number, std::string_view name) {
    std::int64_t pid = 0;
    number = without_blanks(number);
    const auto [end, failure] = std::from_chars(number.data(), number.data() + number.size(), pid);
    if (failure == std::errc{} && end == number.data() + number.size() && !name.empty()) names_.try_emplace(pid, name);
  }

  // ---- cards

  void take_card() {
    if (fields_.empty()) return;
    std::string_view name = fields_[0];
    if (name.ends_with('*')) name.remove_suffix(1);
    name = without_blanks(name);
    if (equal_ignoring_case(name, "GRID")) {
      take_grid();
    } else if (equal_ignoring_case(name, "GRDSET")) {
      if (!field(2).empty() && field(2) != "0")
        throw_unsupported(buffer_.source, "line " + std::to_string(card_line_) + ": GRDSET with a coordinate system", "write the points in the basic system");
    } else if (begins_with_word(name, "INCLUDE")) {
      throw_unsupported(buffer_.source, "line " + std::to_string(card_line_) + ": INCLUDE", "join the files into one file");
    } else {
      const auto is_name = [&](const ElementCard& element) { return equal_ignoring_case(name, element.name); };
      const auto element = std::find_if(k_elements.begin(), k_elements.end(), is_name);
      if (element != k_elements.end()) take_element(element->n_corners);
      else if (is_other_element(name)) elements_.add("elements " + std::string(name));
      if (equal_ignoring_case(name, "CTRIA6") || equal_ignoring_case(name, "CQUAD8") || equal_ignoring_case(name, "CQUAD"))
        curved_.add("second-order faces by their mid-side nodes, which become flat");
    }
    fields_.clear();
  }

  std::string_view field(std::size_t i) const { return i < fields_.size() ? std::string_view(fields_[i]) : std::string_view(); }

  std::int64_t integer(std::size_t i, std::string_view expected) const {
    const std::string_view text = field(i).starts_with('+') ? field(i).substr(1) : field(i);
    std::int64_t value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || failure != std::errc{} || end != text.data() + text.size())
      fail(card_line_,
           "found " + quoted_excerpt(field(i)) + " in field " + std::to_string(i + 1) + " of " + fields_[0] + ", expected " + std::string(expected));
    return value;
  }

  void take_grid() {
    const std::int64_t id = integer(1, "the number of a point");
    if (!field(2).empty() && integer(2, "a coordinate system") != 0)
      throw_unsupported(
          buffer_.source,
          "line " + std::to_string(card_line_) + ": the point " + std::to_string(id) + " is given in the coordinate system " + std::string(field(2)),
          "write the points in the basic system (0)");
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view text = field(3 + axis);
      if (!text.empty() && !parse_real(text, p[axis]) && !is_not_finite_text(text, p[axis]))
        fail(card_line_, "found " + quoted_excerpt(text) + " in field " + std::to_string(4 + axis) + " of GRID, expected a coordinate");
    }
    const auto [entry, is_new] = point_of_id_.try_emplace(id, static_cast<std::uint32_t>(builder_.n_points()));
    if (!is_new) fail(card_line_, "a second point " + std::to_string(id));
    builder_.add_point(p);
  }

  void take_element(std::size_t n_corners) {
    if (n_corners == 0) {
      ++n_volumes_;
      return;
    }
    NastranFace face{.n_corners = n_corners, .line = card_line_};
    const std::int64_t eid = integer(1, "the number of an element");
    face.pid = field(2).empty() ? eid : integer(2, "the number of a property");
    for (std::size_t k = 0; k < n_corners; ++k) face.nodes[k] = integer(3 + k, "the number of a point");
    faces_.push_back(face);
  }

  void add_faces() {
    std::int64_t pid = 0;
    std::array<std::uint32_t, 4> corners{};
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const NastranFace& face = faces_[i];
      if (i == 0 || face.pid != pid) {
        const auto name = names_.find(face.pid);
        builder_.set_patch(name == names_.end() ? numbered_patch(face.pid) : name->second);
        pid = face.pid;
      }
      for (std::size_t k = 0; k < face.n_corners; ++k) {
        const auto found = point_of_id_.find(face.nodes[k]);
        if (found == point_of_id_.end()) fail(face.line, "found the point " + std::to_string(face.nodes[k]) + ", which no GRID defines");
        corners[k] = found->second;
      }
      builder_.add_polygon(std::span(corners).first(face.n_corners));
    }
  }

  [[noreturn]] void fail(std::size_t line, const std::string& problem) const { throw_malformed(buffer_.source, "line " + std::to_string(line), problem); }

  const FileBuffer& buffer_;
  std::string_view text_;
  const RunContext& context_;
  SurfaceBuilder builder_;
  std::size_t position_ = 0, line_number_ = 0;
  std::string_view line_;
  std::vector<std::string> fields_;  ///< fields of the current card; the first is its name
  std::size_t card_line_ = 0;
  std::unordered_map<std::int64_t, std::uint32_t> point_of_id_;
  std::vector<NastranFace> faces_;
  std::map<std::int64_t, std::string> names_;  ///< by PID
  std::size_t n_volumes_ = 0;
  LeftOut curved_, elements_;
};

// ---- writing

/// Returns the closest number that 16 characters can hold. It is written without 'e' in the exponent and without a zero before the decimal point.
std::string large_field(double value) {
  const auto shortened = [](std::string text) {
    const std::size_t e = text.find('e');
    std::string mantissa = text.substr(0, e);
    if (mantissa.find('.') == std::string::npos) mantissa += '.';
    if (mantissa.starts_with("0.") && mantissa.size() > 2) mantissa.erase(0, 1);
    if (mantissa.starts_with("-0.") && mantissa.size() > 3) mantissa.erase(1, 1);
    if (e == std::string::npos) return mantissa;
    std::string exponent = text.substr(e + 1);  // "+05", "-12", "+103"
    while (exponent.size() > 2 && exponent[1] == '0') exponent.erase(1, 1);
    return mantissa + exponent;
  };
  const auto formatted = [&](std::chars_format format, int precision) {
    std::array<char, 512> room;
    return shortened({room.data(), std::to_chars(room.data(), room.data() + room.size(), value, format, precision).ptr});
  };
  std::string best;
  double best_error = std::numeric_limits<double>::infinity();
  constexpr int k_most_digits = 17;
  for (const std::chars_format format : {std::chars_format::fixed, std::chars_format::scientific}) {
    for (int precision = k_most_digits; precision >= 0; --precision) {
      const std::string text = formatted(format, precision);
      if (text.size() > k_large_field) continue;
      double back = 0.0;
      if (parse_real(text, back) && std::abs(back - value) < best_error) {
        best = text;
        best_error = std::abs(back - value);
      }
      break;
    }
  }
  return best;
}

char* put_right(char* at, std::string_view text, std::size_t width) {
  at = std::fill_n(at, width - text.size(), ' ');
  return put_text(at, text);
}
char* put_id(char* at, std::int64_t id, std::size_t width) { return put_right(at, std::to_string(id), width); }

OutputSection grid_cards(const TriMesh& mesh) {
  constexpr std::size_t k_card = 2 * (k_line + 1);
  return items_section(mesh.n_vertices(), k_card, [&mesh](std::uint64_t i, char* at) {
    const Point& p = mesh.points.raw()[i];
    at = put_id(put_text(at, "GRID*   "), static_cast<std::int64_t>(i + 1), k_large_field);
    at = std::fill_n(at, k_large_field, ' ');
    at = put_right(at, large_field(p.x), k_large_field);
    at = put_right(at, large_field(p.y), k_large_field);
    at = put_right(put_text(at, "*\n*       "), large_field(p.z), k_large_field);
    *at++ = '\n';
    return at;
  });
}

OutputSection triangle_cards(const TriMesh& mesh) {
  return items_section(mesh.n_triangles(), k_line + 1, [&mesh](std::uint64_t i, char* at) {
    at = put_id(put_text(at, "CTRIA3  "), static_cast<std::int64_t>(i + 1), k_field);
    at = put_id(at, patch_number(mesh, TriangleId(i)), k_field);
    for (const VertexId v : mesh.triangles.raw()[i]) at = put_id(at, static_cast<std::int64_t>(v.value()) + 1, k_field);
    *at++ = '\n';
    return at;
  });
}

std::string property_cards(const TriMesh& mesh, const RunContext& context) {
  const std::vector<std::string> names = names_by_rules(mesh.patches, {.format = "Nastran", .forbidden = "\";"}, context);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string id = std::to_string(i + 1);
    text += "$ANSA_NAME_COMMENT;" + id + ";PSHELL;" + names[i] + ";;NO;NO;NO;NO;\n$HMNAME COMP " + id + "\"" + names[i] + "\"\n";
    text += "PSHELL  " + std::string(k_field - id.size(), ' ') + id + "       1      1.\n";
  }
  return text;
}

}  // namespace

SurfaceSoup read_nastran(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  return BulkParser(buffer, context).parse();
}

void write_nastran(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  for (const std::size_t n : {mesh.n_vertices(), mesh.n_triangles(), mesh.patches.size()})
    require_count(n, k_max_nastran_id, "items", "Nastran", path.string());
  context.info(path.string() + ": Nastran keeps 10 to 15 digits of a coordinate");
  write_file(path,
             {fixed_section("BEGIN BULK\n"), fixed_section(property_cards(mesh, context)), grid_cards(mesh), triangle_cards(mesh), fixed_section("ENDDATA\n")},
             context);
}

}  // namespace sterna::io
