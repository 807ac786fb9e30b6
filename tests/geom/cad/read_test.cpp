#include <algorithm>
#include <fstream>

#include "geom/cad/shape.h"
#include "geom/model/model_measures.h"
#include "io/file/cad_file.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

CadFile read(const std::string& name, const ReadCadOptions& options = {}) { return io::read_cad(test::shared_data() / "cad" / name, options, RunContext()); }

/// Checks that borders run head to tail, and that an edge's curves in space and in its faces agree within the edge's tolerance.
void expect_consistent(const Model& model) {
  for (const FaceId f : model.faces.ids()) {
    const ModelFace& face = model.faces[f];
    ASSERT_FALSE(face.name.empty());
    ASSERT_FALSE(face.borders.empty());
    for (const Border& border : face.borders)
      for (std::size_t i = 0; i < border.size(); ++i) {
        const EdgeUse& use = border[i];
        const EdgeUse& next = border[(i + 1) % border.size()];
        const ModelEdge& edge = model.edges[use.edge];
        const ModelEdge& next_edge = model.edges[next.edge];
        EXPECT_EQ(use.is_reversed ? edge.start : edge.end, next.is_reversed ? next_edge.end : next_edge.start) << "face " << f.index();
        if (edge.is_degenerate()) continue;
        for (const double share : {0.0, 0.31, 1.0}) {
          const double t = edge.range.from + share * edge.range.length();
          EXPECT_LE(distance(edge.curve->point(t), face.surface->point(use.parameter->point(t))),
                    1.5 * edge.tolerance + 1e-7)  // between the sampled points the deviation may be slightly larger

              << "face " << f.index() << " (" << face.surface->kind() << ") edge " << use.edge.index() << " at " << format_point(edge.curve->point(t));
        }
      }
  }
}

TEST(ReadCad, AssemblyKeepsInstancesAndFaceNames) {
  STERNA_NEEDS_SHARED_DATA();
  const CadFile file = read("gmsh_parts_as1-tu-203.stp");
  EXPECT_EQ(file.report.n_faces, 160u);
  EXPECT_EQ(file.report.n_closed, 18u);
  EXPECT_EQ(file.model.components.size(), 18u);
  EXPECT_TRUE(file.report.is_closed());
  EXPECT_EQ(file.report.unit, 1e-3);
  expect_consistent(file.model);
  for (const Component& component : file.model.components) EXPECT_FALSE(component.name.empty());
}

TEST(ReadCad, LooseIgesFacesBecomeASolid) {
  STERNA_NEEDS_SHARED_DATA();
  const CadFile file = read("ansys_bracket.iges");
  EXPECT_EQ(file.report.n_faces, 73u);
  EXPECT_TRUE(file.report.is_closed()) << to_text(file.report);
  EXPECT_FALSE(file.report.repaired.empty());
  EXPECT_NEAR(file.report.unit, 0.0254, 1e-12);
  expect_consistent(file.model);
  EXPECT_GT(model_measures(file.model, RunContext()).total.volume, 0.0);
}

TEST(ReadCad, ImplausibleUnitWarnsAndCanBeOverruled) {
  STERNA_NEEDS_SHARED_DATA();
  const CadFile as_written = read("iea15_rotor_IEA_15MW_CFD.stp");
  EXPECT_EQ(as_written.report.unit, 1e-3);
  ASSERT_FALSE(as_written.report.warnings.empty());
  EXPECT_NE(as_written.report.warnings.front().find("117"), std::string::npos) << as_written.report.warnings.front();
  ReadCadOptions options;
  options.unit = 1.0;
  const CadFile in_metres = read("iea15_rotor_IEA_15MW_CFD.stp", options);
  EXPECT_TRUE(in_metres.report.warnings.empty());
  const double ratio = model_measures(in_metres.model, RunContext()).total.area / model_measures(as_written.model, RunContext()).total.area;
  EXPECT_NEAR(ratio, 1e6, 1.0);
}

