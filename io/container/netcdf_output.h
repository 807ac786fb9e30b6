// Writer of classic NetCDF files with libnetcdf: dimensions, attributes and variables, whose values are streamed.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/run_context.h"
#include "io/output/output_array.h"

namespace sterna::io {

struct NetcdfOutput {
  struct Dimension {
    std::string name;
    std::uint64_t length = 0;  ///< not 0, which NetCDF uses for "unlimited"
  };
  struct Variable {
    std::string name;
    std::vector<std::size_t> dimensions;  ///< indices into the dimensions of the file; their lengths are the extents of the array
    OutputArray array;                    ///< i4 or f8
  };
  std::vector<Dimension> dimensions;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< string attributes
  std::vector<Variable> variables;
  bool is_cdf5 = false;  ///< false: CDF-2, whose arrays are below 4 GiB
};

/// Writes the file completely or not at all; the output is reproducible byte by byte.
/// \throws Error write_failed; errors of the arrays; cancelled
void write_netcdf(const NetcdfOutput& contents, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
