#include "tests/scripting/manual/option_values.h"

#include <cmath>
#include <regex>
#include <sstream>

namespace sterna::scripting {
namespace {

/// Returns a number in [min, max] other than `value`, an integer if the option may be one.
double other_number(double value, double min, double max, bool is_whole) {
  if (is_whole) return value + 1.0 <= max ? value + 1.0 : value - 1.0;
  if (!std::isinf(max) && !std::isinf(min)) return value == 0.5 * (min + max) ? 0.25 * min + 0.75 * max : 0.5 * (min + max);
  if (!std::isinf(max)) return value == max ? max - 1.0 : max;
  return std::max(min, 0.0) == value ? value + 0.5 : std::max(min, 0.0) + (value == std::max(min, 0.0) + 0.5 ? 0.25 : 0.5);
}

std::string first_other_word(const std::string& words, const std::string& not_this) {
  std::istringstream list(words);
  for (std::string word; list >> word;)
    if (word != not_this) return word;
  return not_this;
}

std::string number_text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

}  // namespace

OptionValue other_value(const Option& option) {
  if (option.name == "farfield_sides") return "x_min=inflow";
  if (option.name == "periodic" && option.kind == OptionKind::string) return "left,right";
  switch (option.kind) {
    case OptionKind::boolean: return !std::get<bool>(option.default_value);
    case OptionKind::integer:
      return static_cast<std::int64_t>(other_number(static_cast<double>(std::get<std::int64_t>(option.default_value)), option.min, option.max, true));
    case OptionKind::string:
      return option.choices.empty() ? "other" : first_other_word(std::string(option.choices), std::get<std::string>(option.default_value));
    case OptionKind::vector: return Vec3{0.25, 0.5, 0.75};
    case OptionKind::numbers: return std::vector<double>{0.25, 0.5};
    case OptionKind::vectors: return std::vector<Vec3>{{0.25, 0.5, 0.75}};
    case OptionKind::number: break;
  }
  const double value = std::get<double>(option.default_value);
  return other_number(is_automatic(value) ? 1e300 : value, option.min, option.max, false);
}

std::string text_of(const OptionValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return number_text(std::get<double>(value));
}

std::string other_value(const OptionDoc& option) {
  if (option.name == "farfield_sides") return "\"x_min=inflow\"";
  if (option.value == "true" || option.value == "false") return option.value == "true" ? "false" : "true";
  if (option.range.starts_with("one of ")) {
    const std::string words = std::regex_replace(option.range.substr(7), std::regex(","), " "),
                      value = option.value.substr(0, option.value.find_last_of('"') + 1);
    return "\"" + first_other_word(words, value.size() > 2 ? value.substr(1, value.size() - 2) : "") + "\"";
  }
  if (option.value.starts_with('"') || (option.value == "required" && option.range.empty())) return "\"other\"";
  const bool is_angle = option.range.find(" deg") != std::string::npos;
  double min = -k_unbounded, max = k_unbounded;
  std::smatch match;
  const std::string number = "(-?[0-9][-+.0-9e]*)";
  if (std::regex_search(option.range, match, std::regex("^" + number + "[a-zA-Z ]* \\.\\. " + number))) {
    min = std::stod(match[1]);
    max = std::stod(match[2]);
  } else if (std::regex_search(option.range, match, std::regex("x >= " + number))) {
    min = std::stod(match[1]);
  } else if (std::regex_search(option.range, match, std::regex("x <= " + number))) {
    max = std::stod(match[1]);
  }
  const bool has_value = std::regex_search(option.value, match, std::regex("^" + number));
  const double value = has_value ? std::stod(match[1]) : 1e300;
  const bool may_be_whole = has_value && value == std::floor(value) && std::abs(value) < 1e15;
  const double other = other_number(value, min, max, may_be_whole && (value + 1.0 <= max || value - 1.0 >= min));
  return number_text(other) + (is_angle ? "*deg" : "");
}

}  // namespace sterna::scripting