TEST(ReadCad, WhatIsOpenIsListedWithPlaces) {
  STERNA_NEEDS_SHARED_DATA();
  const CadFile file = read("gmsh_parts_sewfaces.step");
  EXPECT_FALSE(file.report.is_closed());
  ASSERT_FALSE(file.report.free_edges.empty());
  for (const CadFreeEdge& edge : file.report.free_edges) {
    EXPECT_TRUE(file.model.edges[edge.edge].curve);
    EXPECT_LT(edge.face.index(), file.model.faces.size());
    EXPECT_GT(edge.length, 0.0);
  }
}

TEST(ReadCad, TheNacelleAndTheWingAreConsistent) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"tigl_nacelle_nacelle.stp", "tigl_simplewing_simplewing.brep", "netgen_parts_screw.step", "gmsh_wing_fuselage_wing_fuselage.step",
                           "onera_m6_su2_geom_oneram6.IGS"}) {
    SCOPED_TRACE(name);
    expect_consistent(read(name).model);
  }
}

TEST(ReadCad, StepExportOfRealFilesReadsBackEqual) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"gmsh_parts_as1-tu-203.stp", "tigl_simplewing_simplewing.brep", "dealii_cad_wing.iges", "netgen_parts_screw.step"}) {
    SCOPED_TRACE(name);
    const CadFile first = read(name);
    const auto path = test::scratch() / "out.step";
    io::write_cad(first.model, path, {}, RunContext());
    const CadFile again = io::read_cad(path, {}, RunContext());
    const ModelMeasures a = model_measures(first.model, RunContext()), b = model_measures(again.model, RunContext());
    EXPECT_NEAR(b.total.area, a.total.area, 1e-6 * a.total.area);
    EXPECT_NEAR(b.total.volume, a.total.volume, 1e-6 * a.total.volume);
    EXPECT_EQ(again.report.n_closed, first.report.n_closed);
  }
}

TEST(ReadCad, ModelsRebuiltFromOurOwnSurfacesAreValid) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"netgen_parts_screw.step", "tigl_simplewing_simplewing.brep"}) {
    SCOPED_TRACE(name);
    CadFile file = read(name);
    const ModelMeasures before = model_measures(file.model, RunContext());
    file.model.shape.reset();
    const auto shape = cad::shape_of(file.model, RunContext());
    const auto faults = cad::faults_of(*shape);
    EXPECT_TRUE(faults.empty()) << faults.front().what << " " << format_point(faults.front().position);
    const ModelMeasures after = model_measures(file.model, RunContext());
    EXPECT_NEAR(after.total.area, before.total.area, 1e-6 * before.total.area);
    EXPECT_NEAR(after.total.volume, before.total.volume, 1e-6 * before.total.volume);
  }
}

TEST(ReadCad, OpenCascadePrintsNothing) {
  STERNA_NEEDS_SHARED_DATA();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  read("ansys_bracket.iges");
  read("gmsh_parts_bad_step_intersects.step.gz");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

ErrorCode code_of(std::string_view bytes, cad::CadFormat format, const RunContext& context = RunContext()) {
  try {
    cad::read_cad_bytes(bytes, format, "broken", {}, context);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("broken"), std::string::npos) << error.what();
    return error.code();
  }
  return ErrorCode::internal;
}

TEST(ReadCad, BrokenFilesAreRefusedByName) {
  EXPECT_EQ(code_of("ISO-10303-21;\nnonsense", cad::CadFormat::step), ErrorCode::file_malformed);
  EXPECT_EQ(code_of("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n", cad::CadFormat::step), ErrorCode::file_malformed);
  EXPECT_EQ(code_of("CASCADE Topology V1, (c) Matra-Datavision\n", cad::CadFormat::brep), ErrorCode::file_malformed);
  EXPECT_EQ(code_of(std::string(72, ' ') + "S      1\n", cad::CadFormat::iges), ErrorCode::file_malformed);
}

TEST(ReadCad, AStopReachesTheReader) {
  std::stop_source stop;
  stop.request_stop();
  RunSettings settings;
  settings.stop = stop.get_token();
  try {
    cad::read_cad_bytes("ISO-10303-21;\n", cad::CadFormat::step, "x.step", {}, RunContext(settings));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

TEST(ReadCad, OtherFilesAreNoCad) {
  const auto path = test::scratch() / "a.txt";
  std::ofstream(path) << "hello";
  try {
    io::read_cad(path, {}, RunContext());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::unsupported_format);
  }
}

}  // namespace
}  // namespace sterna
