#include "io/container/hdf5_driver.h"

#include <hdf5.h>

#include <algorithm>
#include <cstddef>
#include <type_traits>

namespace sterna::io {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

/// The library's file handle. The library's own part must come first.
struct OpenFile {
  H5FD_t library{};
  Hdf5Driver* driver = nullptr;
  haddr_t allocated = 0;  ///< end of the space that the library has allocated
  haddr_t end = 0;        ///< end of the written bytes
};

/// The library passes the address of `library`, which is that of the whole object.
static_assert(std::is_standard_layout_v<OpenFile> && offsetof(OpenFile, library) == 0);

OpenFile& of(const H5FD_t* file) { return *reinterpret_cast<OpenFile*>(const_cast<H5FD_t*>(file)); }

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  const auto* const driver = static_cast<Hdf5Driver* const*>(H5Pget_driver_info(access));
  if (!driver) return nullptr;
  auto* const file = new OpenFile;
  file->driver = *driver;
  return &file->library;
}

herr_t close_file(H5FD_t* file) {
  delete &of(file);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  if (flags)
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA;  // as HDF5's own driver
  return 0;
}

haddr_t get_allocated(const H5FD_t* file, H5FD_mem_t) { return of(file).allocated; }
herr_t set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t allocated) {
  of(file).allocated = allocated;
  return 0;
}
haddr_t get_end(const H5FD_t* file, H5FD_mem_t) { return of(file).end; }

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, std::size_t n, void* bytes) {
  OpenFile& own = of(file);
  own.driver->attempt([&](AtomicFile& target) { target.get(offset, {static_cast<char*>(bytes), n}); });
  return own.driver->has_failed() ? -1 : 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, std::size_t n, const void* bytes) {
  OpenFile& own = of(file);
  own.driver->attempt([&](AtomicFile& target) { target.put(offset, {static_cast<const char*>(bytes), n}); });
  own.end = std::max<haddr_t>(own.end, offset + n);
  return 0;  // success even after a failure: see Hdf5Driver
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  OpenFile& own = of(file);
  own.driver->attempt([&](AtomicFile& target) { target.resize(own.allocated); });
  own.end = own.allocated;
  return 0;
}

const H5FD_class_t& driver_class() {
  static const H5FD_class_t k_class = [] {
    H5FD_class_t made{};
    made.name = "sterna";
    made.maxaddr = HADDR_MAX;
    made.fc_degree = H5F_CLOSE_STRONG;
    made.fapl_size = sizeof(Hdf5Driver*);
    made.open = open_file;
    made.close = close_file;
    made.query = query;
    made.get_eoa = get_allocated;
    made.set_eoa = set_allocated;
    made.get_eof = get_end;
    made.read = read;
    made.write = write;
    made.truncate = truncate;
    const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(map), std::end(map), made.fl_map);
    return made;
  }();
  return k_class;
}

}  // namespace

Hdf5Driver::Hdf5Driver(Borrowed<AtomicFile> file) : file_(file), id_(H5FDregister(&driver_class())) {}

Hdf5Driver::~Hdf5Driver() {
  if (id_ >= 0) H5FDunregister(id_);
}

bool Hdf5Driver::set_on(std::int64_t access) {
  Hdf5Driver* const self = this;
  return id_ >= 0 && H5Pset_driver(access, id_, &self) >= 0;
}

}  // namespace sterna::io
