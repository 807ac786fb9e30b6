// Inside geom/cad only: translates files of each format into labelled shapes, metres. The bytes are those of an uncompressed file.
#pragma once

#include <string>
#include <string_view>

#include "geom/cad/cad_format.h"
#include "geom/cad/occt_shape.h"
#include "geom/cad/step_faces.h"

class Message_ProgressRange;

namespace sterna::cad {

struct Translated {
  LabelledShape labelled;
  std::string file_unit;
  double unit = 1.0;                     ///< metres for 1 unit of the file, already applied
  SeamReport seams = {};                 ///< STEP only
  std::vector<std::string> losses = {};  ///< losses according to the file's own topology, one sentence each; STEP only
};

/// \throws Error(file_malformed), and all exceptions of OpenCASCADE; call it inside run_occt.
Translated translate(std::string_view bytes, CadFormat format, const std::string& source, const Message_ProgressRange& progress);

/// Scales everything about the origin; labels follow.
void scale(LabelledShape& labelled, double factor);

}  // namespace sterna::cad
