// Inside geom/cad only: faces of STEP files whose outer border is the whole of a closed surface with a pole at both ends, written so that OpenCASCADE reads
// them.
#pragma once

#include <StepData_StepModel.hxx>

#include <string>
#include <vector>

namespace sterna::cad {

/// What became of faces with a natural border.
struct SeamReport {
  std::size_t n_changed = 0;
  std::vector<std::string> failed;  ///< names or numbers of faces that OpenCASCADE would misread and that could not be changed
};

/// OpenCASCADE reads a face on a surface of revolution or a B-spline surface with two poles wrongly where its natural border is a VERTEX_LOOP beside holes, or
/// is not written at all, or where holes cross its seam: holes become outer borders, and the body is lost without a word. Such faces get a loop along a seam
/// that no hole crosses (the surface is turned for that); surface and holes stay as they are in space. Call it inside run_occt, between reading the file and
/// translating it, or before a file is written.
SeamReport give_seams(const Handle(StepData_StepModel) & model);

}  // namespace sterna::cad
