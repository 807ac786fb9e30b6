// Reads STEP and IGES through OpenCASCADE's extended documents (XDE), which keep names, colours, layers and assemblies; BREP directly.
#include "geom/cad/translate.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <StepShape_ClosedShell.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <TColStd_HSequenceOfExtendedString.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <UnitsMethods.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <cerrno>
#include <cstring>
#include <map>
#include <sstream>
#include <streambuf>

#include "geom/cad/step_faces.h"
#include "geom/cad/text_encoding.h"

namespace sterna::cad {
namespace {

[[noreturn]] void malformed(const std::string& source, const std::string& problem, const std::string& hint = {}) {
  throw Error({.code = ErrorCode::file_malformed, .attempted = "reading " + source, .problem = problem, .hint = hint});
}

/// Converts names of any encoding to UTF-8: OpenCASCADE converts each byte to a character if a file does not declare its encoding.
std::string utf8(const TCollection_ExtendedString& text) {
  std::string bytes;
  for (int i = 1; i <= text.Length(); ++i) {
    const auto letter = static_cast<unsigned>(text.Value(i));
    if (letter > 0xffu) return TCollection_AsciiString(text, 0).ToCString();
    bytes += static_cast<char>(letter);
  }
  return utf8_of_bytes(bytes);
}

/// Returns true for names that translators generate if the file has none.
bool is_made_up(const std::string& name) {
  return name.empty() || name == "NONE" || name == "None" || name.starts_with("Open CASCADE") || name.starts_with("=>[") || name == "SOLID" ||
         name == "SHELL" || name == "COMPOUND" || name == "FACE" || name == "Unnamed" || name.find_first_not_of(" \t") == std::string::npos;
}

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) attribute;
  if (!label.FindAttribute(TDataStd_Name::GetID(), attribute)) return {};
  std::string name = utf8(attribute->Get());
  const std::size_t last = name.find_last_not_of(" \t");
  name.resize(last == std::string::npos ? 0 : last + 1);
  return is_made_up(name) ? std::string() : name;
}

/// Traverses a document: assemblies down to their parts, each with the accumulated placement and names.
class DocumentWalk {
 public:
  explicit DocumentWalk(const Handle(TDocStd_Document) & document)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        layers_(XCAFDoc_DocumentTool::LayerTool(document->Main())) {}

