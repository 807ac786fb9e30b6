#include "geom/base/schema.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "geom/base/error.h"
#include "geom/base/number_with_unit.h"

namespace sterna {
namespace {

struct NamedScale {
  std::string_view name;
  double scale;
  Unit dimension;
};
/// SI value of each unit accepted with a number; exact by definition (inch = 25.4 mm, ft = 12 inch).
constexpr std::array<NamedScale, 14> k_units = {{{"m", 1.0, Unit::metre},
                                                 {"mm", 1e-3, Unit::metre},
                                                 {"um", 1e-6, Unit::metre},
                                                 {"cm", 1e-2, Unit::metre},
                                                 {"inch", 0.0254, Unit::metre},
                                                 {"in", 0.0254, Unit::metre},
                                                 {"ft", 0.3048, Unit::metre},
                                                 {"deg", std::numbers::pi / 180.0, Unit::radian},
                                                 {"rad", 1.0, Unit::radian},
                                                 {"s", 1.0, Unit::second},
                                                 {"kB", 1e3, Unit::byte},
                                                 {"MB", 1e6, Unit::byte},
                                                 {"GB", 1e9, Unit::byte},
                                                 {"K", 1.0, k_kelvin}}};

std::string_view dimension_text(Unit dimension) {
  if (dimension == k_kelvin) return "a temperature";
  switch (dimension) {
    case Unit::none: return "a number without a unit";
    case Unit::metre: return "a length";
    case Unit::radian: return "an angle";
    case Unit::second: return "a time";
    case Unit::byte: return "a number of bytes";
  }
  return "";
}

/// Returns "a length (m, mm, cm, inch, in, ft)".
std::string expected_text(Unit dimension) {
  std::string units;
  for (const NamedScale& known : k_units)
    if (known.dimension == dimension) units += (units.empty() ? "" : ", ") + std::string(known.name);
  const std::string what(dimension_text(dimension));
  return units.empty() ? what : what + " (" + units + ")";
}

std::string option_number_text(double value) {
  if (is_automatic(value)) return "automatic";
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

std::string vector_text(const Vec3& v) { return "{" + option_number_text(v.x) + ", " + option_number_text(v.y) + ", " + option_number_text(v.z) + "}"; }

std::string value_text(const OptionValue& value) {
  return std::visit(
      [](const auto& v) -> std::string {
        using V = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<V, bool>) return v ? "true" : "false";
        else if constexpr (std::is_same_v<V, double>) return option_number_text(v);
        else if constexpr (std::is_same_v<V, std::string>) return "\"" + v + "\"";
        else if constexpr (std::is_same_v<V, std::int64_t>) return std::to_string(v);
        else if constexpr (std::is_same_v<V, Vec3>) return vector_text(v);
        else if constexpr (std::is_same_v<V, std::monostate>) return "no vector";
        else return "a list of " + std::to_string(v.size());
      },
      value);
}

/// Formats a value with the unit used in input: angles in degrees, to six digits, which hides the rounding of the conversion.
std::string display_text(double value, Unit unit) {
  if (unit != Unit::radian) return option_number_text(value) + (unit == Unit::none ? "" : " " + std::string(to_string(unit)));
  std::ostringstream text;
  text << value * 180.0 / std::numbers::pi << " deg";
  return text.str();
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const auto end = std::min(text.find(' '), text.size());
    if (end > 0) words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

/// Returns the number assigned to a name in the choices "coarse=0.5 fine=2".
std::optional<double> named_number(std::string_view choices, std::string_view name) {
  for (const std::string& choice : split(choices)) {
    const std::size_t equals = choice.find('=');
    if (equals == name.size() && choice.compare(0, equals, name) == 0) return std::stod(choice.substr(equals + 1));
  }
  return std::nullopt;
}

/// Returns "coarse, fine".
std::string names_of_numbers(std::string_view choices) {
  std::string text;
  for (const std::string& choice : split(choices)) text += (text.empty() ? "" : ", ") + choice.substr(0, choice.find('='));
  return text;
}

[[noreturn]] void reject(const Option& option, const std::string& given, const std::string& expected) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "option " + std::string(option.stage) + "." + std::string(option.name),
               .problem = given + " is not allowed, expected " + expected,
               .hint = std::string(option.help)});
}

