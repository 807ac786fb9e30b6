// The CAD formats by name, extension and contents.
#pragma once

#include <optional>
#include <string_view>

namespace sterna::cad {

enum class CadFormat { step, iges, brep };
std::string_view to_string(CadFormat format);

/// By the extension of a file's name, ".gz" peeled off: .step .stp .iges .igs .brep .egads; nothing for others.
std::optional<CadFormat> format_of_name(std::string_view file_name);

/// By the first bytes of a file (at least 80 are needed for IGES); nothing when they are of none of the three.
std::optional<CadFormat> format_of_bytes(std::string_view bytes);

}  // namespace sterna::cad
