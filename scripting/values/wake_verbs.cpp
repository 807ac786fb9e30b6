#include "scripting/values/wake_verbs.h"

#include <cmath>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/typed_number.h"

namespace sterna::scripting {

/// Direction of the free stream by angles.
struct StreamAngles {
  double alpha = k_automatic, beta = k_automatic;  ///< radians
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::StreamAngles> {
  using O = scripting::StreamAngles;
  static constexpr std::string_view stage = "wake_sheet";
  static constexpr std::array fields = {
      Field<O>{.name = "alpha",
               .member = &O::alpha,
               .unit = Unit::radian,
               .min = -1.6,
               .max = 1.6,
               .help = "angle of attack instead of direction, positive for flow from below, as in su2_config and foam_case",
               .automatic = "0 if beta is given"},
      Field<O>{.name = "beta",
               .member = &O::beta,
               .unit = Unit::radian,
               .min = -1.6,
               .max = 1.6,
               .help = "sideslip angle instead of direction, positive for flow towards y > 0",
               .automatic = "0 if alpha is given"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

using volmesh::WakeSheet;

constexpr std::string_view k_wake_sheet_usage = "wake_sheet{ wing = \"main*\", length = 2, growth = 1.2, height_growth = 1.2, alpha = 2*deg }";

/// Returns the flow direction, as in the cases of solvers: x aft, z up.
Vec3 stream_at(double alpha, double beta) { return {std::cos(alpha) * std::cos(beta), std::sin(beta), std::sin(alpha) * std::cos(beta)}; }

/// A wake sheet as users describe it.
struct SheetRequest {
  WakeSheet sheet;
  StreamAngles angles;

  OptionTable options() {
    OptionTable table = sterna::options_of(sheet);
    for (Option& option : sterna::options_of(angles)) table.push_back(std::move(option));
    return table;
  }
  /// Returns what contradicts itself; empty: nothing.
  std::string problem() const {
    if (sheet.direction && !(norm2(*sheet.direction) > 0.0)) return "direction: the vector has zero length";
    if (sheet.direction && has_angles()) return "direction and alpha, beta exclude each other: give either";
    return {};
  }
  WakeSheet made() const {
    WakeSheet result = sheet;
    if (has_angles()) result.direction = stream_at(is_automatic(angles.alpha) ? 0.0 : angles.alpha, is_automatic(angles.beta) ? 0.0 : angles.beta);
    return result;
  }

 private:
  bool has_angles() const { return !is_automatic(angles.alpha) || !is_automatic(angles.beta); }
};

WakeSheet sheet_of(const ScriptTable& table, const std::string& attempted) {
  SheetRequest request;
  TableReader reader(table, attempted);
  reader.field("shape");
  refuse_items_beyond(reader, 0);
  reader.read_options(request.options());
  if (const std::string problem = request.problem(); !problem.empty()) reader.add_problem(problem);
  reader.finish();
  return request.made();
}

ScriptValue make_wake_sheet(const ScriptCall& call) {
  if (call.arguments.size() != 1 || !std::holds_alternative<TableHandle>(call.arguments.front()))
    throw Error({.code = ErrorCode::bad_argument, .attempted = call.attempted(), .problem = "takes one table", .hint = std::string(k_wake_sheet_usage)});
  ScriptTable table = *std::get<TableHandle>(call.arguments.front());
  sheet_of(table, call.attempted());
  table.fields["shape"] = std::string("wake_sheet");
  return std::make_shared<const ScriptTable>(std::move(table));
}

std::string wake_sheet_help() { return options_help(SheetRequest{}.options()); }

constexpr std::array<ScriptVerb, 1> k_wake_verbs = {{
    {"wake_sheet", k_wake_sheet_usage,
     "Experimental: surface behind trailing edges that continues the layers of both sides of a wing, for the wakes of volume_mesh. Gates may fail at the sides "
     "of a sheet that pass without it (docs/wake_sheets.md): compare both meshes.",
     make_wake_sheet, wake_sheet_help, false, "wake sheet"},
}};

}  // namespace

std::span<const ScriptVerb> wake_verbs() { return k_wake_verbs; }

std::vector<WakeSheet> read_wakes(TableReader& reader, const ScriptCall& call) {
  if (const ScriptValue* value = reader.field("wakes"))
    if (const auto* text = std::get_if<std::string>(value)) {
      if (*text == "auto") return {WakeSheet{}};
      reader.add_problem("wakes: expected \"auto\" or a list, { " + std::string(k_wake_sheet_usage) + " }, not \"" + *text + "\"");
      return {};
    }
  std::vector<WakeSheet> wakes;
  for (const ShapeEntry& entry : read_shapes(reader, "wakes", k_wake_sheet_usage)) {
    if (entry.shape == "wake_sheet") wakes.push_back(sheet_of(*entry.table, call.attempted() + ", " + entry.where));
    else if (entry.shape == "wake")
      reader.add_problem(entry.where + ": wake{ ... } is a source of short edges, for the option sources; a wake sheet with layers is " +
                         std::string(k_wake_sheet_usage));
    else reader.add_problem(entry.where + ": expected " + std::string(k_wake_sheet_usage) + ", not " + std::string(type_text(entry.value)));
  }
  return wakes;
}

WakeSheet wake_sheet_of_text(const std::string& text) {
  if (text == "auto") return {};
  const std::string attempted = "wake sheet \"" + text + "\"";
  SheetRequest request;
  const std::vector<std::string> others = set_options_as_typed(request.options(), text, attempted);
  if (const std::string problem = others.empty() ? request.problem() : "\"" + others.front() + "\" is not NAME=VALUE"; !problem.empty())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = problem,
                 .hint = "such as --wake-sheet \"wing=main* length=2\", or --wake-sheet auto"});
  return request.made();
}

}  // namespace sterna::scripting
