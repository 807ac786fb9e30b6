// Parts of the verb draw{}: reading of the input, drawing, and writing of the PNG.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "geom/base/run_context.h"
#include "geom/draw/draw.h"
#include "scripting/lua/input_path.h"

namespace sterna::scripting {

/// Returns a surface or volume mesh from a file of that unit (m); a file of a volume format without cells is read as a surface.
/// \throws Error of io; (bad_argument) for models, which have no mesh yet
std::variant<TriMesh, HybridMesh> read_drawable(const InputPath& input, double unit, const RunContext& context);

/// \throws Error(unsupported_format) unless the name ends in .png
void require_picture_output(const std::filesystem::path& path);

/// Writes the PNG atomically. `report`: findings of check, for DrawOptions::places; if null, the mesh is checked here when they are requested.
/// \throws Error of draw_png and of io::AtomicFile
void write_picture(const HybridMesh& mesh, const CheckReport* report, const DrawOptions& options, std::string_view name, const std::filesystem::path& path,
                   const RunContext& context);
void write_picture(const TriMesh& surface, const DrawOptions& options, std::string_view name, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::scripting
