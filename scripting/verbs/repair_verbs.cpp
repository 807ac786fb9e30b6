#include "scripting/verbs/repair_verbs.h"

#include <array>

#include "io/field/trouble_vtu.h"
#include "io/output/atomic_file.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/filled_crevices.h"
#include "scripting/values/repair_surfaces.h"
#include "scripting/values/surface_items.h"
#include "scripting/values/wrap_surfaces.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_repair_usage = "repair{ \"torn.stl\", gap = 1e-3, hole = 0.3 }";

std::string repair_help() {
  surfmesh::StitchOptions stitching;
  surfmesh::RepairOptions options;
  return options_help(repair_options(stitching, options)) +
         "Writes files: changes = \"changes.vtu\" (the changed and removed facets), report = \"changes.json\" (every change with kind, location, size and "
         "facets, and the distances)\n";
}

ScriptValue repair_parts(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_repair_usage);
  surfmesh::StitchOptions stitching;
  surfmesh::RepairOptions options;
  const OptionTable schema = repair_options(stitching, options);
  TableReader reader(table, call.attempted());
  const std::vector<UnionItem> items = read_surfaces_and_files(reader, call);
  const std::filesystem::path changes = output_entry(reader, call, "changes", "the name of a .vtu file"),
                              report = output_entry(reader, call, "report", "the name of a .json file");
  reader.read_options(schema);
  apply_overrides(call, schema);
  reader.finish();
  require_writable({changes, report});
  const auto write_report = [&](const surfmesh::RepairReport& made) {
    if (!changes.empty()) io::write_trouble_vtu(changed_facets(made), changes);
    if (!report.empty()) io::write_whole(report, repair_json(made));
  };
  const bool is_reported = !changes.empty() || !report.empty();
  return std::make_shared<const SurfaceValue>(repair_surfaces(items, stitching, options, call.session.reuse(), call.session.context.part("repair", 0.0, 1.0),
                                                              is_reported ? write_report : std::function<void(const surfmesh::RepairReport&)>()));
}

constexpr std::string_view k_crevices_usage = "fill_crevices{ wall, width = 0.05 }";

ScriptValue make_filled_crevices(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_crevices_usage);
  volmesh::CreviceOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const SurfaceHandle* wall = items.size() == 1 ? std::get_if<SurfaceHandle>(&items.front()) : nullptr;
  if (wall == nullptr) reader.add_problem("expected one surface (from read_surface, surface_mesh ...): " + std::string(k_crevices_usage));
  reader.read_options(schema);
  apply_overrides(call, schema);
  if (is_automatic(options.width)) reader.add_problem("width is missing: the largest distance between facing walls that is filled, for example width = 20*mm");
  reader.finish();
  return std::make_shared<const SurfaceValue>(filled_crevices(**wall, options, call.session.context.part("fill_crevices", 0.0, 1.0)));
}

constexpr std::array<ScriptVerb, 2> k_repair_verbs = {{
    {"fill_crevices", k_crevices_usage,
     "Makes narrow crevices and gaps of a wall solid, up to a width: no boundary layer has room there, and solvers diverge beside vertices without a layer. "
     "Reports location, width, volume and distance of each.",
     make_filled_crevices, nullptr, true, "surface", false, held_options<volmesh::CreviceOptions>},
    {"repair", k_repair_usage,
     "Closes seams and holes of surfaces, cuts crossing facets, keeps the outer hull, removes sheets and inner walls, and recognises half models. Changes as "
     "little as possible and reports each change.",
     repair_parts, repair_help, true, "surface", false, held_table<repair_options, surfmesh::StitchOptions, surfmesh::RepairOptions>},
}};

/// Returns true if an entry (true, false or a table) requests a step. Options of a table go to `schema`.
bool is_requested(TableReader& reader, const ScriptCall& call, const std::string& name, const OptionTable& schema) {
  const ScriptValue* value = reader.field(name);
  if (value == nullptr) return false;
  if (const auto* flag = std::get_if<bool>(value)) return *flag;
  const auto* table = std::get_if<TableHandle>(value);
  if (table == nullptr) {
    reader.add_problem(name + ": expected true or a table of options, not " + std::string(type_text(*value)));
    return false;
  }
  const ScriptTable own_table = **table;
  TableReader own(own_table, Attempt(std::string(call.attempted()) + ", " + name, nullptr, false));
  own.read_options(schema);
  own.finish();
  return true;
}

}  // namespace

std::span<const ScriptVerb> repair_verbs() { return k_repair_verbs; }

SurfaceReader read_surface_entry(TableReader& reader, const ScriptCall& call) {
  AutoSurface requested;
  const bool is_repaired = is_requested(reader, call, "repair", sterna::options_of(requested.repair));
  const bool is_wrapped = is_requested(reader, call, "wrap", sterna::options_of(requested.wrap));
  const bool is_auto = is_requested(reader, call, "auto", {});
  if (is_repaired + is_wrapped + is_auto > 1) reader.add_problem("at most one of repair, wrap and auto");
  if (is_auto)
    return [requested](const std::vector<InputPath>& files, const surfmesh::StitchOptions& stitching, const RunContext& context, const Reuse& reuse) {
      AutoSurface with_reading = requested;
      with_reading.stitching = stitching;
      return auto_surface(files, with_reading, reuse, context);
    };
  if (is_repaired)
    return [requested](const std::vector<InputPath>& files, const surfmesh::StitchOptions& stitching, const RunContext& context, const Reuse& reuse) {
      return repair_surfaces(std::vector<UnionItem>(files.begin(), files.end()), stitching, requested.repair, reuse, context);
    };
  if (is_wrapped)
    return [requested](const std::vector<InputPath>& files, const surfmesh::StitchOptions& stitching, const RunContext& context, const Reuse& reuse) {
      return wrap_surfaces(std::vector<UnionItem>(files.begin(), files.end()), wrap_with_reading(requested.wrap, stitching), reuse, context);
    };
  return {};
}

}  // namespace sterna::scripting
