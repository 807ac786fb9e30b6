#include "geom/mesh/periodic_names.h"

#include <algorithm>

#include "geom/base/error.h"

namespace sterna {
namespace {

std::string_view without_blanks(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

}  // namespace

std::vector<PeriodicNames> side_pairs(std::string_view text) {
  std::vector<PeriodicNames> pairs;
  const std::string whole(text);
  while (!without_blanks(text).empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    const std::string_view pair = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t comma = pair.find(',');
    const std::string_view first = without_blanks(pair.substr(0, comma)),
                           second = comma == std::string_view::npos ? std::string_view() : without_blanks(pair.substr(comma + 1));
    if (first.empty() || second.empty() || second.find(',') != std::string_view::npos)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "option periodic",
                   .problem = "\"" + whole + "\" is not a list of pairs of names",
                   .hint = "separate the two names of a pair with a comma, and pairs with a semicolon: \"left,right; floor,ceiling\""});
    pairs.push_back({std::string(first), std::string(second)});
  }
  return pairs;
}

std::string side_pairs_text(const std::vector<PeriodicNames>& pairs) {
  std::string text;
  for (const PeriodicNames& pair : pairs) text += (text.empty() ? "" : "; ") + pair.first + "," + pair.second;
  return text;
}

void require_separable(const std::vector<PeriodicNames>& pairs) {
  for (const PeriodicNames& pair : pairs)
    for (const std::string& name : {pair.first, pair.second})
      if (name.empty() || name.find_first_of(",;") != std::string::npos || without_blanks(name) != name)
        throw Error({.code = ErrorCode::bad_argument,
                     .attempted = "option periodic",
                     .problem = "\"" + name + "\": names of periodic patches are separated by commas and semicolons",
                     .hint = "give the patch a name without \",\" and \";\", and without blanks at its ends"});
}

}  // namespace sterna