void check_range(const Option& option, double value) {
  if (is_automatic(value)) {
    if (option.automatic.empty()) reject(option, "\"automatic\"", std::string(kind_text(option.kind)));
    return;
  }
  // Limits of angles are printed in degrees, to six digits; a value typed as printed must be accepted as the limit.
  const double slack = option.unit == Unit::radian ? 5e-6 : 0.0;
  if (value < option.min - slack * std::abs(option.min) || value > option.max + slack * std::abs(option.max) || std::isinf(value))
    reject(option, option_number_text(value) + (option.unit == Unit::radian ? " rad (" + display_text(value, option.unit) + ")" : ""),
           std::string(kind_text(option.kind)) + " in " + option.range_text());
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last, row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::move(last);
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      // Two exchanged letters count as one error.
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view kind_text(OptionKind kind) {
  switch (kind) {
    case OptionKind::boolean: return "true or false";
    case OptionKind::integer: return "a whole number";
    case OptionKind::number: return "a number";
    case OptionKind::string: return "a string";
    case OptionKind::vector: return "{x, y, z}";
    case OptionKind::numbers: return "a list of numbers";
    case OptionKind::vectors: return "a list of points {x, y, z}";
  }
  return "a value";
}

std::string_view to_string(Unit unit) {
  if (unit == k_kelvin) return "K";
  switch (unit) {
    case Unit::none: return "";
    case Unit::metre: return "m";
    case Unit::radian: return "rad";
    case Unit::second: return "s";
    case Unit::byte: return "B";
  }
  return "";
}

bool Option::is_automatic_value(const OptionValue& value) const {
  if (const double* number = std::get_if<double>(&value)) return is_automatic(*number);
  if (const Vec3* vector = std::get_if<Vec3>(&value)) return is_automatic(vector->x);
  const std::int64_t* whole = std::get_if<std::int64_t>(&value);
  return std::holds_alternative<std::monostate>(value) || (whole && !automatic.empty() && *whole == k_automatic_count);
}

bool Option::has_value() const {
  const OptionValue value = get();
  if (is_automatic_value(value)) return false;
  if (const std::string* text = std::get_if<std::string>(&value)) return !text->empty();
  const double* number = std::get_if<double>(&value);
  return !number || (*number >= min && *number <= max);
}

std::string Option::default_text() const {
  if (required) return "required";
  if (is_automatic_value(default_value)) return "automatic (" + std::string(automatic) + ")";
  if (const double* number = std::get_if<double>(&default_value)) return display_text(*number, unit);
  return value_text(default_value);
}

std::string Option::range_text() const {
  if (kind == OptionKind::vector) return std::string(kind_text(kind));
  if (!choices.empty() && kind == OptionKind::number) {
    Option plain = *this;
    plain.choices = {};
    const std::string range = plain.range_text();
    return (range.empty() ? "any number" : range) + ", or " + names_of_numbers(choices);
  }
  if (!choices.empty()) {
    std::string text = "one of";
    for (const std::string& choice : split(choices)) text += (text.size() > 6 ? ", " : " ") + choice;
    return text;
  }
  if (kind == OptionKind::integer && !automatic.empty()) {
    Option plain = *this;
    plain.automatic = {};
    return plain.range_text() + ", or automatic";
  }
  const bool has_min = !std::isinf(min);
  const bool has_max = !std::isinf(max);
  if (has_min && has_max) return (unit == Unit::radian ? display_text(min, unit) : option_number_text(min)) + " .. " + display_text(max, unit);
  if (has_min) return "x >= " + display_text(min, unit);
  if (has_max) return "x <= " + display_text(max, unit);
  return {};
}

void set_option(const Option& option, const OptionValue& value) {
  const std::string expected = std::string(kind_text(option.kind));
  if (option.kind == OptionKind::number && std::holds_alternative<std::int64_t>(value))
    return set_option(option, static_cast<double>(std::get<std::int64_t>(value)));
  if (option.kind == OptionKind::integer && std::holds_alternative<double>(value)) {
    const double number = std::get<double>(value);
    if (number == std::floor(number) && std::abs(number) < 1e15) return set_option(option, static_cast<std::int64_t>(number));
  }
  if (const auto* name = std::get_if<std::string>(&value); name && *name == "automatic") {
    if (option.kind == OptionKind::number) return set_option(option, k_automatic);
    if (option.kind == OptionKind::integer && !option.automatic.empty()) return option.store(std::int64_t{k_automatic_count});
  }
  if (const auto* name = std::get_if<std::string>(&value); name && option.kind == OptionKind::number && !option.choices.empty()) {
    if (const auto number = named_number(option.choices, *name)) return set_option(option, *number);
    reject(option, value_text(value), expected + " or one of " + names_of_numbers(option.choices));
  }
  const bool is_vector = option.kind == OptionKind::vector && std::holds_alternative<Vec3>(value);  // the default may be none
  if (!is_vector && value.index() != option.default_value.index()) reject(option, value_text(value), expected);
  if (is_vector && !is_finite(std::get<Vec3>(value))) reject(option, value_text(value), expected + " of finite numbers");
  if (const double* number = std::get_if<double>(&value)) check_range(option, *number);
  if (const std::int64_t* number = std::get_if<std::int64_t>(&value)) {
    check_range(option, static_cast<double>(*number));
    if (*number > std::numeric_limits<int>::max() || *number < std::numeric_limits<int>::min())
      reject(option, value_text(value), expected + " of at most 2147483647");
  }
  if (const std::string* text = std::get_if<std::string>(&value); text && !option.choices.empty()) {
    const std::vector<std::string> choices = split(option.choices);
    if (std::find(choices.begin(), choices.end(), *text) == choices.end()) reject(option, value_text(value), option.range_text());
  }
  option.store(value);
}

const Option& find_option(const OptionTable& table, std::string_view name, std::string_view attempted) {
  std::vector<std::string> names;
  for (const Option& option : table) {
    const std::string full = std::string(option.stage) + "." + std::string(option.name);
    if (option.name == name || full == name) return option;
    names.push_back(name.find('.') == std::string_view::npos ? std::string(option.name) : full);
  }
  const std::string nearest = nearest_name(name, names);
  throw Error({.code = ErrorCode::unknown_option,
               .attempted = std::string(attempted),
               .problem = "unknown option \"" + std::string(name) + "\"",
               .hint = nearest.empty() ? "help lists the options" : "did you mean \"" + nearest + "\"?"});
}

namespace {

/// Calls parse_number_with_unit and adds the name of the option to errors.
double number_of_text(const Option& option, std::string_view text, BareAngle bare_angle) {
  try {
    return parse_number_with_unit(text, option.unit, bare_angle);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = "option " + std::string(option.stage) + "." + std::string(option.name);
    throw Error(std::move(info));
  }
}

}  // namespace

namespace {

/// Calls number_of_text for each number of a list "1,2,3".
std::vector<double> numbers_of_text(const Option& option, std::string_view text, BareAngle bare_angle) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    numbers.push_back(number_of_text(option, text.substr(begin, end - begin), bare_angle));
    begin = end + 1;
  }
  return numbers;
}

}  // namespace