  LabelledShape walk() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (const TDF_Label& root : roots) visit(root, TopLoc_Location(), {}, {});
    return std::move(result_);
  }

 private:
  void visit(const TDF_Label& label, const TopLoc_Location& location, const std::string& instance, const FaceLabel& inherited) {
    const FaceLabel own = label_of(label);
    const FaceLabel merged{.name = {}, .colour = own.colour ? own.colour : inherited.colour, .layer = own.layer.empty() ? inherited.layer : own.layer};
    if (!XCAFDoc_ShapeTool::IsAssembly(label)) {
      add_part(label, location, instance, own.name, merged);
      return;
    }
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(label, components);
    for (const TDF_Label& component : components) {
      TDF_Label product;
      if (!XCAFDoc_ShapeTool::GetReferredShape(component, product)) continue;
      const FaceLabel of_instance = label_of(component);
      const std::string name = !of_instance.name.empty() && !of_instance.name.starts_with("NAUO") ? of_instance.name : name_of(product);
      visit(product, location * XCAFDoc_ShapeTool::GetLocation(component), name,
            {.name = {},
             .colour = of_instance.colour ? of_instance.colour : merged.colour,
             .layer = of_instance.layer.empty() ? merged.layer : of_instance.layer});
    }
  }

  void add_part(const TDF_Label& label, const TopLoc_Location& location, const std::string& instance, const std::string& product, const FaceLabel& merged) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    if (shape.IsNull()) return;
    const auto placed = [&](const TopoDS_Shape& s) { return s.Moved(location); };
    TDF_LabelSequence parts;
    XCAFDoc_ShapeTool::GetSubShapes(label, parts);
    // Names of solids and shells within a product, and labels of faces; labels of a solid apply to its faces.
    NCollection_DataMap<TopoDS_Shape, FaceLabel, TopTools_ShapeMapHasher> of_parts;
    for (const TDF_Label& part : parts) {
      const TopoDS_Shape sub = XCAFDoc_ShapeTool::GetShape(part);
      const FaceLabel own = label_of(part);
      if (sub.IsNull() || own.is_empty()) continue;
      if (sub.ShapeType() == TopAbs_FACE) result_.labels.Bind(placed(sub), own);
      else of_parts.Bind(placed(sub), own);
    }
    const std::string component = unique_component(!instance.empty() ? instance : product);
    const auto add = [&](const TopoDS_Shape& s) {
      ShapePart part{.shape = s, .component = component, .name = {}, .label = merged};
      if (const FaceLabel* own = of_parts.Seek(s)) {
        part.name = own->name;
        if (own->colour) part.label.colour = own->colour;
        if (!own->layer.empty()) part.label.layer = own->layer;
      }
      result_.parts.push_back(part);
    };
    const TopoDS_Shape whole = placed(shape);
    for (TopExp_Explorer s(whole, TopAbs_SOLID); s.More(); s.Next()) add(s.Current());
    for (TopExp_Explorer s(whole, TopAbs_SHELL, TopAbs_SOLID); s.More(); s.Next()) add(s.Current());
    for (TopExp_Explorer s(whole, TopAbs_FACE, TopAbs_SHELL); s.More(); s.Next()) add(s.Current());
    if (whole.ShapeType() == TopAbs_FACE && !product.empty()) {  // IGES: the name at the top level is that of the face
      FaceLabel own = merged;
      own.name = product;
      result_.labels.Bind(whole, own);
      result_.parts.back().component.clear();
    }
  }

  /// Creates a component name; several instances of a product are several components.
  std::string unique_component(const std::string& name) {
    if (name.empty()) return {};
    const int count = ++counts_[name];
    return count == 1 ? name : name + "_" + std::to_string(count);
  }

  FaceLabel label_of(const TDF_Label& label) const {
    FaceLabel result{.name = name_of(label), .colour = {}, .layer = {}};
    Quantity_Color colour;
    if (colours_->GetColor(label, XCAFDoc_ColorSurf, colour) || colours_->GetColor(label, XCAFDoc_ColorGen, colour)) {
      double r = 0.0, g = 0.0, b = 0.0;
      colour.Values(r, g, b, Quantity_TOC_sRGB);
      result.colour = {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
    }
    const Handle(TColStd_HSequenceOfExtendedString) layers = layers_->GetLayers(label);
    if (!layers.IsNull() && !layers->IsEmpty()) result.layer = utf8(layers->First());
    return result;
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  Handle(XCAFDoc_LayerTool) layers_;
  std::map<std::string, int> counts_;
  LabelledShape result_;
};

/// Stream over bytes, without a copy.
class ByteStream : public std::streambuf {
 public:
  explicit ByteStream(std::string_view bytes) {
    char* begin = const_cast<char*>(bytes.data());  // never written: a get area only
    setg(begin, begin, begin + bytes.size());
  }

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    char* base = from == std::ios_base::beg ? eback() : from == std::ios_base::cur ? gptr() : egptr();
    if (base + offset < eback() || base + offset > egptr()) return pos_type(off_type(-1));
    setg(eback(), base + offset, egptr());
    return gptr() - eback();
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override { return seekoff(off_type(position), std::ios_base::beg, mode); }
};

/// Bytes with a file name that OpenCASCADE's IGES reader, which does not support streams, can open.
class MemoryFile {
 public:
  MemoryFile(std::string_view bytes, const std::string& source) : descriptor_(memfd_create("sterna-cad", MFD_CLOEXEC)) {
    if (descriptor_ < 0) fail(source);
    while (!bytes.empty()) {
      const ssize_t n = write(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail(source);
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  ~MemoryFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  [[noreturn]] void fail(const std::string& source) {
    const std::string reason = std::strerror(errno);
    if (descriptor_ >= 0) close(descriptor_);
    throw Error({.code = ErrorCode::geometry_failed, .attempted = "reading " + source, .problem = "cannot create a file in memory: " + reason});
  }
  int descriptor_;
};

Handle(TDocStd_Document) new_document() {
  const Handle(TDocStd_Document) document = new TDocStd_Document("MDTV-XCAF");
  XCAFDoc_DocumentTool::Set(document->Main(), false);
  return document;
}

void set_common_parameters() {
  STEPCAFControl_Controller::Init();
  IGESCAFControl_Reader().WS();  // registers the IGES parameters
  XCAFDoc_ShapeTool::SetAutoNaming(false);
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
  Interface_Static::SetIVal("read.surfacecurve.mode", 0);
}

std::size_t count_shapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  std::size_t n = 0;
  for (TopExp_Explorer part(shape, kind); part.More(); part.Next()) ++n;
  return n;
}

/// Returns shells for which fewer faces were read than the file contains, and closed shells that fell apart: wrongly read borders.
std::vector<std::string> losses_of(const STEPControl_Reader& reader) {
  std::vector<std::string> losses;
  const Handle(StepData_StepModel) model = reader.StepModel();
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(StepShape_ConnectedFaceSet) shell = Handle(StepShape_ConnectedFaceSet)::DownCast(model->Value(i));
    if (shell.IsNull() || shell->CfsFaces().IsNull()) continue;
    const TopoDS_Shape came = TransferBRep::ShapeResult(process, shell);
    if (came.IsNull()) continue;  // not part of a translated solid or shell model, or merged into one
    const auto n_file = static_cast<std::size_t>(shell->NbCfsFaces());
    const std::size_t n_faces = count_shapes(came, TopAbs_FACE), n_shells = count_shapes(came, TopAbs_SHELL);
    const std::string name = "the shell #" + std::to_string(model->IdentLabel(shell)) + " of " + std::to_string(n_file) + " faces";
    if (n_faces < n_file) losses.push_back(name + " lost " + std::to_string(n_file - n_faces) + " of them when OpenCASCADE read the file");
    if (shell->IsKind(STANDARD_TYPE(StepShape_ClosedShell)) && n_shells > 1)
      losses.push_back(name + " is closed in the file and fell apart into " + std::to_string(n_shells) +
                       " when OpenCASCADE read the file: borders of faces are wrong");
  }
  return losses;
}

Translated translate_step(std::string_view bytes, const std::string& source, const Message_ProgressRange& progress) {
  STEPCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  reader.SetLayerMode(true);
  reader.SetPropsMode(false);
  ByteStream buffer(bytes);
  std::istream stream(&buffer);
  if (reader.ChangeReader().ReadStream(source.c_str(), stream) != IFSelect_RetDone)
    malformed(source, "not a STEP file that OpenCASCADE can parse", "is it complete? the last line should be END-ISO-10303-21;");
  Translated result;
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  result.file_unit = lengths.IsEmpty() ? "none" : lengths.First().ToCString();
  result.seams = give_seams(reader.ChangeReader().StepModel());
  Handle(TDocStd_Document) document = new_document();
  if (!reader.Transfer(document, progress)) malformed(source, "the file holds no shape that OpenCASCADE can translate");
  result.losses = losses_of(reader.ChangeReader());
  result.labelled = DocumentWalk(document).walk();
  return result;
}

/// Returns true if the last record belongs to the terminate section. In the fixed format, column 73 gives the section of a record.
bool has_iges_end(std::string_view bytes) {
  constexpr std::size_t k_section_column = 72;
  const std::size_t last = bytes.find_last_not_of(" \t\r\n");
  if (last == std::string_view::npos) return false;
  const std::size_t before = bytes.find_last_of("\r\n", last);
  const std::string_view record = bytes.substr(before == std::string_view::npos ? 0 : before + 1, last + 1);
  return record.size() > k_section_column && record[k_section_column] == 'T';
}

Translated translate_iges(std::string_view bytes, const std::string& source, const Message_ProgressRange& progress) {
  if (!has_iges_end(bytes)) malformed(source, "an IGES file without its last section", "is it complete? the last line should have a T in column 73");
  IGESCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  reader.SetLayerMode(true);
  const MemoryFile file(bytes, source);
  if (reader.ReadFile(file.path().c_str()) != IFSelect_RetDone) malformed(source, "not an IGES file that OpenCASCADE can parse");
  Translated result;
  const Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  const IGESData_GlobalSection& header = model->GlobalSection();
  result.file_unit = header.UnitName().IsNull() ? "none" : header.UnitName()->ToCString();
  result.unit = header.UnitValue();  // in units of xstep.cascade.unit, our metre
  Handle(TDocStd_Document) document = new_document();
  if (!reader.Transfer(document, progress)) malformed(source, "the file holds no shape that OpenCASCADE can translate");
  result.labelled = DocumentWalk(document).walk();
  return result;
}

Translated translate_brep(std::string_view bytes, const std::string& source, const Message_ProgressRange& progress) {
  // OpenCASCADE's reader prints missing sections to the terminal.
  for (const std::string_view section : {"\nLocations ", "\nCurve2ds ", "\nCurves ", "\nPolygon3D ", "\nSurfaces ", "\nTriangulations ", "\nTShapes "})
    if (bytes.find(section) == std::string_view::npos)
      malformed(source, "no section \"" + std::string(section.substr(1, section.size() - 2)) + "\"", "is it complete, and text rather than binary BREP?");
  ByteStream buffer(bytes);
  std::istream stream(&buffer);
  TopoDS_Shape shape;
  BRepTools::Read(shape, stream, BRep_Builder(), progress);
  if (shape.IsNull()) malformed(source, "not a BREP file that OpenCASCADE can parse");
  Translated result;
  result.file_unit = "none";
  const auto add = [&](const TopoDS_Shape& s) { result.labelled.parts.push_back({.shape = s, .component = {}, .name = {}, .label = {}}); };
  for (TopExp_Explorer s(shape, TopAbs_SOLID); s.More(); s.Next()) add(s.Current());
  for (TopExp_Explorer s(shape, TopAbs_SHELL, TopAbs_SOLID); s.More(); s.Next()) add(s.Current());
  for (TopExp_Explorer s(shape, TopAbs_FACE, TopAbs_SHELL); s.More(); s.Next()) add(s.Current());
  return result;
}

/// Returns metres per unit for STEP unit names as in FileUnits; 0 for unknown units.
double metres_of(const std::string& unit) {
  static const std::map<std::string, double> k_units = {
      {"METRE", 1.0},       {"MILLIMETRE", 1e-3}, {"CENTIMETRE", 1e-2}, {"DECIMETRE", 0.1}, {"KILOMETRE", 1e3}, {"MICROMETRE", 1e-6},
      {"INCH", 0.0254},     {"FOOT", 0.3048},     {"FEET", 0.3048},     {"YARD", 0.9144},   {"MILE", 1609.344}, {"metre", 1.0},
      {"millimetre", 1e-3}, {"centimetre", 1e-2}, {"inch", 0.0254},     {"foot", 0.3048},   {"METER", 1.0},     {"MILLIMETER", 1e-3}};
  const auto it = k_units.find(unit);
  return it == k_units.end() ? 0.0 : it->second;
}

}  // namespace

Translated translate(std::string_view bytes, CadFormat format, const std::string& source, const Message_ProgressRange& progress) {
  set_common_parameters();
  switch (format) {
    case CadFormat::step: {
      Translated result = translate_step(bytes, source, progress);
      if (const double unit = metres_of(result.file_unit); unit > 0.0) result.unit = unit;
      return result;
    }
    case CadFormat::iges: return translate_iges(bytes, source, progress);
    case CadFormat::brep: return translate_brep(bytes, source, progress);
  }
  return {};
}

void scale(LabelledShape& labelled, double factor) {
  gp_Trsf transformation;
  transformation.SetScaleFactor(factor);
  BRepBuilderAPI_Transform transform(compound_of(labelled.parts), transformation, true);
  FaceLabels labels;
  for (FaceLabels::Iterator it(labelled.labels); it.More(); it.Next()) labels.Bind(transform.ModifiedShape(it.Key()), it.Value());
  labelled.labels = labels;
  for (ShapePart& part : labelled.parts) part.shape = transform.ModifiedShape(part.shape);
}

}  // namespace sterna::cad
