// Steps: approximate geometry without an exact form by splines; make the shape without placements; create an extended document (XDE) with names, colours and
// layers; run the format's writer; remove the date from the header.
#include "geom/cad/write_cad.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Precision.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>

#include "geom/cad/check_written.h"
#include "geom/cad/occt_call.h"
#include "geom/cad/occt_shape.h"
#include "geom/cad/refit.h"
#include "geom/cad/split_closed.h"
#include "geom/cad/step_faces.h"

namespace sterna::cad {
namespace {

/// Placeholder for the date required by formats: files of the same model have the same bytes.
constexpr const char* k_step_date = "1970-01-01T00:00:00";
constexpr const char* k_iges_date = "19700101.000000";

/// Returns true if a copy of the shape is needed: documents would treat placed shapes as instances of an assembly; a spindle torus would be approximated.
bool needs_own_shape(const CadShape::Content& content) {
  return std::any_of(content.faces.begin(), content.faces.end(), [](const TopoDS_Face& face) {
    const Handle(Geom_ToroidalSurface) torus = Handle(Geom_ToroidalSurface)::DownCast(BRep_Tool::Surface(face));
    return !face.Location().IsIdentity() || (!torus.IsNull() && torus->MajorRadius() < torus->MinorRadius());
  });
}

TCollection_ExtendedString extended(const std::string& text) { return TCollection_ExtendedString(text.c_str(), true); }

/// Creates one free shape for each solid, shell and loose face, with labels on faces whose attributes differ from it.
class DocumentMaker {
 public:
  DocumentMaker(const Model& model, const CadShape::Content& content)
      : model_(model),
        content_(content),
        document_(new TDocStd_Document("MDTV-XCAF")),
        shapes_(XCAFDoc_DocumentTool::ShapeTool(document_->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document_->Main())),
        layers_(XCAFDoc_DocumentTool::LayerTool(document_->Main())) {}

  Handle(TDocStd_Document) make() {
    std::vector<bool> is_loose(model_.faces.size(), true);
    for (const SolidId s : model_.solids.ids()) {
      const std::vector<FaceId>& faces = model_.solids[s].faces;
      add_shape(content_.solids[s.index()], model_.solids[s].name, faces);
      for (const FaceId f : faces) is_loose[f.index()] = false;
    }
    for (const FaceId f : model_.faces.ids())
      if (is_loose[f.index()]) add_shape(content_.faces[f.index()], model_.faces[f].name, {f});
    return document_;
  }

