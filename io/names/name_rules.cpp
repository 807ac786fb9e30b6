#include "io/names/name_rules.h"

#include <algorithm>
#include <set>

namespace sterna::io {
namespace {

/// Cuts a UTF-8 string to at most n bytes, never within a character.
std::string cut(std::string text, std::size_t n) {
  if (text.size() <= n) return text;
  while (n > 0 && (static_cast<unsigned char>(text[n]) & 0xc0) == 0x80) --n;
  text.resize(n);
  return text;
}

}  // namespace

std::vector<std::string> names_by_rules(const Column<PatchId, Patch>& patches, const NameRules& rules, const RunContext& context) {
  const auto is_awkward = [&](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u < ' ' || u == 0x7f || (c == ' ' && !rules.may_have_blanks) || rules.forbidden.find(c) != std::string_view::npos;
  };
  const std::size_t limit = rules.max_bytes == 0 ? std::string::npos : rules.max_bytes;
  std::set<std::string, std::less<>> taken;
  std::vector<std::string> names;
  for (const PatchId patch : patches.ids()) {
    std::string name = patches[patch].name;
    std::replace_if(name.begin(), name.end(), is_awkward, '_');
    const auto is_blank = [](char c) { return c == ' '; };  // readers strip leading and trailing blanks
    name.erase(std::find_if_not(name.rbegin(), name.rend(), is_blank).base(), name.end());
    name.erase(name.begin(), std::find_if_not(name.begin(), name.end(), is_blank));
    if (name.empty()) name = "patch_" + std::to_string(patch.value() + 1);
    if (!rules.may_begin_with_digit && name[0] >= '0' && name[0] <= '9') name.insert(0, "_");
    name = cut(std::move(name), limit);
    const std::string stem = name;
    for (int i = 2; !taken.insert(name).second; ++i) {
      const std::string suffix = "_" + std::to_string(i);
      name = cut(stem, limit == std::string::npos ? limit : limit - suffix.size()) + suffix;
    }
    if (name != patches[patch].name)
      context.warn("patch \"" + patches[patch].name + "\" is written as \"" + name + "\" in the " + std::string(rules.format) + " file");
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace sterna::io
