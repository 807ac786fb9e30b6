#include "scripting/report/report_verbs.h"

#include <array>

#include "scripting/lua/script_check.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/report/report_command.h"
#include "scripting/report/report_data.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/verbs/draw_verbs.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_report_usage = "report{ mesh, \"mesh.html\", cuts = { \"nose\", { x = 1.2 } } }  or  report{ wall, \"wall.html\" }";

/// Reads cuts = "tip", or a list of names, planes as strings, { x = 1.2 } and { point = ..., normal = ... }.
std::vector<std::string> read_cuts(TableReader& reader) {
  std::vector<std::string> cuts;
  const ScriptValue* value = reader.field("cuts");
  if (!value) return cuts;
  const auto* list = std::get_if<TableHandle>(value);
  if (list && (*list)->items.empty() && (*list)->fields.empty()) return cuts;
  const bool is_single = !list || (*list)->items.empty();
  for (const ScriptValue& item : is_single ? std::vector<ScriptValue>{*value} : (*list)->items) {
    const std::string where = "cuts, entry " + std::to_string(cuts.size() + 1);
    const auto* text = std::get_if<std::string>(&item);
    const auto* table = std::get_if<TableHandle>(&item);
    const std::optional<std::string> plane = table ? cut_text(**table) : std::nullopt;
    if (!text && !plane)
      reader.add_problem(where + ": expected \"leading edge\", { x = 1.2 } or { point = {0, 0, 0}, normal = {0, 1, 0} }, not " + std::string(type_text(item)));
    cuts.push_back(text ? *text : plane.value_or(""));
  }
  return cuts;
}

ScriptValue make_report(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_report_usage);
  ReportOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const ScriptValue object = items.empty() ? ScriptValue{} : items.front();
  const auto* mesh = std::get_if<MeshHandle>(&object);
  const auto* surface = std::get_if<SurfaceHandle>(&object);
  const auto* file = std::get_if<std::string>(&object);
  if (std::holds_alternative<ModelHandle>(object) || std::holds_alternative<ComponentHandle>(object))
    reader.add_problem("entry 1: a model has no mesh yet: report surface_mesh{ model }");
  else if (!mesh && !surface && !file)
    reader.add_problem("entry 1: expected a mesh, a surface or the name of a file, not " + std::string(items.empty() ? "nothing" : type_text(object)));
  const auto* output = items.size() > 1 ? std::get_if<std::string>(&items[1]) : nullptr;
  if (!output) reader.add_problem("entry 2: expected the name of the page, such as \"mesh.html\"");
  refuse_items_beyond(reader, 2);
  const std::vector<std::string> cuts = read_cuts(reader);
  if (surface && !cuts.empty()) reader.add_problem("cuts: a surface has no cells to cut");
  reader.read_options(schema);
  apply_overrides(call, schema);
  try {
    if (output) require_page_output(*output);
    if (!reader.has_problems()) require_report_cuts(cuts);
  } catch (const Error& error) {
    reader.add_problem(error.info().problem + (error.info().hint.empty() ? "" : " (" + error.info().hint + ")"));
  }
  if (file && call.session.check) check_input(call, find_input(call, *file));
  reader.finish();
  const std::filesystem::path path = output_path(call, *output);
  const std::string name = path.stem().string();
  const RunContext context = call.session.context.part("report", 0.0, 1.0);
  if (file) write_page(page_of_file(find_input(call, *file), options, cuts, nullptr, context).first, path, call.session.context);
  else write_page(mesh ? report_html(**mesh, options, cuts, name, context) : report_html(**surface, options, name, context), path, call.session.context);
  return std::monostate{};
}

std::string report_help() {
  ReportOptions options;
  return "cuts = { \"leading edge\", { x = 1.2 }, { point = {0, 0, 0}, normal = {0, 1, 0} } }: planes that are shown before the automatic cuts\n" +
         options_help(sterna::options_of(options));
}

constexpr std::array<ScriptVerb, 1> k_report_verbs = {{{"report", k_report_usage,
                                                        "Writes a page (one HTML file, opens without a network) that shows a mesh: view, cuts, worst "
                                                        "locations, histograms, gates, coverage, times, options (docs/report.md).",
                                                        make_report, report_help, true, "nothing", false, held_options<ReportOptions>}}};

}  // namespace

std::span<const ScriptVerb> report_verbs() { return k_report_verbs; }

}  // namespace sterna::scripting
