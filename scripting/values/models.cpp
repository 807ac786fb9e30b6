#include "scripting/values/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/hash.h"
#include "geom/math/constants.h"
#include "geom/model/components.h"
#include "geom/model/cpacs.h"
#include "geom/model/smx.h"
#include "io/file/cad_file.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {
namespace {

std::string extension_of(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}
bool is_smx(const std::filesystem::path& path) { return extension_of(path) == ".smx"; }
bool is_xml(const std::filesystem::path& path) { return extension_of(path) == ".xml"; }

ModelValue value_of(AircraftReading reading, const InputPath& file, const RunContext& context) {
  ModelValue value{.inputs = {{file.name, hash_file(file.path)}}};
  value.provenance = KeyMaker("read_description").add(file.path.filename().string()).add(value.inputs.front().hash).key();
  try {
    value.model = make_components(reading.aircraft, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_argument) throw;
    ErrorInfo info = error.info();  // a defect in the description of a component is a defect of the file
    info.code = ErrorCode::file_malformed;
    info.attempted = file.name + ": " + info.attempted;
    throw Error(std::move(info));
  }
  for (const std::string& message : reading.messages) value.report += (value.report.empty() ? "" : "\n") + message;
  value.description = std::move(reading.aircraft);
  value.is_as_described = true;
  context.info(file.name + ": " + describe(value));
  return value;
}

/// Returns the lines of a report that the reader has not logged yet: warnings were logged when they were found.
std::string without_warnings(const std::string& report) {
  std::string text;
  std::istringstream lines(report);
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("  warning: ")) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

bool is_model_file(const std::filesystem::path& path) { return io::is_cad_file(path) || is_smx(path) || is_xml(path); }

bool is_model_output(const std::filesystem::path& path) { return is_smx(path) || (io::is_cad_file(path) && extension_of(path) != ".gz"); }

Aircraft description_of(const InputPath& file, const RunContext& context) {
  return (is_smx(file.path) ? read_smx(file.path, context) : read_cpacs(file.path, context)).aircraft;
}

ModelValue read_smx_model(const InputPath& file, const RunContext& context) { return value_of(read_smx(file.path, context), file, context); }
ModelValue read_cpacs_model(const InputPath& file, const RunContext& context) { return value_of(read_cpacs(file.path, context), file, context); }

ModelValue deflected_model(const ModelValue& value, const std::vector<ControlSetting>& settings, const RunContext& context) {
  if (!value.description || !value.is_as_described)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "deflecting control surfaces of a model",
                 .problem = value.description ? "the model was changed after reading" : "the components are not defined as data: " + value.without_description,
                 .hint = "deflect directly after read_smx or read_cpacs; deflect wings of a script with wing:deflect{} before aircraft{}"});
  ModelValue result = value;
  result.description = with_controls_set(*value.description, settings);
  result.model = make_components(*result.description, context);
  result.parts.clear();
  result.provenance = KeyMaker("deflect").add(*result.description).key();
  for (const Deflection& d : result.description->deflections)
    if (d.angle != 0.0) context.debug(fmt::format("{} deflected by {:.4g} deg", d.surface.name, d.angle / k_degree));
  return result;
}

namespace {

/// Rejects options of reading CAD for files of components (sumo, CPACS). These are data in metres, on which the options have no effect.
void refuse_cad_options(const InputPath& file, ReadCadOptions options) {
  for (const Option& option : sterna::options_of(options)) {
    const OptionValue value = option.get();
    const double* number = std::get_if<double>(&value);
    if (number && is_automatic(*number) ? is_automatic(std::get<double>(option.default_value)) : value == option.default_value) continue;
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "reading " + file.name,
                 .problem = "option read_cad." + std::string(option.name) + " has no effect: the file defines components as data, in metres",
                 .hint = "leave it out; it applies to STEP, IGES and BREP"});
  }
}

}  // namespace

ModelValue read_model(const InputPath& file, const ReadCadOptions& options, const RunContext& context) {
  if (is_smx(file.path) || is_xml(file.path)) refuse_cad_options(file, options);
  if (is_smx(file.path)) return read_smx_model(file, context);
  if (is_xml(file.path)) return read_cpacs_model(file, context);
  CadFile cad = io::read_cad(file.path, options, context);
  ModelValue value{.without_description = "read from " + file.name, .inputs = {{file.name, hash_file(file.path)}}};
  ReadCadOptions named = options;
  value.provenance = KeyMaker("read_cad").add(file.path.filename().string()).add(value.inputs.front().hash).add(sterna::options_of(named)).key();
  value.model = std::move(cad.model);
  value.report = without_warnings(to_text(cad.report));
  context.info(file.name + ": " + value.report);
  return value;
}

void require_model_output(const ModelValue& value, const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& problem, const std::string& hint) {
    throw Error({.code = ErrorCode::unsupported_format, .attempted = "writing " + path.string(), .problem = problem, .hint = hint});
  };
  if (!is_model_output(path))
    refuse("models are not written in this format", "models are written as STEP (.step, .stp), IGES (.iges, .igs), BREP (.brep), sumo (.smx)");
  if (is_smx(path) && !value.description)
    refuse(".smx requires components defined as data, and this model has none (" + value.without_description + ")",
           "write .smx before that step, or write STEP");
  if (!path.parent_path().empty() && !std::filesystem::is_directory(path.parent_path()))
    throw Error({.code = ErrorCode::write_failed, .attempted = "writing " + path.string(), .problem = "there is no folder " + path.parent_path().string()});
}

void write_model(const ModelValue& value, const std::filesystem::path& path, const WriteCadOptions& options, const RunContext& context) {
  require_model_output(value, path);
  if (is_smx(path)) {
    write_smx(*value.description, path);
    return;
  }
  io::write_cad(value.model, path, options, context);
}

Model select_components(const Model& model, const std::string& pattern, const std::string& attempted) {
  Model result = select_faces(model, [&](FaceId f) { return matches_glob(model.components[model.faces[f].component].name, pattern); });
  if (!result.faces.empty()) return result;
  std::vector<std::string> names;
  std::string all;
  for (const Component& component : model.components) {
    names.push_back(component.name);
    all += (all.empty() ? "" : ", ") + component.name;
  }
  const std::string nearest = nearest_name(pattern, names);
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = attempted,
               .problem = "no component is named \"" + pattern + "\"" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"),
               .hint = "components: " + all});
}

std::string describe(const ModelValue& value) {
  const Model& model = value.model;
  const auto n_closed = std::count_if(model.solids.begin(), model.solids.end(), [](const ModelSolid& s) { return s.is_closed; });
  const auto counted = [](std::size_t n, std::string_view what) {
    return count_text(static_cast<std::int64_t>(n)) + " " + std::string(what) + (n == 1 ? "" : "s");
  };
  std::string text = "Model: " + counted(model.components.size(), "component") + ", " + counted(model.faces.size(), "face") + ", " +
                     counted(static_cast<std::size_t>(n_closed), "closed solid");
  if (const std::size_t n_free = free_edges(model).size(); n_free > 0) text += ", open along " + counted(n_free, "edge");
  if (const Box box = box_of(model); !box.empty())
    text += fmt::format(", {:.4g} x {:.4g} x {:.4g} m", box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z);
  return text;
}

}  // namespace sterna::scripting