void set_option_from_text(const Option& option, std::string_view text) { set_option_from_text(option, text, BareAngle::radians); }

void set_option_from_text(const Option& option, std::string_view text, BareAngle bare_angle) {
  switch (option.kind) {
    case OptionKind::boolean:
      if (text != "true" && text != "false") reject(option, "\"" + std::string(text) + "\"", "true or false");
      return set_option(option, text == "true");
    case OptionKind::string: return set_option(option, std::string(text));
    case OptionKind::integer: {
      if (text == "automatic") return set_option(option, std::string(text));
      std::int64_t number = 0;
      const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
      if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) reject(option, "\"" + std::string(text) + "\"", "a whole number");
      return set_option(option, number);
    }
    case OptionKind::number:
      if (text == "automatic") return set_option(option, std::string(text));
      if (!option.choices.empty() && !text.empty() && std::isalpha(static_cast<unsigned char>(text.front()))) return set_option(option, std::string(text));
      return set_option(option, number_of_text(option, text, bare_angle));
    case OptionKind::vector: {
      const std::vector<double> numbers = numbers_of_text(option, text, bare_angle);
      if (numbers.size() != 3) reject(option, "\"" + std::string(text) + "\"", "three numbers, such as 0,0,1");
      return set_option(option, Vec3{numbers[0], numbers[1], numbers[2]});
    }
    case OptionKind::numbers: return set_option(option, numbers_of_text(option, text, bare_angle));
    case OptionKind::vectors: reject(option, "\"" + std::string(text) + "\"", "a list in a script");
  }
}

void require_options(const OptionTable& table, std::string_view attempted) {
  std::string missing;
  for (const Option& option : table) {
    if (option.required && !option.has_value()) missing += (missing.empty() ? "" : ", ") + std::string(option.name) + " (" + std::string(option.help) + ")";
  }
  if (!missing.empty()) throw Error({.code = ErrorCode::bad_argument, .attempted = std::string(attempted), .problem = "needs " + missing});
}

std::string_view detail::choice_at(std::string_view choices, int index) {
  for (; index > 0 && !choices.empty(); --index) choices.remove_prefix(std::min(choices.find(' '), choices.size() - 1) + 1);
  return choices.substr(0, choices.find(' '));
}

int detail::index_of_choice(std::string_view choices, std::string_view name) {
  const std::vector<std::string> names = split(choices);
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t d = edit_distance(name, candidate);
    if (d >= best_distance) continue;
    best_distance = d;
    best = candidate;
  }
  return best;
}

