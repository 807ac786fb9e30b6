// Container files (HDF5, NetCDF, ADF). Their libraries run in a separate process, sterna-read-container, installed beside the program.
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

/// Formats of a container file.
enum class ContainerFormat { hdf5, netcdf, cgns };  ///< cgns: HDF5 or ADF

/// Reads the whole file except groups whose name or label (attribute "label") is in `left_out`. A gzipped file or a pipe is read through memory.
/// Memory is proportional to the file size. Contiguous arrays are no larger than the file; unpacked arrays in total are at most wire::k_max_expansion times as
/// large.
/// \param helper_folder folder of sterna-read-container; empty = beside the program
/// \throws Error file_not_found; file_malformed (with the path in the file and what was expected; also if the library crashes or exceeds its limits);
/// unsupported_format (links, filters, types, or a missing helper); cancelled.
ContainerImage read_container(const std::filesystem::path& path, ContainerFormat format, const std::vector<std::string>& left_out, const RunContext& context,
                              const std::string& helper_folder = {});

}  // namespace sterna::io
