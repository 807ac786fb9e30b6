// The program as a user runs it: exit status, output on stdout and stderr, files left behind.
#include <cstdio>
#include <fstream>
#include <sstream>

#include "scripting/terminal/exit_status.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using test::ProcessResult;

class ProgramArguments : public testing::Test {
 protected:
  ProgramArguments() : folder(test::scratch()) { std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder / "box.stl"); }

  ProcessResult sterna(const std::vector<std::string>& arguments, double interrupt_after = -1.0) {
    return test::run_process(test::sterna_program(), arguments, folder, interrupt_after);
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
  std::vector<std::string> files() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  std::filesystem::path folder;
};

TEST_F(ProgramArguments, HelpAndVersionSucceedOnStdout) {
  EXPECT_EQ(sterna({"--version"}).output, "sterna 0.1.0\n");
  const ProcessResult help = sterna({"--help"});
  EXPECT_EQ(help.status, k_exit_success);
  for (const char* part : {"run", "mesh", "check", "info", "convert", "formats", "Exit status: 0 success"})
    EXPECT_NE(help.output.find(part), std::string::npos) << part;
  const ProcessResult mesh = sterna({"mesh", "--help"});
  for (const char* part : {"--layers", "--first-height", "--max-growth", "--farfield-radius", "--unit", "--split-angle", "--set"})
    EXPECT_NE(mesh.output.find(part), std::string::npos) << part;
  EXPECT_EQ(mesh.errors, "");
}

TEST_F(ProgramArguments, WrongUseIsStatusTwo) {
  EXPECT_EQ(sterna({}).status, k_exit_usage);
  EXPECT_EQ(sterna({"mash"}).status, k_exit_usage);
  EXPECT_EQ(sterna({"mesh", "box.stl"}).status, k_exit_usage);
  for (const char* const option : {"--fill-crevices", "--disc", "--stats"}) {
    const ProcessResult empty = sterna({"mesh", "box.stl", "-o", "m.su2", "--first-height", "1e-2", option, ""});
    EXPECT_EQ(empty.status, k_exit_usage) << option;
    EXPECT_NE(empty.errors.find("the value is empty"), std::string::npos) << empty.errors;
  }
  EXPECT_EQ(sterna({"check", "m.su2", "--for", ""}).status, k_exit_usage);
  EXPECT_NE(sterna({"draw", "box.stl", "-o", "a.png", "--width", ""}).errors.find("\"\" is not"), std::string::npos);
  EXPECT_EQ(sterna({"mesh", "box.stl", "-o", "m.su2", "--set", "nonsense"}).status, k_exit_usage);
  EXPECT_EQ(sterna({"run", "box.lua", "--threads", "-1"}).status, k_exit_usage);
  EXPECT_EQ(files(), std::vector<std::string>{"box.stl"});
}

TEST_F(ProgramArguments, MisspeltNamesGetASuggestion) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"mash", "box.stl"}, "did you mean mesh?"},
      {{"--threads", "2", "covnert", "box.stl", "a.obj"}, "did you mean convert?"},
      {{"mesh", "box.stl", "--layres", "3", "-o", "m.su2"}, "there is no option of mesh --layres, did you mean --layers?"},
      {{"mesh", "box.stl", "--first-height", "12deg", "-o", "m.su2"}, "\"12deg\" is an angle, expected a length"},
      {{"mesh", "box.stl", "--first-height", "1e-3", "--split-angle", "2mm", "-o", "m.su2"}, "\"2mm\" is a length, expected an angle"},
      {{"mesh", "box.stl", "--first-height", "1e-3", "--unit", "parsec", "-o", "m.su2"}, "\"parsec\" is neither a number nor a unit of length"},
  };
  for (const auto& [arguments, text] : cases) {
    const ProcessResult result = sterna(arguments);
    EXPECT_EQ(result.status, k_exit_usage) << text;
    EXPECT_NE(result.errors.find(text), std::string::npos) << result.errors;
  }
  std::filesystem::create_directory(folder / "parts");
  EXPECT_NE(sterna({"info", "parts"}).errors.find("the path is a folder"), std::string::npos);
}