double parse_number_with_unit(std::string_view text, Unit expected, BareAngle bare_angle) {
  const auto fail = [&]() -> double {
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "reading a number",
                 .problem = "\"" + std::string(text) + "\" is not " + expected_text(expected),
                 .hint = expected == Unit::radian  ? "write for example 35*deg"
                         : expected == Unit::metre ? "write for example 2e-6 or 0.5*mm"
                         : expected == Unit::byte  ? "write for example 16GB or 2e9"
                         : expected == k_kelvin    ? "write for example 288.15, in kelvin"
                                                   : "write for example 1.25"});
  };
  double number = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  if (result.ec != std::errc{} || !std::isfinite(number)) return fail();
  std::string_view unit(result.ptr, static_cast<std::size_t>(text.data() + text.size() - result.ptr));
  while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
  if (!unit.empty() && unit.front() == '*') unit.remove_prefix(1);
  while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
  if (unit.empty() && result.ptr != text.data() + text.size()) return fail();
  if (unit.empty() && expected == Unit::radian && bare_angle == BareAngle::degrees) unit = "deg";
  if (unit.empty()) return number;
  for (const NamedScale& known : k_units) {
    if (known.name != unit) continue;
    if (known.dimension == expected) return number * known.scale;
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "reading a number",
                 .problem = "\"" + std::string(text) + "\" is " + std::string(dimension_text(known.dimension)) + ", expected " + expected_text(expected)});
  }
  return fail();
}

namespace {

using OptionJson = nlohmann::ordered_json;

OptionJson json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

OptionJson json_of(const OptionValue& value) {
  return std::visit(
      [](const auto& v) -> OptionJson {
        using V = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<V, Vec3>) return json_of(v);
        else if constexpr (std::is_same_v<V, std::monostate>) return nullptr;
        else if constexpr (std::is_same_v<V, std::vector<Vec3>>) {
          OptionJson list = OptionJson::array();
          for (const Vec3& point : v) list.push_back(json_of(point));
          return list;
        } else return v;
      },
      value);
}

bool is_empty_list(const OptionValue& value) {
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  const auto* vectors = std::get_if<std::vector<Vec3>>(&value);
  return (numbers && numbers->empty()) || (vectors && vectors->empty());
}

Vec3 vector_of(const OptionJson& json) {
  if (json.size() != 3) throw std::invalid_argument("a point has three coordinates");
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

void set_from_json(const Option& option, const OptionJson& json) {
  switch (option.kind) {
    case OptionKind::vector: return set_option(option, vector_of(json));
    case OptionKind::numbers: return set_option(option, json.get<std::vector<double>>());
    case OptionKind::vectors: {
      std::vector<Vec3> points;
      for (const OptionJson& point : json) points.push_back(vector_of(point));
      return set_option(option, std::move(points));
    }
    default: return set_option_from_text(option, json.is_string() ? json.get<std::string>() : json.dump());
  }
}

}  // namespace

std::string value_to_json(const OptionTable& table) {
  OptionJson json = OptionJson::object();
  for (const Option& option : table)
    if (const OptionValue value = option.get(); option.has_value() && !is_empty_list(value)) json[std::string(option.name)] = json_of(value);
  return json.dump();
}

void set_value_from_json(const OptionTable& table, std::string_view json, std::string_view attempted) {
  try {
    const OptionJson object = OptionJson::parse(json);
    if (!object.is_object()) throw std::invalid_argument("expected an object, not " + std::string(json));
    for (const auto& [name, value] : object.items()) set_from_json(find_option(table, name, attempted), value);
  } catch (const std::invalid_argument& error) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = std::string(attempted), .problem = error.what()});
  } catch (const OptionJson::exception& error) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = std::string(attempted), .problem = error.what()});
  }
}

std::vector<std::string> elements_of_json(std::string_view json, std::string_view attempted) {
  const OptionJson list = OptionJson::parse(json, nullptr, false);
  if (!list.is_array()) throw Error({.code = ErrorCode::bad_argument, .attempted = std::string(attempted), .problem = "expected a JSON list"});
  std::vector<std::string> elements;
  for (const OptionJson& element : list) elements.push_back(element.dump());
  return elements;
}

std::string list_to_json(std::span<const std::string> elements) {
  std::string text = "[";
  for (const std::string& element : elements) text += (text.size() > 1 ? "," : "") + element;
  return text + "]";
}

std::string options_to_json(const OptionTable& table) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Option& option : table) {
    auto& entry = json[std::string(option.stage)][std::string(option.name)];
    const OptionValue current = option.get();
    if (option.is_automatic_value(current)) {
      entry = "automatic";
      continue;
    }
    entry = json_of(current);
  }
  return json.dump(2);
}

std::string options_help(const OptionTable& table) {
  std::string text;
  for (const Option& option : table) {
    const std::string value = option.default_text();
    text += "  " + std::string(option.name) + " = " + value;
    if (option.unit != Unit::none && std::isalpha(static_cast<unsigned char>(value.front()))) text += " [" + std::string(to_string(option.unit)) + "]";
    if (const std::string range = option.range_text(); !range.empty()) text += "  (" + range + ")";
    text += "\n      " + std::string(option.help) + "\n";
  }
  return text;
}

}  // namespace sterna
