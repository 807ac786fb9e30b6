#include "scripting/values/wake_verbs.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/typed_number.h"

namespace sterna::scripting {

/// Scalar options of a wake sheet.
struct SheetNumbers {
  std::string wing = volmesh::WakeSheet{}.wing;
  double length = volmesh::WakeSheet{}.length;
  double growth = volmesh::WakeSheet{}.growth;
  double height_growth = volmesh::WakeSheet{}.height_growth;
  double alpha = k_automatic, beta = k_automatic;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::SheetNumbers> {
  using O = scripting::SheetNumbers;
  static constexpr std::string_view stage = "wake_sheet";
  static constexpr std::array fields = {
      Field<O>{.name = "wing", .member = &O::wing, .help = "pattern of names of the wing's patches; the sheet starts at their trailing edges"},
      Field<O>{.name = "length",
               .member = &O::length,
               .min = 0.1,
               .max = 20.0,
               .help = "length of the sheet, in chords of the wing in front of it; larger values need more cells"},
      Field<O>{.name = "growth",
               .member = &O::growth,
               .min = 1.0,
               .max = 2.0,
               .help = "largest ratio of successive edges along the sheet; larger values need fewer cells"},
      Field<O>{.name = "height_growth",
               .member = &O::height_growth,
               .min = 1.0,
               .max = 2.0,
               .help = "largest ratio of first heights between successive rows along the sheet, which reduces the number of layers; 1: all layers continue to "
                       "the end of the sheet"},
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
using SheetJson = nlohmann::json;

constexpr std::string_view k_wake_sheet_usage = "wake_sheet{ wing = \"main*\", length = 2, growth = 1.2, height_growth = 1.2, alpha = 2*deg }";

/// Returns the flow direction, as in the cases of solvers: x aft, z up.
Vec3 stream_at(double alpha, double beta) { return {std::cos(alpha) * std::cos(beta), std::sin(beta), std::sin(alpha) * std::cos(beta)}; }

WakeSheet sheet_of(const ScriptTable& table, const std::string& attempted) {
  WakeSheet wake;
  SheetNumbers numbers;
  const OptionTable options = sterna::options_of(numbers);
  TableReader reader(table, attempted);
  reader.field("shape");
  refuse_items_beyond(reader, 0);
  if (const auto direction = read_point(reader, "direction")) wake.direction = *direction;
  if (wake.direction && !(norm2(*wake.direction) > 0.0)) reader.add_problem("direction: the vector has zero length");
  reader.read_options(options);
  const bool has_angles = !is_automatic(numbers.alpha) || !is_automatic(numbers.beta);
  if (has_angles && wake.direction) reader.add_problem("direction and alpha, beta exclude each other: give either");
  reader.finish();
  if (has_angles) wake.direction = stream_at(is_automatic(numbers.alpha) ? 0.0 : numbers.alpha, is_automatic(numbers.beta) ? 0.0 : numbers.beta);
  wake.wing = numbers.wing;
  wake.length = numbers.length;
  wake.growth = numbers.growth;
  wake.height_growth = numbers.height_growth;
  return wake;
}

ScriptValue make_wake_sheet(const ScriptCall& call) {
  if (call.arguments.size() != 1 || !std::holds_alternative<TableHandle>(call.arguments.front()))
    throw Error({.code = ErrorCode::bad_argument, .attempted = call.attempted(), .problem = "takes one table", .hint = std::string(k_wake_sheet_usage)});
  ScriptTable table = *std::get<TableHandle>(call.arguments.front());
  sheet_of(table, call.attempted());
  table.fields["shape"] = std::string("wake_sheet");
  return std::make_shared<const ScriptTable>(std::move(table));
}

std::string wake_sheet_help() {
  SheetNumbers numbers;
  return options_help(sterna::options_of(numbers)) +
         "direction = {x, y, z}: direction of the free stream, instead of alpha and beta; default: along the inflow in a tunnel, otherwise along x\n";
}

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
  const std::string attempted = "wake sheet \"" + text + "\"";
  if (text == "auto") return {};
  std::istringstream words(text);
  ScriptTable table;
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = attempted,
                   .problem = "\"" + word + "\" is not NAME=VALUE",
                   .hint = "such as --wake-sheet \"wing=main* length=2\", or --wake-sheet auto"});
    const std::string key = word.substr(0, equals), value = word.substr(equals + 1);
    if (key == "wing") {
      table.fields[key] = value;
      continue;
    }
    std::vector<ScriptValue> values;
    std::istringstream list(value);
    SheetNumbers numbers;
    const OptionTable options = sterna::options_of(numbers);
    const auto option = std::ranges::find(options, key, &Option::name);
    for (std::string number; std::getline(list, number, ',');) values.push_back(typed_number(number, option == options.end() ? Unit::none : option->unit));
    ScriptValue& field = table.fields[key];
    if (values.size() == 1) field = values.front();
    else field = std::make_shared<const ScriptTable>(ScriptTable{.items = std::move(values), .fields = {}, .other_keys = {}});
  }
  return sheet_of(table, attempted);
}

std::string wakes_json(const std::vector<WakeSheet>& wakes) {
  SheetJson list = SheetJson::array();
  for (const WakeSheet& wake : wakes) {
    SheetJson entry = {{"wing", wake.wing}, {"length", wake.length}, {"growth", wake.growth}, {"height_growth", wake.height_growth}};
    if (const auto& way = wake.direction) entry["direction"] = {way->x, way->y, way->z};
    list.push_back(std::move(entry));
  }
  return list.dump();
}

std::vector<WakeSheet> wakes_of_json(const std::string& text) {
  std::vector<WakeSheet> wakes;
  try {
    for (const SheetJson& entry : SheetJson::parse(text)) {
      std::optional<Vec3> direction;
      if (const auto way = entry.find("direction"); way != entry.end())
        direction = {way->at(0).get<double>(), way->at(1).get<double>(), way->at(2).get<double>()};
      wakes.push_back({.wing = entry.at("wing").get<std::string>(),
                       .length = entry.at("length").get<double>(),
                       .growth = entry.at("growth").get<double>(),
                       .height_growth = entry.at("height_growth").get<double>(),
                       .direction = direction});
    }
  } catch (const SheetJson::exception& error) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "reading wake sheets from JSON", .problem = error.what()});
  }
  return wakes;
}

}  // namespace sterna::scripting