TEST_F(ProgramArguments, SurfacesInFormatsOfVolumesAreSurfaces) {
  for (const char* name : {"wall.cgns", "wall.adf.cgns", "wall.su2", "wall.vtu", "wall.taumesh", "wall.msh", "wall.meshb", "wall.lb8.ugrid", "wall.vtkhdf"}) {
    SCOPED_TRACE(name);
    const ProcessResult written = sterna({"convert", "box.stl", name});
    if (written.status != k_exit_success) {  // some volume formats do not accept surfaces
      EXPECT_NE(written.errors.find("surface"), std::string::npos) << written.errors;
      continue;
    }
    const ProcessResult info = sterna({"info", name});
    EXPECT_EQ(info.status, k_exit_success) << info.errors;
    EXPECT_NE(info.output.find("surface  12 triangles"), std::string::npos) << info.output;
    const ProcessResult back = sterna({"convert", name, "back.off"});
    EXPECT_EQ(back.status, k_exit_success) << back.errors;
    const ProcessResult check = sterna({"check", name});
    EXPECT_EQ(check.status, k_exit_failed) << check.output;
    EXPECT_NE(check.errors.find("the file has a surface of 12 triangles, but no cells"), std::string::npos) << check.errors;
    EXPECT_NE(check.errors.find("sterna info"), std::string::npos);
  }
  EXPECT_NE(sterna({"check", "box.stl"}).errors.find("holds surfaces only"), std::string::npos);
}

TEST_F(ProgramArguments, AllWrongOptionsAreNamedTogether) {
  const ProcessResult result = sterna({"mesh", "box.stl", "-o", "m.su2", "--layers", "-1", "--split-angle", "400", "--set", "envelope.max_grwoth=2"});
  EXPECT_EQ(result.status, k_exit_usage);
  for (const char* part : {"error: ", "4 problems", "envelope.layers: -1 is not allowed", "(400 deg) is not allowed", "did you mean \"envelope.max_growth\"?",
                           "needs first_height"})
    EXPECT_NE(result.errors.find(part), std::string::npos) << part << " in\n" << result.errors;
  EXPECT_EQ(result.output, "");
}

TEST_F(ProgramArguments, OutputsAreCheckedBeforeTheWork) {
  const ProcessResult format = sterna({"mesh", "no_such.stl", "--first-height", "1e-3", "-o", "m.docx"});
  EXPECT_EQ(format.status, k_exit_failed);
  EXPECT_NE(format.errors.find("m.docx"), std::string::npos) << format.errors;
  const ProcessResult location = sterna({"mesh", "no_such.stl", "--first-height", "1e-3", "-o", "nowhere/m.su2"});
  EXPECT_EQ(location.status, k_exit_failed);
  EXPECT_NE(location.errors.find("there is no folder nowhere"), std::string::npos) << location.errors;
}

TEST_F(ProgramArguments, MissingFilesAreNamed) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"mesh", "no_such.stl", "--first-height", "1e-3", "-o", "m.su2"}, {"check", "no_such.su2"}, {"info", "no_such.stl"}, {"run", "no_such.lua"}}) {
    const ProcessResult result = sterna(arguments);
    EXPECT_EQ(result.status, k_exit_failed) << arguments.front();
    EXPECT_NE(result.errors.find("error: "), std::string::npos);
    EXPECT_NE(result.errors.find("no_such"), std::string::npos) << result.errors;
    EXPECT_EQ(result.output, "") << "said before the file was looked for";
  }
  EXPECT_EQ(files(), std::vector<std::string>{"box.stl"});
}

TEST_F(ProgramArguments, ResultsGoToStdoutAndLogToStderr) {
  write("case.lua", "print(read_surface{ 'box.stl', unit = mm })");
  const ProcessResult result = sterna({"run", "case.lua"});
  EXPECT_EQ(result.status, k_exit_success) << result.errors;
  EXPECT_EQ(result.output, "TriMesh: 12 triangles, closed, 1 patch, 0.001 m long\n");
  EXPECT_NE(result.errors.find("1 unit of the file = 0.001 m"), std::string::npos) << result.errors;
  EXPECT_EQ(result.errors.find('\r'), std::string::npos) << "a progress line on a stderr that is no terminal";
  EXPECT_EQ(sterna({"run", "case.lua", "--quiet"}).errors, "");
  EXPECT_EQ(sterna({"run", "case.lua", "--quiet", "--log", "run.log"}).errors, "");
  EXPECT_GT(std::filesystem::file_size(folder / "run.log"), 0u);
}

