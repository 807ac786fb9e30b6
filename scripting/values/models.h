// Models (exact geometry) as values of scripts and commands. They can be read, described, measured, selected and written.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/write_cad.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/aircraft.h"
#include "geom/model/model.h"
#include "geom/model/reference_data.h"
#include "geom/model/select_faces.h"
#include "geom/model/set_controls.h"
#include "scripting/lua/script_value.h"
#include "scripting/values/model_parts.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// A model with its origin.
struct ModelValue {
  Model model;
  std::optional<Aircraft> description;  ///< components as data; they agree with the model's position and shape
  std::string without_description;      ///< reason why there is no description: "rotate", "read from a.step"
  bool is_as_described = false;         ///< the model, read from a file, is exactly make_components(description)
  std::vector<InputFile> inputs;
  std::string report;  ///< lines about how the model was read or made; may be empty
  std::vector<Rule> sizes =
      {};  ///< size rules by face name, as given to the verb that made the model; they come before the user's rules if a face has the name
  std::vector<Rule> layers = {};          ///< layer rules by face name, as given to the verb that made the model; volume_mesh takes them over
  std::vector<ModelPart> parts = {};      ///< parts in the order of the model; empty: one part, at its location. Code that replaces faces must clear it
  std::vector<std::string> through = {};  ///< for a tunnel: patterns of names of components or faces that may pass through its walls
  Provenance provenance = {};             ///< key of its inputs, for caches
};

/// Returns true if the name is that of a file with a model: CAD, .smx or (CPACS) .xml.
bool is_model_file(const std::filesystem::path& path);
/// Returns true if a model can be written to a file of that name.
bool is_model_output(const std::filesystem::path& path);

/// Reads a CAD, .smx or CPACS file; components of the last two stand side by side. `options` apply to CAD. The findings go to the log.
/// \throws Error of io::read_cad, read_smx, read_cpacs, make_components
ModelValue read_model(const InputPath& file, const ReadCadOptions& options, const RunContext& context);
/// Reads a model from a file that must be .smx.
ModelValue read_smx_model(const InputPath& file, const RunContext& context);
ModelValue read_cpacs_model(const InputPath& file, const RunContext& context);

/// Returns the content of an .smx or CPACS file as data, without a model.
/// \throws Error of read_smx, read_cpacs
Aircraft description_of(const InputPath& file, const RunContext& context);

/// Returns a model that was read from .smx or CPACS, with its control surfaces turned (with_controls_set). It is made again from the description, so the model
/// must not have been changed after reading.
/// \throws Error(bad_argument) for other models, and as with_controls_set and make_components
ModelValue deflected_model(const ModelValue& value, const std::vector<ControlSetting>& settings, const RunContext& context);

/// Checks the output path before the work starts.
/// \throws Error(unsupported_format, write_failed) if a model cannot be written to a file of this name
void require_model_output(const ModelValue& value, const std::filesystem::path& path);
/// Writes STEP, IGES or BREP by extension (geometry without exact form becomes splines), or .smx if there is a description.
/// \throws Error of io and geom
void write_model(const ModelValue& value, const std::filesystem::path& path, const WriteCadOptions& options, const RunContext& context);

/// Returns the box around the faces, from samples: within about a thousandth of its size.
Box box_of(const Model& model);
Box box_of(const Model& model, FaceId face);

/// Returns the whole components whose names match.
/// \throws Error(bad_argument) with the existing names if none matches
Model select_components(const Model& model, const std::string& pattern, const std::string& attempted);

/// Measures of a component, a solid, or the whole model: those of model_measures, and the area seen from above.
struct PartMeasures {
  std::string name;
  std::string kind;
  std::size_t n_faces = 0;
  double area = 0.0;            ///< m^2, wetted area
  double projected_area = 0.0;  ///< m^2, area as seen from above: half the sum over both sides, which is exact for closed convex shapes
  double volume = 0.0;          ///< m^3
  bool is_closed = false;       ///< has no free edges, so that the volume is defined
  Box box;
};
struct ModelReport {
  PartMeasures total;
  std::vector<PartMeasures> components;
  std::vector<PartMeasures> solids;
  std::vector<WingReference> wings;  ///< wings of the description
  std::string no_wings;              ///< reason why there are none although the model has wings; else empty
};
ModelReport measure_model(const ModelValue& value, const RunContext& context);

/// An edge with only one face.
struct OpenEdge {
  std::string face;
  std::string component;
  Point from, middle, to;
  double length = 0.0;
};
std::vector<OpenEdge> open_edges(const Model& model);
/// Returns "the plane y = 0 alone: 11 edges, 12.3 m" if all open edges lie in one plane of constant x, y or z, as for half models; else empty.
std::string open_plane_text(const std::vector<OpenEdge>& open);

/// Returns "Model: 12 components, 84 faces, 12 closed solids, 35.8 x 34.1 x 12.2 m".
std::string describe(const ModelValue& value);
/// Returns several lines: totals, solids, components, wings with their reference data.
std::string measures_text(const ModelReport& measures);
/// Returns several lines: if the model is closed, and every open edge (at most `limit`) with its face and location.
std::string closedness_text(const Model& model, std::size_t limit);

}  // namespace sterna::scripting
