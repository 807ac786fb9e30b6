// The geometry files of sumo (.smx): a root `Assembly`, or a single `BodySkeleton` or `WingSkeleton` as in its component files.
// Format: docs/method/smx.md. Source: the schema in sumo's files; angles in radians (mesh criteria in degrees), lengths taken as metres.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/model/aircraft.h"

namespace sterna {

/// Reads every component, control surface and engine. Values that sumo itself would change on reading are changed likewise: a shape constraint
/// replaces the points, frames are sorted by x and normalised, repeated points are dropped. Unknown elements and attributes, references to
/// nothing, and odd values are in the messages, which also go to the log as warnings.
/// \throws Error(file_not_found, file_malformed) with line and path of the element
AircraftReading read_smx(const std::filesystem::path& path, const RunContext& context);

/// Writes what .smx can hold; read_smx of it gives an equal aircraft when `aircraft` came from read_smx.
/// \throws Error(write_failed), Error(unsupported_format) naming what .smx cannot hold (sections as free loops, blunt trailing edges ...)
void write_smx(const Aircraft& aircraft, const std::filesystem::path& path);

}  // namespace sterna