TEST_F(ProgramArguments, InfoDescribesASurfaceInMetres) {
  const ProcessResult result = sterna({"info", "box.stl", "--unit", "inch"});
  EXPECT_EQ(result.status, k_exit_success) << result.errors;
  for (const char* part : {"STL", "1 unit of the file = 0.0254 m", "12 triangles", "closed", "(0.0254, 0.0254, 0.0254)", "\"box\", wall: 12 triangles"})
    EXPECT_NE(result.output.find(part), std::string::npos) << part << " in\n" << result.output;
}

TEST_F(ProgramArguments, AnOpenSurfaceIsDrawn) {
  std::ifstream whole(folder / "box.stl");
  std::string text{std::istreambuf_iterator<char>(whole), {}};
  const std::size_t facet = text.find(" facet");
  text.erase(facet, text.find(" facet", facet + 1) - facet);
  write("open.stl", text);
  const ProcessResult result = sterna({"mesh", "open.stl", "--first-height", "1e-3", "-o", "m.su2"});
  EXPECT_EQ(result.status, k_exit_failed);
  EXPECT_NE(result.errors.find("m.su2.trouble.vtu"), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find("(0.5, 0.5, 0)"), std::string::npos) << result.errors;
  EXPECT_EQ(files(), (std::vector<std::string>{"box.stl", "m.su2.trouble.vtu", "open.stl"}));
  std::filesystem::create_directory(folder / "dump");
  EXPECT_NE(sterna({"mesh", "open.stl", "--first-height", "1e-3", "-o", "m.su2", "--dump-dir", "dump"}).errors.find("dump/m.su2.trouble.vtu"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder / "dump" / "m.su2.trouble.vtu"));
}

TEST_F(ProgramArguments, CtrlCEndsAScriptWithinASecond) {
  write("case.lua", "while true do pcall(function() while true do end end) end");
  const ProcessResult result = sterna({"run", "case.lua"}, 0.3);
  EXPECT_EQ(result.status, k_exit_interrupted) << result.errors;
  EXPECT_LT(result.seconds_after_interrupt, 1.0);
  EXPECT_NE(result.errors.find("stopped on request"), std::string::npos) << result.errors;
}

TEST_F(ProgramArguments, FormatsListsTheTable) {
  const ProcessResult result = sterna({"formats"});
  EXPECT_EQ(result.status, k_exit_success);
  for (const char* part : {"STL", "SU2", "VTU", "read, write"}) EXPECT_NE(result.output.find(part), std::string::npos) << part;
}

TEST_F(ProgramArguments, ConvertKeepsWhatItIs) {
  ASSERT_EQ(sterna({"convert", "box.stl", "box.obj"}).status, k_exit_success);
  const ProcessResult surface = sterna({"info", "box.obj"});
  EXPECT_NE(surface.output.find("closed"), std::string::npos) << surface.output;
  EXPECT_NE(surface.output.find("quality  area"), std::string::npos) << surface.output;
  ASSERT_EQ(sterna({"convert", "box.obj", "box.dat", "--format", "legacy"}).status, k_exit_failed);  // no such format
  ASSERT_EQ(sterna({"convert", "box.obj", "box.dat", "--format", "STL text"}).status, k_exit_success);
  EXPECT_EQ(files(), (std::vector<std::string>{"box.dat", "box.obj", "box.stl"}));
  const ProcessResult volume = sterna({"convert", "box.obj", "box.foam"});  // OpenFOAM holds volumes only
  EXPECT_EQ(volume.status, k_exit_failed);
  EXPECT_NE(volume.errors.find("OpenFOAM is not written as a surface"), std::string::npos) << volume.errors;
}

