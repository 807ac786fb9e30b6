#include "geom/base/glob.h"

#include <algorithm>
#include <vector>

#include "geom/base/schema.h"

namespace sterna {
namespace {

constexpr std::size_t k_shown = 12;  ///< names in a hint

}  // namespace

bool matches_glob(std::string_view name, std::string_view glob) {
  std::size_t n = 0, g = 0, star = std::string_view::npos, retry = 0;
  while (n < name.size()) {
    if (g < glob.size() && (glob[g] == '?' || (glob[g] != '*' && glob[g] == name[n]))) {
      ++n;
      ++g;
    } else if (g < glob.size() && glob[g] == '*') {
      star = g++;
      retry = n;
    } else if (star != std::string_view::npos) {
      g = star + 1;
      n = ++retry;
    } else {
      return false;
    }
  }
  while (g < glob.size() && glob[g] == '*') ++g;
  return g == glob.size();
}

std::size_t n_spelled_out(std::string_view glob) {
  return static_cast<std::size_t>(std::count_if(glob.begin(), glob.end(), [](char c) { return c != '*' && c != '?'; }));
}

std::string names_hint(std::span<const std::string> given, std::string_view glob) {
  std::vector<std::string> names(given.begin(), given.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  if (names.empty()) return "there are no names";
  std::string plain(glob);
  std::erase_if(plain, [](char c) { return c == '*' || c == '?'; });
  const std::string nearest = nearest_name(plain, names);
  std::string hint = nearest.empty() ? "" : "did you mean \"" + nearest + "\"? ";
  hint += "names are";
  for (std::size_t i = 0; i < std::min(k_shown, names.size()); ++i) hint += (i > 0 ? ", " : " ") + names[i];
  if (names.size() > k_shown) hint += ", ... (" + std::to_string(names.size()) + " in all)";
  return hint;
}

}  // namespace sterna