 private:
  void add_shape(const TopoDS_Shape& shape, const std::string& name, const std::vector<FaceId>& faces) {
    const TDF_Label label = shapes_->AddShape(shape, false);
    TDataStd_Name::Set(label, extended(name));
    for (const FaceId f : faces) {
      const ModelFace& face = model_.faces[f];
      const bool is_whole = content_.faces[f.index()].IsSame(shape);
      if (face.name == name && !face.colour && face.layer.empty()) continue;
      const TDF_Label sub = is_whole ? label : shapes_->AddSubShape(label, content_.faces[f.index()]);
      if (sub.IsNull()) continue;  // it was in a previous solid
      if (face.name != name) TDataStd_Name::Set(sub, extended(face.name));
      if (face.colour) colours_->SetColor(sub, Quantity_Color((*face.colour)[0], (*face.colour)[1], (*face.colour)[2], Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
      if (!face.layer.empty()) layers_->SetLayer(sub, extended(face.layer));
    }
  }

  const Model& model_;
  const CadShape::Content& content_;
  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  Handle(XCAFDoc_LayerTool) layers_;
};

[[noreturn]] void refuse(const std::string& name, const std::string& problem) {
  throw Error({.code = ErrorCode::geometry_failed, .attempted = "writing " + name, .problem = problem});
}

std::string step_bytes(const Handle(TDocStd_Document) & document, const std::string& name, const WriteCadOptions& options,
                       const Message_ProgressRange& progress) {
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  Interface_Static::SetCVal("write.step.unit", "M");
  Interface_Static::SetIVal("write.stepcaf.subshapes.name", 1);
  Interface_Static::SetCVal("write.step.product.name", name.c_str());
  static const std::map<std::string, int> k_schemas = {{"ap203", 3}, {"ap214", 4}, {"ap242", 5}};  // OpenCASCADE's values of write.step.schema
  Interface_Static::SetIVal("write.step.schema", k_schemas.at(options.step_schema));
  STEPCAFControl_Writer writer;
  writer.SetNameMode(true);
  writer.SetColorMode(true);
  writer.SetLayerMode(true);
  writer.SetPropsMode(false);
  if (!writer.Transfer(document, STEPControl_AsIs, nullptr, progress)) refuse(name, "OpenCASCADE cannot translate the shape to STEP");
  const Handle(StepData_StepModel) model = writer.ChangeWriter().Model();
  static_cast<void>(give_seams(model));  // other programs also read with OpenCASCADE; remaining errors are found by reading the file back
  APIHeaderSection_MakeHeader header(model);
  const auto text = [](const char* t) { return new TCollection_HAsciiString(t); };
  header.SetName(text(name.c_str()));
  header.SetTimeStamp(text(k_step_date));
  header.SetOriginatingSystem(text("sterna"));
  header.SetPreprocessorVersion(text("sterna"));
  StepData_StepWriter file(model);
  file.SendModel(Handle(StepData_Protocol)::DownCast(writer.ChangeWriter().WS()->Protocol()));
  std::ostringstream stream;
  if (!file.Print(stream)) refuse(name, "OpenCASCADE cannot write the STEP file");
  return stream.str();
}

std::string iges_bytes(const Handle(TDocStd_Document) & document, const std::string& name, const Message_ProgressRange& progress) {
  IGESControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  Interface_Static::SetCVal("write.iges.unit", "M");
  Interface_Static::SetIVal("write.iges.brep.mode", 1);
  IGESCAFControl_Writer writer;
  writer.SetNameMode(false);  // OpenCASCADE writes names in the order of addresses: the bytes would differ between runs
  writer.SetColorMode(true);
  writer.SetLayerMode(true);
  if (!writer.Transfer(document, progress)) refuse(name, "OpenCASCADE cannot translate the shape to IGES");
  writer.ComputeModel();
  IGESData_GlobalSection header = writer.Model()->GlobalSection();
  header.SetDate(new TCollection_HAsciiString(k_iges_date));
  header.SetLastChangeDate(new TCollection_HAsciiString(k_iges_date));
  header.SetFileName(new TCollection_HAsciiString(name.c_str()));
  header.SetAuthorName(new TCollection_HAsciiString("sterna"));
  writer.Model()->SetGlobalSection(header);
  std::ostringstream stream;
  if (!writer.Write(stream)) refuse(name, "OpenCASCADE cannot write the IGES file");
  return stream.str();
}

/// Returns the longest side of the box of the corners.
double size_of(const Model& model) {
  if (model.corners.size() == 0) return 0.0;
  Point low = model.corners[CornerId(0)].point, high = low;
  for (const ModelCorner& corner : model.corners) {
    low = {std::min(low.x, corner.point.x), std::min(low.y, corner.point.y), std::min(low.z, corner.point.z)};
    high = {std::max(high.x, corner.point.x), std::max(high.y, corner.point.y), std::max(high.z, corner.point.z)};
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

/// Largest error of refitting, relative to the longest side. It is a tenth of the sewing tolerance of other programs.
constexpr double k_refit_share = 1e-6;

Model exact_for_export(const Model& model, const std::string& name, const WriteCadOptions& options, const RunContext& context) {
  const double tolerance = is_automatic(options.tolerance) ? std::max(k_refit_share * size_of(model), Precision::Confusion()) : options.tolerance;
  RefitReport report;
  Model exact = refitted(model, tolerance, report, context);
  char error[32];
  std::snprintf(error, sizeof error, "%.2g", report.error);
  context.info("writing " + name + ": " + std::to_string(report.n_surfaces) + " surfaces and " + std::to_string(report.n_curves) +
               " curves have no exact form; they were replaced by splines within " + error + " m");
  return exact;
}

std::string bytes_of(const Model& model, CadFormat format, const std::string& name, const WriteCadOptions& options, const RunContext& context) {
  std::shared_ptr<const CadShape> shape = shape_of(model, context);
  if (needs_own_shape(shape->content())) {
    Model bare = model;
    bare.shape.reset();
    shape = shape_of(bare, context);
  }
  std::string bytes;
  run_occt({.attempted = "writing " + name}, context, [&](const Message_ProgressRange& progress) {
    switch (format) {
      case CadFormat::step: bytes = step_bytes(DocumentMaker(model, shape->content()).make(), name, options, progress); break;
      case CadFormat::iges: bytes = iges_bytes(DocumentMaker(model, shape->content()).make(), name, progress); break;
      case CadFormat::brep: {
        std::ostringstream stream;
        BRepTools::Write(shape->content().shape, stream, progress);
        bytes = stream.str();
        break;
      }
    }
  });
  return bytes;
}

}  // namespace

std::string cad_bytes(const Model& original, CadFormat format, const std::string& name, const WriteCadOptions& options, const RunContext& context) {
  const bool is_refitted = !original.shape && needs_refit(original);
  const Model model = is_refitted ? exact_for_export(original, name, options, context) : original;
  std::string bytes = bytes_of(model, format, name, options, context);
  if (format != CadFormat::brep)
    for (const std::string& solid : solids_around_fluid(model, context))
      context.warn("writing " + name + ": \"" + solid +
                   "\" encloses the fluid, but STEP and IGES store every solid as a body; read the file with fluid = \"inside\"");
  const std::vector<std::string> differences = differences_of_file(model, bytes, format, name, context);
  if (differences.empty()) return bytes;
  if (const std::optional<Model> split = split_closed_faces(model, context)) {
    bytes = bytes_of(*split, format, name, options, context);
    if (differences_of_file(*split, bytes, format, name, context).empty()) {
      context.info("writing " + name + ": faces on closed surfaces were split into halves, because readers of this format lose undivided ones (" +
                   differences.front() + ")");
      return bytes;
    }
  }
  std::string problem = "the written file does not hold the same model when it is read again";
  for (const std::string& difference : differences) problem += "; " + difference;
  throw Error({.code = ErrorCode::geometry_failed,
               .attempted = "writing " + name,
               .problem = problem,
               .hint = "write a BREP file, which holds the model unchanged; or write fewer parts at once to find the part that causes the failure"});
}

}  // namespace sterna::cad