TEST_F(ProgramArguments, OpenFoamCasesByEachOfTheirNames) {
  write("tet.su2",
        "NDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nNMARK= 1\nMARKER_TAG= skin\nMARKER_ELEMS= 4\n5 0 2 1\n5 0 1 3\n5 1 2 3\n5 2 0 "
        "3\n");
  std::filesystem::create_directories(folder / "old.foam");  // a case that is a folder, like the samples
  ASSERT_EQ(sterna({"convert", "tet.su2", "new.foam"}).status, k_exit_success);
  ASSERT_EQ(sterna({"convert", "tet.su2", "old.foam"}).status, k_exit_success);
  EXPECT_TRUE(std::filesystem::is_regular_file(folder / "new.foam"));
  EXPECT_TRUE(std::filesystem::exists(folder / "old.foam" / "constant" / "polyMesh" / "faces"));
  for (const std::string name : {"new.foam", "constant/polyMesh", "constant/polyMesh/", "old.foam", "old.foam/", "old.foam/constant/polyMesh"}) {
    SCOPED_TRACE(name);
    const ProcessResult info = sterna({"info", name});
    EXPECT_EQ(info.status, k_exit_success) << info.errors;
    for (const char* part : {"OpenFOAM", "1 tetrahedron", "\"skin\""}) EXPECT_NE(info.output.find(part), std::string::npos) << info.output;
    const ProcessResult check = sterna({"check", name});
    EXPECT_EQ(check.status, k_exit_success) << check.errors;
    ASSERT_EQ(sterna({"convert", name, "back.su2"}).status, k_exit_success);
    std::filesystem::remove(folder / "back.su2");
  }
  write("manifest.lua", "local mesh = read_mesh{ \"new.foam\" }\nmesh:write(\"again.su2\")\n");
  ASSERT_EQ(sterna({"run", "manifest.lua"}).status, k_exit_success);
  std::stringstream manifest;
  manifest << std::ifstream(folder / "again.su2.json").rdbuf();
  EXPECT_NE(manifest.str().find("\"file\": \"new.foam\""), std::string::npos) << manifest.str();
  // A second mesh would replace the first; the program refuses this before any work.
  const ProcessResult refused = sterna({"mesh", "box.stl", "-o", "second.foam"});
  EXPECT_EQ(refused.status, k_exit_failed);
  EXPECT_NE(refused.errors.find("belongs to new.foam"), std::string::npos) << refused.errors;
}

TEST_F(ProgramArguments, ConvertWritesVolumesOrTheirBoundaryOnRequest) {
  write("tet.su2",
        "NDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nNMARK= 1\nMARKER_TAG= skin\nMARKER_ELEMS= 4\n5 0 2 1\n5 0 1 3\n5 1 2 3\n5 2 0 "
        "3\n");
  ASSERT_EQ(sterna({"convert", "tet.su2", "tet.lb8.ugrid"}).status, k_exit_success);
  const ProcessResult info = sterna({"info", "tet.lb8.ugrid"});
  for (const char* part : {"1 tetrahedron", "\"skin\"", "no faults found"}) EXPECT_NE(info.output.find(part), std::string::npos) << info.output;
  const ProcessResult refused = sterna({"convert", "tet.su2", "tet.stl"});
  EXPECT_EQ(refused.status, k_exit_failed);
  for (const char* part : {"a volume mesh of 1 cells", "--surface"}) EXPECT_NE(refused.errors.find(part), std::string::npos) << refused.errors;
  ASSERT_EQ(sterna({"convert", "tet.su2", "tet.vtp", "--surface"}).status, k_exit_success);
  EXPECT_NE(sterna({"info", "tet.vtp"}).output.find("4 triangles"), std::string::npos);
}

TEST_F(ProgramArguments, ModelsAreConvertedUnitedDescribedAndChecked) {
  write("parts.lua",
        "box{ {0,0,0}, {1,1,1} }:write 'a.step' box{ {0.5,0.25,0.25}, {2,0.75,0.75}, name='arm' }:write 'b.step' fuselage{ name='body', frames={ "
        "{x=0,diameter=1}, {x=3,diameter=1} } }:model():write 'body.smx' "
        "surface{ function(u, v) return u, v, u*v end, name = 'sheet' }:write 'sheet.brep'");
  ASSERT_EQ(sterna({"run", "parts.lua", "-q"}).status, k_exit_success);
  ASSERT_EQ(sterna({"union", "a.step", "b.step", "-o", "c.step"}).status, k_exit_success);
  const ProcessResult info = sterna({"info", "c.step"});
  for (const char* part : {"1 closed solid", "volume 1.25 m^3", "projected from above 1.5 m^2", "no open edge"})
    EXPECT_NE(info.output.find(part), std::string::npos) << part << " in\n" << info.output;
  const ProcessResult smx = sterna({"info", "body.smx"});
  EXPECT_NE(smx.output.find("\"body\", body"), std::string::npos) << smx.output;
  EXPECT_EQ(smx.errors.find("Model:"), std::string::npos) << "told twice: " << smx.errors;
  EXPECT_EQ(info.errors.find("closed solid"), std::string::npos) << "told twice: " << info.errors;
  for (const char* name : {"c.iges", "c.brep", "c2.step"}) EXPECT_EQ(sterna({"convert", "c.step", name}).status, k_exit_success) << name;
  EXPECT_EQ(sterna({"convert", "body.smx", "body.step", "--step-schema", "ap242"}).status, k_exit_success);
  EXPECT_EQ(sterna({"check", "body.step"}).status, k_exit_success);
  const ProcessResult open = sterna({"check", "sheet.brep"});
  EXPECT_EQ(open.status, k_exit_invalid);
  for (const char* part : {"4 open edges", "face \"sheet\"", "(1, 1, 1)", "OPEN"})
    EXPECT_NE(open.output.find(part), std::string::npos) << part << " in\n" << open.output;
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
      {{"convert", "c.step", "c.smx"}, ".smx requires components defined as data"},
      {{"convert", "c.step", "c.stl"}, "models are not written in this format"},
      {{"convert", "c.step", "c.iges", "--surface"}, "--surface apply to meshes"},
      {{"convert", "box.stl", "box.obj", "--step-schema", "ap203"}, "applies to models"},
      {{"union", "a.step", "box.stl", "-o", "d.step"}, "box.stl is not a model"},
      {{"union", "a.step", "b.step", "-o", "d.stl"}, "models are not written in this format"},
      {{"union", "a.step", "b.step", "-o", "d.step", "--strip-width", "3"}, "strip_width"},
      {{"check", "a.step", "--json"}, "--json applies to volume meshes"},
  };
  for (const auto& [arguments, text] : refused) {
    const ProcessResult result = sterna(arguments);
    EXPECT_NE(result.status, k_exit_success) << text;
    EXPECT_NE(result.errors.find(text), std::string::npos) << text << " in\n" << result.errors;
  }
}

