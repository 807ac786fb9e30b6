#include "scripting/verbs/wrap_verbs.h"

#include <array>

#include "io/field/trouble_vtu.h"
#include "io/output/atomic_file.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/surface_items.h"
#include "scripting/values/wrap_surfaces.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_wrap_usage = "wrap{ \"torn.stl\", \"tail.stl\", edge = 5*cm, gap = 20*cm }";

std::string wrap_help() {
  surfmesh::WrapOptions options;
  return options_help(sterna::options_of(options)) +
         "Writes files: changes = \"changes.vtu\" (the triangles that close openings, and those at leaks), report = \"changes.json\" (every closure and leak "
         "with kind, location and size, and the distances)\n";
}

ScriptValue wrap_parts(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_wrap_usage);
  surfmesh::WrapOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<UnionItem> items = read_surfaces_and_files(reader, call);
  const std::filesystem::path changes = output_entry(reader, call, "changes", "the name of a .vtu file"),
                              report = output_entry(reader, call, "report", "the name of a .json file");
  reader.read_options(schema);
  apply_overrides(call, schema);
  reader.finish();
  require_writable({changes, report});
  const auto write_report = [&](const surfmesh::WrapReport& made) {
    if (!changes.empty()) io::write_trouble_vtu(closed_facets(made), changes);
    if (!report.empty()) io::write_whole(report, wrap_json(made));
  };
  const bool is_reported = !changes.empty() || !report.empty();
  return std::make_shared<const SurfaceValue>(wrap_surfaces(items, options, call.session.reuse(), call.session.context.part("wrap", 0.0, 1.0),
                                                            is_reported ? write_report : std::function<void(const surfmesh::WrapReport&)>()));
}

constexpr std::array<ScriptVerb, 1> k_wrap_verbs = {{
    {"wrap", k_wrap_usage,
     "Wraps damaged surfaces in one closed surface close to them, with their sharp edges and patches. Reports what was closed and what disappeared inside.",
     wrap_parts, wrap_help, true, "surface", false, held_options<surfmesh::WrapOptions>},
}};

}  // namespace

std::span<const ScriptVerb> wrap_verbs() { return k_wrap_verbs; }

}  // namespace sterna::scripting
