// Inside geom/cad only: rewrites faces of STEP files whose outer border is the whole of a closed surface with a pole at both ends, so that OpenCASCADE can read
// them.
#pragma once

#include <StepData_StepModel.hxx>

#include <string>
#include <vector>

namespace sterna::cad {

/// Result for faces with a natural border.
struct SeamReport {
  std::size_t n_changed = 0;
  std::vector<std::string> failed;  ///< names or numbers of faces that OpenCASCADE would misread and that could not be rewritten
};

/// Adds seams to faces that OpenCASCADE misreads: faces on a surface of revolution or a B-spline surface with two poles, if their natural border is a
/// VERTEX_LOOP beside holes, or is omitted, or if holes cross the seam. OpenCASCADE then makes holes outer borders, and the body is lost without an error. Such
/// faces get a loop along a seam that no hole crosses (the surface is rotated for that); surface and holes are unchanged in space. Call it inside run_occt,
/// between reading the file and translating it, or before a file is written.
SeamReport give_seams(const Handle(StepData_StepModel) & model);

}  // namespace sterna::cad
