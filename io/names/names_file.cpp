#include "io/names/names_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

#include "io/input/text_scanner.h"
#include "io/names/name_rules.h"

namespace sterna::io {
namespace {

constexpr std::array k_named_kinds = {PatchKind::wall,    PatchKind::slip,     PatchKind::symmetry, PatchKind::inflow,
                                      PatchKind::outflow, PatchKind::farfield, PatchKind::interface};

bool is_version(const std::string& extension) {
  return extension.size() == 3 && extension[1] == 'v' && std::isdigit(static_cast<unsigned char>(extension[2])) != 0;
}

}  // namespace

std::filesystem::path names_path(const std::filesystem::path& mesh_path) {
  std::filesystem::path path = mesh_path;
  if (path.extension() == ".gz") path.replace_extension();
  path.replace_extension();
  if (is_version(path.extension().string())) path.replace_extension();
  return path.string() + ".names";
}

std::map<std::int64_t, Patch> read_names(const std::filesystem::path& mesh_path, const RunContext& context) {
  std::map<std::int64_t, Patch> patches;
  const std::filesystem::path path = names_path(mesh_path);
  std::error_code status;  // if the file cannot be accessed; load_file reports the error of an existing file
  if (!std::filesystem::exists(path, status)) return patches;
  const FileBuffer buffer = load_file(path, context);
  TextScanner scanner(buffer, {.comment = '#', .line_bound = true});
  for (;;) {
    scanner.set_line_bound(false);
    if (scanner.at_end()) return patches;
    scanner.set_line_bound(true);
    const std::int64_t number = scanner.integer("the number of a patch");
    const std::string kind_name(scanner.token("the kind of a patch"));
    const auto kind = std::find_if(k_named_kinds.begin(), k_named_kinds.end(), [&](PatchKind k) { return to_string(k) == kind_name; });
    if (kind == k_named_kinds.end())
      scanner.fail("found " + quoted_excerpt(kind_name) + ", expected wall, slip, symmetry, inflow, outflow, farfield or interface");
    const std::string name(scanner.rest_of_line());
    if (name.empty()) scanner.fail("found no name of patch " + std::to_string(number));
    patches[number] = {name, *kind};
  }
}

std::string names_text(const Column<PatchId, Patch>& patches, const RunContext& context) {
  const std::vector<std::string> names = names_by_rules(patches, {.format = ".names", .forbidden = "#"}, context);
  std::string text = "# patches: number kind name\n";
  for (const PatchId patch : patches.ids())
    text += std::to_string(patch.value() + 1) + " " + std::string(to_string(patches[patch].kind)) + " " + names[patch.index()] + "\n";
  return text;
}

}  // namespace sterna::io
