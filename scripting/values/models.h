// Models (exact geometry) as values of scripts and commands: read, described, measured, selected, written.
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

/// A model with where it came from.
struct ModelValue {
  Model model;
  std::optional<Aircraft> description;  ///< components as data, in the model's place and shape
  std::string without_description;      ///< why there is none: "rotate", "read from a.step"
  bool is_as_described = false;         ///< the model is make_components(description) and nothing else: of a file
  std::vector<InputFile> inputs;
  std::string report;  ///< lines about how it was read or made; may be empty
  std::vector<surfmesh::PatchSurfaceOptions> sizes =
      {};  ///< of its faces by name, as the verb that made it was told; count before the user's rules where a face has the name
  std::vector<volmesh::PatchRule> layers = {};  ///< of its patches, the same; volume_mesh takes them over
  std::vector<ModelPart> parts = {};            ///< of the model, in its order; empty: one part, in its place. Whoever gives the model other faces clears them
  std::vector<std::string> through = {};        ///< of a tunnel: patterns of the names of components or faces that may pass through its walls
  Provenance provenance = {};                   ///< what it was made of, for caches
};

/// Whether the name is that of a file with a model: CAD, .smx or (CPACS) .xml.
bool is_model_file(const std::filesystem::path& path);
/// Whether a model can be written to a file of that name.
bool is_model_output(const std::filesystem::path& path);

/// Reads a CAD, .smx or CPACS file; components of the last two stand side by side. `options` count for CAD. What was found goes to the log.
/// \throws Error of io::read_cad, read_smx, read_cpacs, make_components
ModelValue read_model(const InputPath& file, const ReadCadOptions& options, const RunContext& context);
/// The same for a file that must be of that kind.
ModelValue read_smx_model(const InputPath& file, const RunContext& context);
ModelValue read_cpacs_model(const InputPath& file, const RunContext& context);

/// What an .smx or CPACS file describes, without a model of it.
/// \throws Error of read_smx, read_cpacs
Aircraft description_of(const InputPath& file, const RunContext& context);

/// A model that was read from .smx or CPACS with its control surfaces turned (with_controls_set); what moved it afterwards is lost with its description.
/// \throws Error(bad_argument) for other models, and as with_controls_set and make_components
ModelValue deflected_model(const ModelValue& value, const std::vector<ControlSetting>& settings, const RunContext& context);

/// \throws Error(unsupported_format, write_failed) when a model cannot be written to a file of this name. Before the work.
void require_model_output(const ModelValue& value, const std::filesystem::path& path);
/// STEP, IGES, BREP by extension (what has no exact form becomes splines), .smx where there is a description.
/// \throws Error of io and geom
void write_model(const ModelValue& value, const std::filesystem::path& path, const WriteCadOptions& options, const RunContext& context);

/// Box around the faces, from samples: within about a thousandth of its size.
Box box_of(const Model& model);
Box box_of(const Model& model, FaceId face);

/// The components whose names match, whole.
/// \throws Error(bad_argument) naming those that exist where none does
Model select_components(const Model& model, const std::string& pattern, const std::string& attempted);

/// Of a component, a solid, or all: what model_measures finds, and the view from above.
struct PartMeasures {
  std::string name;
  std::string kind;
  std::size_t n_faces = 0;
  double area = 0.0;            ///< wetted, m^2
  double projected_area = 0.0;  ///< as seen from above, each side counted half: exact for closed convex shapes, m^2
  double volume = 0.0;          ///< m^3
  bool is_closed = false;       ///< without free edges: it has a volume
  Box box;
};
struct ModelReport {
  PartMeasures total;
  std::vector<PartMeasures> components;
  std::vector<PartMeasures> solids;
  std::vector<WingReference> wings;  ///< of the description
  std::string no_wings;              ///< why there are none although there are wings; else empty
};
ModelReport measure_model(const ModelValue& value, const RunContext& context);

/// A border that only one face has.
struct OpenEdge {
  std::string face;
  std::string component;
  Point from, middle, to;
  double length = 0.0;
};
std::vector<OpenEdge> open_edges(const Model& model);
/// "the plane y = 0 alone: 11 edges, 12.3 m", where all of them lie in one plane of constant x, y or z, as those of half models do; else empty.
std::string open_plane_text(const std::vector<OpenEdge>& open);

/// "Model: 12 components, 84 faces, 12 closed solids, 35.8 x 34.1 x 12.2 m"
std::string describe(const ModelValue& value);
/// Several lines: totals, solids, components, wings with their reference data.
std::string measures_text(const ModelReport& measures);
/// Several lines: closed or not, every open edge (at most `limit`) with its face and place.
std::string closedness_text(const Model& model, std::size_t limit);

}  // namespace sterna::scripting
