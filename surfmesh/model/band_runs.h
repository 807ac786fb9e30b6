// Where bands stand on the borders of faces.
#pragma once

#include <optional>
#include <vector>

#include "surfmesh/face/face_strip.h"
#include "surfmesh/model/labelled_border.h"
#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {

/// Runs of the face's border beside edges of bands; columns on the border where bands go on beyond the face.
std::vector<BandRun> band_runs(FaceId f, const LabelledBorder& labelled, const WingBands& bands, const CurvatureLimits& limits);

/// The base of a trailing edge as a strip. \return nothing where its border is not that of a strip, or cells would be turned over
std::optional<BandedFace> mesh_base(const Model& model, FaceId f, const LabelledBorder& labelled, const BaseStrip& strip);

}  // namespace sterna::surfmesh
