// Colours of patches and cell kinds, and colour scales for numbers.
#pragma once

#include <cstddef>
#include <string_view>

#include "geom/draw/image.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::draw {

inline constexpr Rgb k_text_color{32, 36, 44};
inline constexpr Rgb k_no_value{186, 190, 196};    ///< faces without a value of the quantity
inline constexpr Rgb k_plain_wall{172, 180, 192};  ///< walls shown for orientation only
inline constexpr Rgb k_inside{158, 164, 174};      ///< the side of walls opposite to the fluid
inline constexpr Rgb k_mark_color{214, 39, 40};

/// Returns one of twelve distinguishable colours, repeated cyclically. Symmetry planes and far boundaries of the fluid are pale, because bodies are in front of
/// them.
Rgb patch_color(std::size_t index, PatchKind kind = PatchKind::wall);
Rgb kind_color(CellKind kind);
Rgb patch_kind_color(PatchKind kind);

/// `neutral` runs from dark blue over green to yellow (viridis, public domain). In `judged`, blue is good and red is bad.
enum class Scale { neutral, judged };
/// `share` in [0, 1], clamped; for judged, 1 is bad.
Rgb scale_color(Scale scale, double share);

}  // namespace sterna::draw
