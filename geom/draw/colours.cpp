#include "geom/draw/colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace sterna::draw {
namespace {

constexpr std::array<Rgb, 12> k_patches = {{{110, 160, 208},
                                            {232, 166, 92},
                                            {128, 186, 126},
                                            {216, 120, 118},
                                            {160, 138, 200},
                                            {196, 156, 128},
                                            {226, 152, 196},
                                            {150, 160, 170},
                                            {204, 204, 110},
                                            {104, 196, 204},
                                            {90, 120, 170},
                                            {170, 100, 60}}};
/// The colour map viridis at 0, 0.1, ..., 1.
constexpr std::array<Rgb, 11> k_neutral = {{{68, 1, 84},
                                            {72, 36, 117},
                                            {65, 68, 135},
                                            {53, 95, 141},
                                            {42, 120, 142},
                                            {33, 145, 140},
                                            {34, 168, 132},
                                            {68, 191, 112},
                                            {122, 209, 81},
                                            {189, 223, 38},
                                            {253, 231, 37}}};
constexpr std::array<Rgb, 7> k_judged_colours = {
    {{58, 104, 174}, {116, 164, 206}, {186, 212, 220}, {244, 236, 206}, {246, 178, 118}, {224, 96, 72}, {160, 18, 38}}};

Rgb interpolate(std::span<const Rgb> table, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), table.size() - 2);
  const double t = at - static_cast<double>(i);
  const auto mix = [&](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(std::floor(a + t * (b - a) + 0.5)); };
  return {mix(table[i].r, table[i + 1].r), mix(table[i].g, table[i + 1].g), mix(table[i].b, table[i + 1].b)};
}

}  // namespace

Rgb patch_color(std::size_t index, PatchKind kind) {
  if (kind == PatchKind::symmetry) return {222, 222, 228};
  if (kind == PatchKind::farfield || kind == PatchKind::inflow || kind == PatchKind::outflow) return {206, 216, 226};
  // Beyond the table the colours repeat darker, then lighter, so that the first 36 patches have distinct colours in the legend.
  constexpr std::array<double, 3> k_shares = {1.0, 0.68, 0.55};
  constexpr std::array<double, 3> k_white = {0.0, 0.0, 0.45};
  const Rgb base = k_patches[index % k_patches.size()];
  const std::size_t round = (index / k_patches.size()) % k_shares.size();
  const auto toned = [&](std::uint8_t c) { return static_cast<std::uint8_t>(std::floor(k_shares[round] * c + k_white[round] * 255.0 + 0.5)); };
  return {toned(base.r), toned(base.g), toned(base.b)};
}

Rgb kind_color(CellKind kind) {
  switch (kind) {
    case CellKind::tetrahedron: return {246, 226, 178};
    case CellKind::pyramid: return {226, 130, 116};
    case CellKind::prism: return {132, 178, 220};
    case CellKind::hexahedron: return {148, 204, 144};
  }
  return k_no_value;
}

Rgb patch_kind_color(PatchKind kind) { return patch_color(static_cast<std::size_t>(kind)); }

Rgb scale_color(Scale scale, double share) { return scale == Scale::neutral ? interpolate(k_neutral, share) : interpolate(k_judged_colours, share); }

}  // namespace sterna::draw
