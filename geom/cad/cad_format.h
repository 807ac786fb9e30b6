// Detection of CAD formats by name, extension and contents.
#pragma once

#include <optional>
#include <string_view>

namespace sterna::cad {

enum class CadFormat { step, iges, brep };
std::string_view to_string(CadFormat format);

/// Returns the format by file name extension, without ".gz": .step .stp .iges .igs .brep .egads; empty for others.
std::optional<CadFormat> format_of_name(std::string_view file_name);

/// Returns the format by the first bytes of a file (at least 80 are needed for IGES); empty if they match none of the three formats.
std::optional<CadFormat> format_of_bytes(std::string_view bytes);

}  // namespace sterna::cad
