// Container files (HDF5, NetCDF, ADF), read by their libraries in a process of its own: sterna-read-container, which lies beside the program.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "io/container/container_image.h"

namespace sterna::io {

bool is_hdf5(std::string_view bytes);
bool is_adf(std::string_view bytes);
bool is_netcdf(std::string_view bytes);  ///< the classic format or HDF5

/// What a container file may be.
enum class ContainerFormat { hdf5, netcdf, cgns };  ///< cgns: HDF5 or ADF

/// Reads the whole file but for the groups whose name or label (attribute "label") is in `left_out`. Packed by gzip or from a pipe it goes through memory.
/// Memory stays in proportion to the file: contiguous arrays are no larger than it, unpacked ones in all no more than wire::k_max_expansion times.
/// \param helper_folder where sterna-read-container is; empty = beside the program
/// \throws Error file_not_found; file_malformed (path in the file, expectation; also where the library crashes or runs into its limits); unsupported_format
/// (links, filters, types; the helper is not there); cancelled.
ContainerImage read_container(const std::filesystem::path& path, ContainerFormat format, const std::vector<std::string>& left_out, const RunContext& context,
                              const std::string& helper_folder = {});

}  // namespace sterna::io