TEST_F(ProgramArguments, SumoAndCpacsFilesBecomeStep) {
  STERNA_NEEDS_SHARED_DATA();
  const std::vector<std::pair<std::string, std::string>> files = {{"smx/delta.smx", "5 closed solids"}, {"cpacs/d150.xml", "4 closed solids"}};
  for (const auto& [name, solids] : files) {
    const std::string path = (test::shared_data() / name).string();
    ASSERT_EQ(sterna({"convert", path, "a.step"}).status, k_exit_success) << name;
    const ProcessResult check = sterna({"check", "a.step"});
    EXPECT_EQ(check.status, k_exit_success) << name;
    EXPECT_NE(check.output.find(solids), std::string::npos) << check.output;
    EXPECT_NE(sterna({"info", path}).output.find("aspect ratio"), std::string::npos) << name;
  }
  EXPECT_EQ(sterna({"convert", (test::shared_data() / "smx/delta.smx").string(), "again.smx"}).status, k_exit_success);
}

TEST_F(ProgramArguments, UnionOfSurfaceFiles) {
  std::ifstream box(folder / "box.stl");
  std::ofstream moved(folder / "moved.stl");
  for (std::string line; std::getline(box, line);) {
    double x = 0.0, y = 0.0, z = 0.0;
    if (std::sscanf(line.c_str(), " vertex %lf %lf %lf", &x, &y, &z) == 3)
      moved << "vertex " << x + 0.5 << " " << 0.5 * y + 0.25 << " " << 0.5 * z + 0.25 << "\n";
    else moved << line << "\n";
  }
  moved.close();
  const ProcessResult united = sterna({"union", "box.stl", "moved.stl", "-o", "wall.stl", "--unit", "mm"});
  EXPECT_EQ(united.status, k_exit_success) << united.errors;
  const ProcessResult info = sterna({"info", "wall.stl"});
  for (const char* part : {"closed", "longest side 0.0015 m"}) EXPECT_NE(info.output.find(part), std::string::npos) << info.output;
  EXPECT_NE(sterna({"formats"}).output.find("CPACS"), std::string::npos);
}

TEST_F(ProgramArguments, DoctorMakesASmallMeshByEachEngine) {
  const test::ProcessResult result = sterna({"doctor"});
  EXPECT_EQ(result.status, k_exit_success) << result.output << result.errors;
  for (const char* part : {"libTKernel.so", "threads in use", "engine sterna  ok", "engine hxt     ok", "engine tetgen  ok", "VALID"})
    EXPECT_NE(result.output.find(part), std::string::npos) << part << " in\n" << result.output;
  const std::vector<std::string> no_room = {"-c", "TMPDIR=/nowhere " + test::sterna_program().string() + " doctor"};
  EXPECT_EQ(test::run_process("/bin/sh", no_room, folder).status, k_exit_failed);
}

}  // namespace
}  // namespace sterna::scripting
