// Reads and writes the geometry files of sumo (.smx). The root element is an `Assembly`, or a single `BodySkeleton` or `WingSkeleton` as in sumo's component
// files.
// Format: docs/method/smx.md. Source: the schema in sumo's files. Angles are in radians (mesh criteria in degrees); lengths are taken as metres.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/model/aircraft.h"

namespace sterna {

/// Reads every component, control surface and engine. Values that sumo itself changes on reading are changed in the same way: a shape constraint replaces the
/// points, frames are sorted by x and normalised, repeated points are dropped. Unknown elements and attributes, unresolved references and suspicious values are
/// listed in the messages, which also go to the log as warnings.
/// \throws Error(file_not_found, file_malformed) with line and path of the element
AircraftReading read_smx(const std::filesystem::path& path, const RunContext& context);

/// Writes the contents that .smx supports. If `aircraft` was read by read_smx, reading the written file again gives an equal aircraft.
/// \throws Error(write_failed), Error(unsupported_format) naming what .smx cannot represent (sections as free loops, blunt trailing edges ...)
void write_smx(const Aircraft& aircraft, const std::filesystem::path& path);

}  // namespace sterna
