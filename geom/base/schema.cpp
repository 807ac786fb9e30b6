#include "geom/base/schema.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>

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

std::string value_text(const OptionValue& value) {
  return std::visit(
      [](const auto& v) -> std::string {
        using V = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<V, bool>) return v ? "true" : "false";
        else if constexpr (std::is_same_v<V, double>) return option_number_text(v);
        else if constexpr (std::is_same_v<V, std::string>) return "\"" + v + "\"";
        else return std::to_string(v);
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

std::string_view kind_text(OptionKind kind) {
  switch (kind) {
    case OptionKind::boolean: return "true or false";
    case OptionKind::integer: return "a whole number";
    case OptionKind::number: return "a number";
    case OptionKind::text: return "a string";
  }
  return "";
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
  const std::int64_t* whole = std::get_if<std::int64_t>(&value);
  return whole && !automatic.empty() && *whole == k_automatic_count;
}

std::string Option::default_text() const {
  if (required) return "required";
  if (is_automatic_value(default_value)) return "automatic (" + std::string(automatic) + ")";
  if (const double* number = std::get_if<double>(&default_value)) return display_text(*number, unit);
  return value_text(default_value);
}

std::string Option::range_text() const {
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
  if (value.index() != option.default_value.index()) reject(option, value_text(value), expected);
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

void set_option_from_text(const Option& option, std::string_view text) { set_option_from_text(option, text, BareAngle::radians); }

void set_option_from_text(const Option& option, std::string_view text, BareAngle bare_angle) {
  switch (option.kind) {
    case OptionKind::boolean:
      if (text != "true" && text != "false") reject(option, "\"" + std::string(text) + "\"", "true or false");
      return set_option(option, text == "true");
    case OptionKind::text: return set_option(option, std::string(text));
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
  }
}

void require_options(const OptionTable& table, std::string_view attempted) {
  std::string missing;
  for (const Option& option : table) {
    if (!option.required) continue;
    const OptionValue value = option.get();
    const double* number = std::get_if<double>(&value);
    const std::string* text = std::get_if<std::string>(&value);
    if ((number && is_automatic(*number)) || (text && text->empty()))
      missing += (missing.empty() ? "" : ", ") + std::string(option.name) + " (" + std::string(option.help) + ")";
  }
  if (!missing.empty()) throw Error({.code = ErrorCode::bad_argument, .attempted = std::string(attempted), .problem = "needs " + missing});
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

std::string options_to_json(const OptionTable& table) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Option& option : table) {
    auto& entry = json[std::string(option.stage)][std::string(option.name)];
    const OptionValue current = option.get();
    if (option.is_automatic_value(current)) {
      entry = "automatic";
      continue;
    }
    std::visit([&](const auto& value) { entry = value; }, current);
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
