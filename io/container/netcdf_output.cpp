#include "io/container/netcdf_output.h"

#include <netcdf.h>

#include "geom/base/error.h"
#include "io/output/atomic_file.h"

namespace sterna::io {
namespace {

/// Buffer size of the library, in bytes.
constexpr std::size_t k_buffer = std::size_t{1} << 22;

class NetcdfWriter {
 public:
  NetcdfWriter(AtomicFile& file, bool is_cdf5) : file_(file) {
    std::size_t buffer = k_buffer;
    require(nc__create(file.temporary().c_str(), is_cdf5 ? NC_64BIT_DATA : NC_64BIT_OFFSET, 0, &buffer, &id_), "creating a file");
  }
  ~NetcdfWriter() {
    if (id_ >= 0) nc_abort(id_);
  }
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;

  void write(const NetcdfOutput& contents, const RunContext& context) {
    int fill_before = 0;
    require(nc_set_fill(id_, NC_NOFILL, &fill_before), "creating the structure");
    std::vector<int> dimensions, variables;
    for (const NetcdfOutput::Dimension& dimension : contents.dimensions)
      require(nc_def_dim(id_, dimension.name.c_str(), dimension.length, &dimensions.emplace_back()), "creating the structure");
    for (const auto& [name, text] : contents.attributes)
      require(nc_put_att_text(id_, NC_GLOBAL, name.c_str(), text.size(), text.data()), "creating the structure");
    std::vector<const OutputArray*> arrays;
    for (const NetcdfOutput::Variable& variable : contents.variables) {
      std::vector<int> own;
      for (const std::size_t dimension : variable.dimensions) own.push_back(dimensions[dimension]);
      const nc_type type = variable.array.kind == NumberKind::f8 ? NC_DOUBLE : NC_INT;
      require(nc_def_var(id_, variable.name.c_str(), type, static_cast<int>(own.size()), own.data(), &variables.emplace_back()), "creating the structure");
      arrays.push_back(&variable.array);
    }
    require(nc_enddef(id_), "writing the head");
    stream_arrays(
        arrays,
        [&](std::size_t number, std::uint64_t first_value, std::string_view bytes) {
          const OutputArray& array = *arrays[number];
          const std::uint64_t row = count_of(array) / array.extents.front();  // whole rows
          std::vector<std::size_t> start(array.extents.size(), 0), count(array.extents.begin(), array.extents.end());
          start[0] = first_value / row;
          count[0] = bytes.size() / byte_size(array.kind) / row;
          require(nc_put_vara(id_, variables[number], start.data(), count.data(), bytes.data()), "writing");
        },
        context);
    require(nc_close(std::exchange(id_, -1)), "closing");
  }

 private:
  /// Throws on failure. The library's codes are negative; system errors are passed on unchanged.
  void require(int status, const char* doing) const {
    if (status == NC_NOERR) return;
    if (status > 0) file_.fail(status, doing);
    throw Error({.code = ErrorCode::write_failed,
                 .attempted = "writing " + file_.path().string(),
                 .problem = std::string(doing) + ": the NetCDF library says: " + nc_strerror(status)});
  }

  AtomicFile& file_;
  int id_ = -1;
};

}  // namespace

void write_netcdf(const NetcdfOutput& contents, const std::filesystem::path& path, const RunContext& context) {
  const auto lock = hold_container_libraries();
  AtomicFile file(path);
  NetcdfWriter(file, contents.is_cdf5).write(contents, context);
  file.adopt();
  const StageTimer timer(context, "sync");
  file.commit();
}

}  // namespace sterna::io
