#include "scripting/values/typed_number.h"

#include <cctype>
#include <sstream>
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_with_unit.h"
#include "scripting/values/flow_verbs.h"

namespace sterna::scripting {

double typed_number(std::string_view text, Unit expected) { return parse_number_with_unit(text, expected, BareAngle::degrees); }

void set_option_as_typed(const Option& option, std::string_view text) {
  const bool is_length = option.kind == OptionKind::number && option.unit == Unit::metre;
  if (is_length && is_flow_text(text)) return set_option(option, quantity_of_text(std::string(text)).metres);
  const bool is_bare_unit = is_length && !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) && text != "automatic";
  try {
    set_option_from_text(option, is_bare_unit ? "1*" + std::string(text) : std::string(text), BareAngle::degrees);
  } catch (const Error& error) {
    if (!is_bare_unit) throw;
    ErrorInfo info = error.info();
    info.problem = std::string(option.name) + ": \"" + std::string(text) + "\" is neither a number nor a unit of length (m, mm, um, cm, inch, in, ft)";
    throw Error(std::move(info));
  }
}

std::vector<std::string> set_options_as_typed(const OptionTable& options, std::string_view text, std::string_view attempted) {
  std::vector<std::string> others;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) {
      others.push_back(std::move(word));
      continue;
    }
    try {
      set_option_as_typed(find_option(options, word.substr(0, equals), attempted), word.substr(equals + 1));
    } catch (const Error& error) {
      ErrorInfo info = error.info();
      if (info.attempted != attempted) info.problem = word.substr(0, equals) + ": " + info.problem;
      info.attempted = std::string(attempted);
      throw Error(std::move(info));
    }
  }
  return others;
}

}  // namespace sterna::scripting
