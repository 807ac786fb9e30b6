// Evaluates a size field that was built elsewhere. It reads a flat buffer, includes no header of sterna and allocates nothing, so that the process of an engine
// can use the memory block as it was received.
//
// Layout of the buffer, in native byte order: Header; n_nodes uint32, padded to a multiple of 8 bytes; 8 floats per leaf. A node with k_leaf_bit contains the
// number of a leaf; other nodes contain the number of the first of eight consecutive children. Bits 1, 2 and 4 of the number k of a child or corner mean the
// upper end of x, y and z. Node 0 is the root, the cube [origin, origin + edge].
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace sterna::volmesh {

class SizeFieldView {
 public:
  static constexpr std::uint64_t k_magic = 0x31465a4953545453;  ///< "STTSIZF1" in memory; the last digit is the version
  static constexpr std::uint32_t k_leaf_bit = 0x80000000u;
  static constexpr int k_max_depth = 30;

  struct Header {
    std::uint64_t magic = k_magic;
    std::uint64_t n_nodes = 0;
    std::uint64_t n_leaves = 0;
    double origin[3] = {0.0, 0.0, 0.0};  ///< m
    double edge = 0.0;                   ///< m, edge of the root
    double smallest = 0.0;               ///< m, smallest value over all corners
    double largest = 0.0;
    double growth = 0.0;  ///< growth limit of the field
  };
  static_assert(sizeof(Header) == 80);

  static constexpr std::size_t size_bytes(std::uint64_t n_nodes, std::uint64_t n_leaves) { return sizeof(Header) + 8 * ((n_nodes + 1) / 2) + 32 * n_leaves; }

  SizeFieldView() = default;
  /// \pre `data` is aligned to 8 bytes and outlives the view. If it contains such a buffer, is_valid() returns true; the nodes themselves are not checked.
  SizeFieldView(const std::byte* data, std::size_t size) {
    if (size < sizeof(Header)) return;
    Header header;
    std::memcpy(&header, data, sizeof header);
    if (header.magic != k_magic || header.n_nodes == 0 || header.n_nodes >= k_leaf_bit || header.n_leaves >= k_leaf_bit) return;
    if (size != size_bytes(header.n_nodes, header.n_leaves)) return;
    header_ = header;
    inverse_edge_ = 1.0 / header.edge;
    nodes_ = reinterpret_cast<const std::uint32_t*>(data + sizeof(Header));
    values_ = reinterpret_cast<const float*>(data + sizeof(Header) + 8 * ((header.n_nodes + 1) / 2));
  }

  bool is_valid() const { return nodes_ != nullptr; }
  const Header& header() const { return header_; }

  /// Returns the target edge length at a location, both in metres. Outside of the root cube, returns the value at the nearest point of the cube. The result is
  /// positive.
  /// \pre is_valid(), and the coordinates are finite
  double operator()(double x, double y, double z) const {
    constexpr double k_steps = 1 << k_max_depth;
    const double u[3] = {location(x, 0), location(y, 1), location(z, 2)};
    const std::uint32_t at[3] = {static_cast<std::uint32_t>(u[0] * k_steps), static_cast<std::uint32_t>(u[1] * k_steps),
                                 static_cast<std::uint32_t>(u[2] * k_steps)};
    std::uint32_t node = nodes_[0];
    int bit = k_max_depth;
    while (!(node & k_leaf_bit) && bit > 0) {
      --bit;
      node = nodes_[node + ((at[0] >> bit) & 1u) + 2u * ((at[1] >> bit) & 1u) + 4u * ((at[2] >> bit) & 1u)];
    }
    const float* v = values_ + 8 * static_cast<std::size_t>(node & ~k_leaf_bit);
    const double scale = static_cast<double>(1u << (k_max_depth - bit));
    double t[3];
    for (int axis = 0; axis < 3; ++axis) t[axis] = u[axis] * scale - static_cast<double>(at[axis] >> bit);
    const double near = mix(mix(v[0], v[1], t[0]), mix(v[2], v[3], t[0]), t[1]);
    const double far = mix(mix(v[4], v[5], t[0]), mix(v[6], v[7], t[0]), t[1]);
    return mix(near, far, t[2]);
  }

 private:
  /// Returns the position in the root cube as a fraction of its edge, in [0, 1).
  double location(double x, int axis) const {
    constexpr double k_below_one = 1.0 - 0x1p-40;
    const double u = (x - header_.origin[axis]) * inverse_edge_;
    return u > 0.0 ? (u < k_below_one ? u : k_below_one) : 0.0;
  }
  static double mix(double a, double b, double t) { return a + (b - a) * t; }

  Header header_;
  double inverse_edge_ = 0.0;
  const std::uint32_t* nodes_ = nullptr;
  const float* values_ = nullptr;
};

}  // namespace sterna::volmesh
