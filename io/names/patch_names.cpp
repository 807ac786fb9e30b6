#include "io/names/patch_names.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace sterna::io {
namespace {

constexpr std::string_view k_reserved = "SEND_RECEIVE";  // name of SU2's partition boundaries; a fatal error in current versions

bool is_awkward(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u <= ' ' || u == 0x7f || std::string_view("(),%={}").find(c) != std::string_view::npos;
}

}  // namespace

std::vector<std::string> su2_marker_names(const Column<PatchId, Patch>& patches, const RunContext& context) {
  std::set<std::string, std::less<>> taken{std::string(k_reserved)};
  std::vector<std::string> names;
  for (const PatchId patch : patches.ids()) {
    std::string name = patches[patch].name;
    std::replace_if(name.begin(), name.end(), is_awkward, '_');
    if (name.empty()) name = "patch_" + std::to_string(patch.value() + 1);
    const std::string stem = name;
    for (int i = 2; !taken.insert(name).second; ++i) name = stem + "_" + std::to_string(i);
    if (name != patches[patch].name) context.warn("patch \"" + patches[patch].name + "\" is written as marker \"" + name + "\"");
    names.push_back(std::move(name));
  }
  return names;
}

PatchKind kind_of_name(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower.find("farfield") != std::string::npos) return PatchKind::farfield;
  if (lower.find("symmetry") != std::string::npos) return PatchKind::symmetry;
  return PatchKind::wall;
}

PatchId find_or_add_patch(Column<PatchId, Patch>& patches, std::string_view name) {
  for (const PatchId patch : patches.ids())
    if (patches[patch].name == name) return patch;
  return patches.push_back({.name = std::string(name), .kind = kind_of_name(name)});
}

}  // namespace sterna::io
