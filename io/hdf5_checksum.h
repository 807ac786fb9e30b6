// The checksum of HDF5's newer metadata: Bob Jenkins' lookup3 (public domain algorithm, 2006), as named by the HDF5 file format specification 3.0.
#pragma once

#include <cstdint>
#include <string_view>

namespace sterna::io {

std::uint32_t hdf5_checksum(std::string_view bytes);

}  // namespace sterna::io
