// Strict reader of NetCDF files over a loaded file: the classic format (CDF-1, -2, -5) and NetCDF-4, which is HDF5.
// Based on: The NetCDF Classic Format Specification (Unidata), CDF-5 as in PnetCDF.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "io/file_buffer.h"
#include "io/number_array.h"

namespace sterna::io {

bool is_netcdf(std::string_view bytes);

class Hdf5Source;
struct Hdf5Object;

/// Every function throws Error file_malformed (byte offset, expectation) or unsupported_format.
class NetcdfSource {
 public:
  /// \pre `buffer` outlives the source and its arrays
  explicit NetcdfSource(const FileBuffer& buffer);
  ~NetcdfSource();

  /// Of the whole file, by name.
  const std::map<std::string, NumberArray>& attributes() const { return attributes_; }
  bool has(const std::string& variable) const;
  /// Values of a variable. \pre has(variable)
  NumberArray data(const std::string& variable) const;

 private:
  void read_classic(const FileBuffer& buffer);

  std::map<std::string, NumberArray> attributes_;
  std::map<std::string, NumberArray> variables_;  ///< of the classic format
  std::unique_ptr<Hdf5Source> hdf5_;              ///< of NetCDF-4
  std::unique_ptr<Hdf5Object> group_;
};

}  // namespace sterna::io
