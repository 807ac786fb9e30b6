#include "io/names/edge_conditions.h"

#include <system_error>

#include "io/container/ffa_tree.h"
#include "io/names/patch_names.h"

namespace sterna::io {
namespace {

struct Condition {
  std::string_view boundary_class, type;
};

Condition condition_of(PatchKind kind) {
  switch (kind) {
    case PatchKind::wall: return {"wall", "weak adiabatic"};
    case PatchKind::farfield: return {"external", "weak characteristic"};
    case PatchKind::inflow: return {"external", "nacelle exhaust"};
    case PatchKind::outflow: return {"external", "nacelle inlet"};
    case PatchKind::slip:
    case PatchKind::symmetry:  // the spelling of Edge's own symmetry condition is undocumented; on a plane a slip wall is equivalent
    case PatchKind::interface: break;
  }
  return {"wall", "weak euler"};
}

PatchKind kind_of(const std::string& boundary_class, const std::string& type, const std::string& name) {
  const auto has = [&](std::string_view word) { return type.find(word) != std::string::npos; };
  if (boundary_class == "wall") {
    if (!has("euler")) return PatchKind::wall;
    return kind_of_name(name) == PatchKind::symmetry ? PatchKind::symmetry : PatchKind::slip;
  }
  if (has("nacelle inlet") || has("outlet")) return PatchKind::outflow;
  if (has("nacelle exhaust") || has("inlet")) return PatchKind::inflow;
  return boundary_class == "external" ? PatchKind::farfield : kind_of_name(name);
}

std::string text_of(const FfaNode& node, std::string_view child) {
  const FfaNode& value = node.at(child);
  if (!value.is_text() || value.n_values() == 0) value.fail("found no string");
  return value.text();
}

/// Returns x for x.bmsh, x.v2.bmsh, x.amsh, each optionally with .gz.
std::filesystem::path stem_of(std::filesystem::path path) {
  if (path.extension() == ".gz") path.replace_extension();
  path.replace_extension();
  if (path.extension() == ".v2") path.replace_extension();
  return path;
}

}  // namespace

std::filesystem::path edge_conditions_path(const std::filesystem::path& mesh_path) { return stem_of(mesh_path).string() + ".aboc"; }

std::map<std::string, PatchKind> read_edge_conditions(const std::filesystem::path& mesh_path, const RunContext& context) {
  std::map<std::string, PatchKind> kinds;
  for (const char* const extension : {".aboc", ".bboc"}) {
    const std::filesystem::path path = stem_of(mesh_path).string() + extension;
    std::error_code status;  // not evaluated: a file whose existence cannot be tested is skipped; load_file reports the errors of files that exist
    if (!std::filesystem::exists(path, status)) continue;
    const FileBuffer buffer = load_file(path, context);
    const FfaNode root = parse_ffa(buffer);
    const FfaNode* const region = root.find("region");
    for (const FfaNode& boundary : (region ? *region : root).children) {
      if (boundary.name != "boundary") continue;
      const std::string name = text_of(boundary, "b_name");
      kinds[name] = kind_of(text_of(boundary, "b_class"), text_of(boundary, "b_type"), name);
    }
    return kinds;
  }
  return kinds;
}

std::string edge_conditions_text(const Column<PatchId, Patch>& patches, const std::vector<std::string>& names, const RunContext& context) {
  std::string boundaries;
  int n = 1;  // the region's name
  const auto warn = [&](const std::string& name, PatchKind kind, const Condition& condition, const std::string& consequence) {
    context.warn("patch \"" + name + "\" (" + std::string(to_string(kind)) + ") is written with the Edge condition " + std::string(condition.boundary_class) +
                 " / " + std::string(condition.type) + consequence);
  };
  const auto entry = [](std::string_view name, std::string_view value) { return std::string(name) + ", L, 1, 1, 0\n'" + std::string(value) + "'\n"; };
  for (const PatchId patch : patches.ids()) {
    if (names[patch.index()].empty()) continue;
    const PatchKind kind = patches[patch].kind;
    const Condition condition = condition_of(kind);
    const PatchKind back = kind_of(std::string(condition.boundary_class), std::string(condition.type), names[patch.index()]);
    if (kind == PatchKind::inflow || kind == PatchKind::outflow) warn(names[patch.index()], kind, condition, "; add its parameters to the .aboc file");
    else if (back != kind) warn(names[patch.index()], kind, condition, ", which is read as " + std::string(to_string(back)));
    boundaries +=
        "boundary, N, 0, 0, 3\n" + entry("b_name", names[patch.index()]) + entry("b_class", condition.boundary_class) + entry("b_type", condition.type);
    ++n;
  }
  return "boundary_data, N, 0, 0, 1\nregion, N, 0, 0, " + std::to_string(n) + "\n" + entry("region_name", "fluid domain") + boundaries;
}

}  // namespace sterna::io
